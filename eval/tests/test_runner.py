"""Tests the cache of runs: only a changed option, input or tool reruns; failures leave nothing."""

import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bnvpl_eval.runner import Run, Runner, TookTooLong  # noqa: E402 (after the path that it needs)

TOOL = """#!/bin/sh
# copies its input behind a line with its options; every run is one line of calls.log
echo x >> "{log}"
while [ "$2" = endless ]; do :; done
[ "$2" = warn ] && {{ echo "{{}}"; echo beware >&2; }}
[ "$2" = fail ] && {{ echo "made to fail"; exit 3; }}
{{ echo "$2"; cat "$1"; }} > "$3"
"""


class Caching(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.log = self.folder / "calls.log"
        self.tool = self.folder / "vpl-fake"
        self.tool.write_text(TOOL.format(log=self.log))
        self.tool.chmod(0o755)
        self.input = self.folder / "in.txt"
        self.input.write_text("input\n")

    def run_tool(self, option: str = "a", runner: Runner | None = None) -> Run:
        runner = runner or Runner(self.folder, self.folder / "cache", quiet=True)
        return runner.run("vpl-fake", ["{in}", option, "@out.txt"], {"in": self.input}, ["out.txt"])

    def calls(self) -> int:
        return len(self.log.read_text().splitlines())

    def test_runs_once(self) -> None:
        first, second = self.run_tool(), self.run_tool()
        self.assertEqual(self.calls(), 1)
        self.assertEqual(first["out.txt"].read_text(), "a\ninput\n")
        self.assertEqual(first.folder, second.folder)
        self.assertGreater(first.record["peak_mib"], 0)
        self.assertEqual(first.record["options"], ["{in}", "a", "@out.txt"])

    def test_what_changes_runs_again(self) -> None:
        folders = {self.run_tool().folder, self.run_tool("b").folder}
        self.input.write_text("other\n")
        folders.add(self.run_tool().folder)
        self.tool.write_text(self.tool.read_text() + "# another version\n")
        folders.add(self.run_tool().folder)
        self.assertEqual((self.calls(), len(folders)), (4, 4))

    def test_a_run_ends_at_its_limit(self) -> None:
        runner = Runner(self.folder, self.folder / "cache", quiet=True)
        with self.assertRaises(TookTooLong), runner.limited("vpl-fake", 1):
            self.run_tool("endless", runner)
        self.assertEqual(self.calls(), 1)
        self.assertEqual([f.suffix for f in (self.folder / "cache").iterdir()], [".stopped"])
        with self.assertRaises(TookTooLong), runner.limited("vpl-fake", 1):
            self.run_tool("endless", runner)
        self.assertEqual(self.calls(), 1, "what was stopped is not run again at its limit")
        with self.assertRaises(TookTooLong), runner.limited("vpl-fake", 1.5):
            self.run_tool("endless", runner)
        self.assertEqual(self.calls(), 2, "but within a higher one")
        with runner.limited("vpl-fake", 1):
            self.assertGreater(self.run_tool("a", runner).cpu_s, 0.0)
        with self.assertRaises(TookTooLong), runner.limited("vpl-fake", 0):
            self.run_tool("a", runner)
        with runner.limited("vpl-other", 0):
            self.run_tool("a", runner)
        self.assertEqual(self.calls(), 3)

    def test_a_changed_product_reruns_what_follows(self) -> None:
        runner = Runner(self.folder, self.folder / "cache", quiet=True)
        for option in ("a", "b", "a"):
            made = self.run_tool(option, runner)["out.txt"]
            runner.run("vpl-fake", ["{in}", "next", "@out.txt"], {"in": made}, ["out.txt"])
        self.assertEqual(self.calls(), 4)

    def test_a_tool_that_is_built_anew_ends_the_evaluation(self) -> None:
        runner = Runner(self.folder, self.folder / "cache", quiet=True)
        self.run_tool("a", runner)
        self.tool.write_text(self.tool.read_text() + "# another version\n")
        with self.assertRaisesRegex(SystemExit, "vpl-fake: was built anew"):
            self.run_tool("b", runner)
        self.assertEqual(self.calls(), 1)

    def test_provenance_is_in_every_run(self) -> None:
        runner = Runner(self.folder, self.folder / "cache", True, {"commit": "0123abc"})
        self.assertEqual(self.run_tool("a", runner).record["commit"], "0123abc")

    def test_another_number_of_threads_runs_again(self) -> None:
        for threads in (1, 2, 1):
            runner = Runner(self.folder, self.folder / "cache", True, {"threads": threads})
            self.run_tool("a", runner)
        self.assertEqual(self.calls(), 2)

    def test_messages_are_kept_apart_from_what_is_printed(self) -> None:
        run = self.run_tool("warn")
        self.assertEqual(run["log.txt"].read_text(), "{}\n")
        self.assertEqual(run["messages.txt"].read_text(), "beware\n")

    def test_what_is_interrupted_leaves_nothing(self) -> None:
        (self.folder / "vpl-fake").unlink()
        runner = Runner(self.folder, self.folder / "cache", quiet=True)
        self.tool.mkdir()  # no file that can be run
        with mock.patch.object(runner, "file_key", return_value=""), self.assertRaises(OSError):
            self.run_tool("a", runner)
        self.assertEqual(list((self.folder / "cache").iterdir()), [])

    def test_what_was_killed_long_ago_is_removed(self) -> None:
        cache = self.folder / "cache"
        old, running, new = (cache / f".0123.partial-{n}" for n in (4194305, os.getpid(), 4194306))
        for left in (old, running, new):
            left.mkdir(parents=True)
        for left in (old, running):
            os.utime(left, (0, 0))
        self.run_tool()
        self.assertEqual([left.exists() for left in (old, running, new)], [False, True, True])

    def test_failure_tells_why_and_leaves_nothing(self) -> None:
        with self.assertRaisesRegex(SystemExit, "exit code 3: made to fail"):
            self.run_tool("fail")
        self.assertEqual(list((self.folder / "cache").iterdir()), [])


if __name__ == "__main__":
    unittest.main()
