"""Runs the tools."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any

from .layout import StrPath
from .options import spec_of, words_of
from .progress import Progress, progress_of

# The build folder of a checkout that holds this package.
CHECKOUT_BIN = Path(__file__).resolve().parents[2] / "build/release/bin"


class ToolError(RuntimeError):
    """A tool failed: its exit code, its message, the command that ran, and what it printed."""

    def __init__(self, code: int, message: str, command: list[str], text: str = "") -> None:
        tool = Path(command[0]).name
        super().__init__(f"{tool}: {message}" if message else f"{tool}: exit code {code}")
        self.code, self.message, self.command, self.text = code, message, command, text


class ToolWarning(UserWarning):
    """A line of a tool's stderr that is no error."""


def find_tool(tool: str) -> str:
    """Path of a tool: in the folder BNVPL_BIN, on the PATH, or in the build of this checkout."""
    folder = os.environ.get("BNVPL_BIN")
    found = shutil.which(tool, path=folder) or (None if folder else shutil.which(tool))
    found = found or (None if folder else shutil.which(tool, path=CHECKOUT_BIN))
    if found is None:
        where = f"the folder {folder} of BNVPL_BIN" if folder else "the PATH"
        raise FileNotFoundError(f"{tool}: is not in {where}; set BNVPL_BIN to the tools' folder")
    return found


def _listen(stderr: IO[str], tool: str, progress: Callable[[Progress], object] | None) -> list[str]:
    """Calls progress() as the tool goes. Returns the other lines, without the tool's name."""
    lines = []
    for line in stderr:
        step = progress_of(line)
        if step is None:
            lines.append(line.strip().removeprefix(f"{tool}: "))
        elif progress is not None:
            progress(step)
    return lines


def _execute(
    command: list[str], tool: str, progress: Callable[[Progress], object] | None
) -> tuple[int, str, list[str]]:
    """Runs a command. Returns its exit code, its stdout and the lines of its stderr."""
    with (
        tempfile.TemporaryFile("w+") as stdout,
        subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=stdout, stderr=subprocess.PIPE, text=True
        ) as child,
    ):
        assert child.stderr is not None
        try:
            lines = _listen(child.stderr, tool, progress)
        except BaseException:  # also of the caller's progress(), and Ctrl-C
            # The tool saves its checkpoint, if it has one. Background jobs may ignore SIGINT.
            child.send_signal(signal.SIGTERM)
            for _ in child.stderr:  # its last lines would find a closed pipe, and end it
                pass
            child.wait()
            raise
        code = child.wait()
        stdout.seek(0)
        return code if code >= 0 else 128 - code, stdout.read(), lines


def _reasons(text: str) -> list[str]:
    """Lines of stdout, the last of which tells why a comparison failed; JSON has no such line."""
    return [""] if text.startswith("{") else text.rstrip().split("\n")


def run(
    tool: str,
    *arguments: StrPath,
    progress: Callable[[Progress], object] | None = None,
    **options: Any,
) -> dict[str, Any]:
    """Runs a tool and returns its statistics, those of --stats.

    run("vpl-estimate", scene, vpls, output="lit.vpl", photons="10M") runs vpl-estimate SCENE VPLS
    --output lit.vpl --photons 10M. Flags are True or False, None leaves an option out, lists and
    dicts repeat it or join it with commas. Inputs may have keywords too: scene=, vpls=. A keyword
    that is not in the tool's --help-json is a TypeError.
    Warnings of the tool are Python's, of class ToolWarning. With estimate=True the result is the
    need of time and memory. Where the tool only prints, as with methods=True, the result is
    {"text": what it printed}. Raises ToolError if the tool fails.
    """
    executable = find_tool(tool)
    command = str(arguments[0]) if tool == "vpl-inspect" and arguments else ""
    try:
        spec = spec_of(executable, command)
    except subprocess.CalledProcessError as failed:
        message = str(failed.stderr).strip()
        raise ToolError(failed.returncode, message, [executable, "--help-json"]) from failed
    if options.get("estimate"):
        options["json"] = True
    shown = ["--quiet"] if progress is None else ["--quiet", "--progress", "json"]
    with tempfile.TemporaryDirectory(prefix="bnvpl.") as folder:
        stats = Path(options.pop("stats", None) or Path(folder) / "stats.json")
        before = stats.stat() if stats.exists() else None
        words = [executable, *words_of(tool, spec, arguments, options)]
        words += ["--stats", str(stats), *shown]
        code, text, lines = _execute(words, tool, progress)
        error = ""
        if code:  # the last line is the error, unless it is a warning
            told = bool(lines) and not lines[-1].startswith("warning: ")
            error = (lines if told else _reasons(text)).pop()
        for line in lines:
            warnings.warn(f"{tool}: {line}", ToolWarning, stacklevel=2)
        if code:
            raise ToolError(code, error, words, text)
        if options.get("estimate"):
            estimated: dict[str, Any] = json.loads(text)
            return estimated
        written = stats.exists() and (before is None or not os.path.samestat(before, stats.stat()))
        result: dict[str, Any] = json.loads(stats.read_text()) if written else {"text": text}
        return result


def scene_hash(scene: StrPath, **options: Any) -> str:
    """Hash of a scene's content, 16 hex digits. Options: those of vpl-inspect scene."""
    return str(run("vpl-inspect", "scene", scene, **options)["scene"]["hash"])
