"""Tests that tables are put in their places in the page, and that the rest of it stays."""

import json
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import write_docs  # noqa: E402 (after the path that it needs)

PAGE = (
    "# Results\n<!-- table one -->\nold one\n<!-- end -->\nbetween\n<!-- table two -->\nold "
    "two\n<!-- end -->\nlast\n"
)


def report(*ids: str) -> dict[str, Any]:
    columns = [
        {"key": "label", "label": "VPLs"},
        {"key": "relmse", "label": "relMSE", "better": "low"},
    ]
    rows = [{"group": "a room", "label": "ours", "relmse": {"value": 0.0123456, "error": 0.0004}}]
    return {
        "tables": [{"id": name, "columns": columns, "rows": rows} for name in ids],
        "plots": [],
        "scenes": [],
        "provenance": {"commits of the runs": "abc1234", "date": "2026-11-22"},
    }


class Crops(unittest.TestCase):
    def test_a_frame_has_four_sides_also_at_the_rim(self) -> None:
        for at in (0, 3):
            picture = np.zeros((12, 12, 3), np.uint8)
            shown = write_docs.framed(picture, at, at, 6, 6)
            red = (shown == write_docs.FRAME).all(axis=2)
            for side in (red[at, at:], red[:, at][at:], red[at + 6, at:], red[:, at + 6][at:]):
                self.assertGreaterEqual(side.sum(), 6)

    def test_only_what_would_be_white_is_darkened(self) -> None:
        for light, stops in ((0.0, 0), (0.9, 0), (1.5, 1), (10.0, 4)):
            self.assertEqual(write_docs.stops_down(np.full((4, 4, 3), light / 2), 2.0), stops)


class Tables(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "lab").mkdir()
        (self.folder / "lab/evaluation.md").write_text(PAGE)
        (self.folder / "results.md").write_text("# Results\n")

    def write(self, made: dict[str, Any], *options: str) -> str:
        (self.folder / "report.json").write_text(json.dumps(made))
        with (
            mock.patch.object(write_docs, "DOCS", self.folder),
            mock.patch.object(sys, "argv", ["write_docs.py", str(self.folder), *options]),
        ):
            write_docs.main()
        return (self.folder / "lab/evaluation.md").read_text()

    def test_only_what_is_named(self) -> None:
        page = self.write(report("one", "two"), "--only", "two")
        self.assertIn("old one", page)
        self.assertNotIn("old two", page)
        self.assertIn("| a room | ours | 0.0123 ± 0.0004 |", page)
        self.assertIn("<!-- tools of abc1234, 2026-11-22 -->", page)
        self.assertTrue(page.endswith("<!-- end -->\nlast\n"))

    def test_what_is_not_there_is_refused(self) -> None:
        for made, only, message in (
            (report("one"), "two", "wants table 'two'"),
            (report("one"), "three", "named 'three'"),
        ):
            with self.assertRaises(SystemExit) as refused:
                self.write(made, "--only", only)
            self.assertIn(message, str(refused.exception))
            self.assertEqual((self.folder / "lab/evaluation.md").read_text(), PAGE)

    def test_pictures_alone(self) -> None:
        with mock.patch.object(write_docs, "write_pictures") as write:
            page = self.write(report("one", "two"), "--only", "pictures")
            self.assertEqual(page, PAGE)
            write.assert_called_once()
            self.write(report("one", "two"), "--only", "one")
            write.assert_called_once()


if __name__ == "__main__":
    unittest.main()
