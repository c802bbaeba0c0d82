"""Tests of scenes that run at the same time."""

import argparse
import json
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bnvpl_eval.ahead import run_ahead  # noqa: E402 (after the path that it needs)

# An evaluation that writes down how it was called and on how many processors it may run.
PROGRAM = """
import json, os, pathlib, sys
scene = sys.argv[sys.argv.index("--scenes") + 1]
record = {"words": sys.argv[1:], "processors": len(os.sched_getaffinity(0))}
(pathlib.Path(__file__).parent / f"{scene}.json").write_text(json.dumps(record))
sys.exit(scene == "broken")
"""


class Ahead(unittest.TestCase):
    def run_scenes(self, *scenes: str) -> list[dict[str, object]]:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            program = folder / "evaluate.py"
            program.write_text(PROGRAM)
            arguments = argparse.Namespace(
                size="quick",
                parts="field",
                settings=Path("settings.toml"),
                views=None,
                bin=Path("bin"),
                cache=folder / "cache",
                commit=None,
                quiet=True,
                jobs=2,
            )
            run_ahead(program, arguments, list(scenes))
            return [json.loads((folder / f"{scene}.json").read_text()) for scene in scenes]

    def test_each_scene_has_one_processor_and_the_options(self) -> None:
        records = self.run_scenes("a", "b", "c")
        self.assertEqual([record["processors"] for record in records], [1, 1, 1])
        words = records[2]["words"]
        assert isinstance(words, list)
        pairs = dict(zip(words[::2], words[1::2], strict=False))
        self.assertEqual((pairs["--scenes"], pairs["--size"], pairs["--bin"]), ("c", "quick", "bin"))
        self.assertEqual(words[-1], "--quiet")
        self.assertNotIn("--views", words)
        self.assertNotIn("--jobs", words)

    def test_a_scene_that_fails_ends_the_evaluation(self) -> None:
        with self.assertRaisesRegex(SystemExit, "scene 'broken' failed"):
            self.run_scenes("a", "broken")


if __name__ == "__main__":
    unittest.main()
