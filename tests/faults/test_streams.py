"""Tests stdout and stderr that are closed, full, or abandoned by their reader."""

import os
import subprocess
import unittest
from collections.abc import Iterator, Sequence

from workbench import BIN, COMMANDS, OK, OUTPUT, SOURCE, Workbench

ASKED_FOR = [
    ["vpl-inspect", "info", "{made}/l.vpl"],
    ["vpl-inspect", "check", "{made}/c.vpl", "{made}/v.vpl"],
    ["vpl-inspect", "info", "--json", "{made}/l.vpl"],
    ["vpl-render", "--help"],
    ["vpl-place", "--version"],
]


class Streams(Workbench):
    def shell(
        self, words: Sequence[str | os.PathLike[str]], redirection: str
    ) -> subprocess.CompletedProcess[str]:
        """Runs the words, without --quiet, with redirected standard streams."""
        line = ' "$@" ' + redirection
        return subprocess.run(
            ["bash", "-c", line, "bash", *words],
            cwd=SOURCE,
            capture_output=True,
            text=True,
            timeout=60,
        )

    def asked_for(self) -> Iterator[tuple[str, list[str]]]:
        for words in ASKED_FOR:
            yield (
                words[0],
                [str(BIN / words[0]), *(word.format(made=self.made) for word in words[1:])],
            )

    def test_a_summary_that_cannot_be_printed_costs_no_output(self) -> None:
        for command in COMMANDS:
            self.right(command)
            for redirection, reason in (
                (">&-", "Bad file descriptor"),
                (">/dev/full", "No space left on device"),
            ):
                result = self.shell(command.line(self.folder), redirection)
                self.assertEqual(result.returncode, OK, f"{command.name} {redirection}: {result}")
                self.assertIn(
                    f"{command.tool}: warning: the summary cannot be printed: {reason}\n",
                    result.stderr,
                )
                self.assert_all(command, "new", redirection)

    def test_closed_streams_are_not_taken_by_files(self) -> None:
        """The first file would get a closed descriptor 0, 1 or 2, and then the printed text."""
        for command in COMMANDS:
            self.right(command)
            for redirection in ("2>&-", ">&- 2>&-", "<&- >&- 2>&-"):
                result = self.shell(command.line(self.folder), redirection)
                self.assertEqual(result.returncode, OK, f"{command.name} {redirection}: {result}")
                self.assert_all(command, "new", redirection)
                self.assertEqual(self.left_over(), [])

    def test_errors_keep_their_code_without_stderr(self) -> None:
        for redirection in ("2>&-", "2>/dev/full", ">&- 2>&-"):
            for words, code in (
                (["absent.toml", "-o", str(self.folder / "x")], 3),
                (["--nonsense"], 2),
                (["absent.toml", "-o", str(self.folder / "absent/x")], OUTPUT),
            ):
                result = self.shell([BIN / "vpl-place", *words], redirection)
                self.assertEqual(result.returncode, code, f"{words} {redirection}: {result}")

    def test_text_that_was_asked_for_must_arrive(self) -> None:
        for tool, words in self.asked_for():
            for redirection, reason in (
                (">&-", "Bad file descriptor"),
                (">/dev/full", "No space left on device"),
            ):
                result = self.shell(words, redirection)
                self.assertEqual(result.returncode, OUTPUT, f"{words} {redirection}: {result}")
                self.assertEqual(
                    result.stderr, f"{tool}: standard output: cannot write: {reason}\n"
                )

    def test_a_reader_that_leaves(self) -> None:
        """SIGPIPE ends the tool silently, as `head` expects. If it is ignored, the write fails."""
        reading, writing = os.pipe()
        os.close(reading)
        for tool, words in self.asked_for():
            for restored, code in ((True, -13), (False, OUTPUT)):
                result = subprocess.run(
                    words,
                    stdout=writing,
                    stderr=subprocess.PIPE,
                    text=True,
                    cwd=SOURCE,
                    restore_signals=restored,
                )
                self.assertEqual(result.returncode, code, f"{words}: {result}")
                self.assertEqual(
                    result.stderr,
                    "" if restored else f"{tool}: standard output: cannot write: Broken pipe\n",
                )
        os.close(writing)


if __name__ == "__main__":
    unittest.main()
