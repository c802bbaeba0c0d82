"""Reads, changes and writes the files of bnvpl, and runs its tools. README.md shows how."""

from .exr import Image, read_exr
from .foreign import make_vpls, share_radii, write_vpl
from .layout import VplError
from .progress import Progress
from .tools import ToolError, ToolWarning, find_tool, run, scene_hash
from .vpl_read import read_vpl
from .vpls import Vpls

__version__ = "0.3.0"
__all__ = [
    "Image",
    "Progress",
    "ToolError",
    "ToolWarning",
    "VplError",
    "Vpls",
    "find_tool",
    "make_vpls",
    "read_exr",
    "read_vpl",
    "run",
    "scene_hash",
    "share_radii",
    "write_vpl",
]
