"""What the tests of the Python package share: paths, the tools, and small files."""

from __future__ import annotations

import os
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python"
GOLDEN = ROOT / "tests/formats/golden"
SCENE = ROOT / "scenes/cornell/scene.toml"

sys.path.insert(0, str(PACKAGE))
# The tools' folder is the first argument of each test.
BIN = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin"
os.environ["BNVPL_BIN"] = str(BIN)
os.environ["PYTHONPATH"] = str(PACKAGE)

import bnvpl  # noqa: E402


class TestFolder(unittest.TestCase):
    """A folder of its own for each test."""

    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


class TestFiles(unittest.TestCase):
    """A folder for all tests of the class, with 4k candidates, 300 VPLs, and these lit."""

    folder: Path
    candidates: Path
    vpls: Path
    lit: Path

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.candidates, cls.vpls, cls.lit = (cls.folder / f"{x}.vpl" for x in ("c", "v", "lit"))
        bnvpl.run("vpl-place", SCENE, output=cls.candidates, count="4k")
        bnvpl.run("vpl-eliminate", cls.candidates, output=cls.vpls, n=300)
        bnvpl.run("vpl-estimate", SCENE, cls.vpls, output=cls.lit, photons="40k")


def main() -> None:
    unittest.main(module="__main__", argv=sys.argv[:1])
