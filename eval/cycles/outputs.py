"""Guards the outputs of the cross-check, which replace only its own files; also inside Blender."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "pipelines"))
import output_guard  # noqa: E402

__all__ = ["GLB", "MAKER", "RESULTS", "output_guard", "write_scene"]

MAKER = "eval/cycles/cross_check.py"
MARK = f"# Made by {MAKER}\n"  # is a comment in TOML, OBJ, MTL and pbrt
SCENE = output_guard.text_kind("a scene that cross_check.py made", MARK)
GLB = output_guard.Kind(
    "a scene that cross_check.py made",
    lambda head: head.startswith(b"glTF") and MAKER.encode() in head,
)
RESULTS = output_guard.json_kind(
    "results of cross_check.py",
    lambda cases: (
        isinstance(cases, dict)
        and all(
            isinstance(case, dict) and "run" in case and "views" in case for case in cases.values()
        )
    ),
)


def write_scene(path: Path, text: str) -> None:
    output_guard.write(path, MARK + text, SCENE)
