"""Tests that outputs of the evaluation replace nothing but older ones of their kind."""

import sys
import tempfile
import unittest
import unittest.mock
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bnvpl_eval import images, output  # noqa: E402 (after the path that it needs)
from bnvpl_eval.guard import guarded, output_guard  # noqa: E402
from evaluate import commit  # noqa: E402


class Commit(unittest.TestCase):
    def test_without_git_it_is_unknown(self) -> None:
        with unittest.mock.patch.dict("os.environ", {"PATH": "/nonexistent"}):
            self.assertEqual(commit(), "unknown")


class Outputs(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def refused(self, name: str, content: bytes, act: Callable[[Path], object]) -> str:
        """Calls act(file), which must be refused and leave the file. Returns the message."""
        (self.folder / name).write_bytes(content)
        with self.assertRaises(SystemExit) as ended:
            act(self.folder / name)
        self.assertEqual((self.folder / name).read_bytes(), content)
        self.assertNotIn("\n", str(ended.exception))
        return str(ended.exception)

    def test_tables_and_images(self) -> None:
        rows = [{"scene": "a", "relmse": 1.5}]
        output.write_csv(self.folder / "t.csv", rows)
        output.write_csv(self.folder / "t.csv", rows)
        self.assertIn(
            "is not a CSV table",
            self.refused("t.csv", b"[film]\nwidth = 8\n", lambda f: output.write_csv(f, rows)),
        )
        grey = np.full((2, 2, 3), 0.5, np.float32)
        for _ in range(2):
            images.write_half(self.folder / "i.exr", {"": grey}, "test")
        vpl = b"\x89VPL\r\n\x1a\n"
        self.assertIn(
            "is not an OpenEXR image",
            self.refused("i.exr", vpl, lambda f: images.write_half(f, {"": grey}, "test")),
        )
        self.assertIn(
            "is not a PNG picture",
            self.refused("h.png", vpl, lambda f: output.heat_map(grey[:, :, 0], f)),
        )

    def test_a_folder_of_others_is_refused_before_the_work(self) -> None:
        output.check(self.folder)
        output.check(self.folder / "new")
        gltf = b'{"asset": {"version": "2.0"}, "scenes": []}'
        said = self.refused("results.json", gltf, lambda _: output.check(self.folder))
        self.assertIn("is not the results of an evaluation", said)
        self.refused("file", b"x", output.check)

    def test_links_stay_and_failures_leave_nothing(self) -> None:
        target, link = self.folder / "a.svg", self.folder / "b.svg"
        link.symlink_to(target)
        guarded(output_guard.write, link, "<svg/>", output_guard.SVG)
        self.assertTrue(link.is_symlink())
        self.assertEqual(target.read_text(), "<svg/>")

        def fails(partial: Path) -> None:
            partial.write_text("half")
            raise OSError("no space")

        with self.assertRaises(OSError):
            output_guard.replace(target, output_guard.SVG, fails)
        self.assertEqual(target.read_text(), "<svg/>")
        self.assertEqual(len(list(self.folder.iterdir())), 2)


if __name__ == "__main__":
    unittest.main()
