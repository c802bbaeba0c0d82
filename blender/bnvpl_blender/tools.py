# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands of the four tools, and a runner that can be stopped."""

from __future__ import annotations

import json
import os
import queue
import shlex
import shutil
import stat
import subprocess
import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO

TOOLS = ("vpl-place", "vpl-eliminate", "vpl-estimate", "vpl-render")


# The first line of scene.toml, and the second of render.sh.
MARK = "# Written by bnvpl's add-on for Blender; its next render replaces this file."


class ToolError(RuntimeError):
    """A tool failed; the text is its own."""


# Part of vpl-place's error where the surfaces in view light no others.
NOTHING_BOUNCES = " VPLs found on "


class Cancelled(Exception):
    """The user stopped the render."""


@dataclass(frozen=True)
class Preset:
    """Counts and options of the stages, those of pipelines/quality.mk."""

    candidates: str
    vpls: int
    photons: str
    samples: int
    estimate: tuple[str, ...] = ()
    render: tuple[str, ...] = ()


PRESETS = {
    "DRAFT": Preset(
        "15k", 1500, "1M", 16, ("--irradiance-error", "0.02"),
        ("--near-field-rays", "2", "--error", "0.1"),
    ),
    "DEFAULT": Preset("120k", 3000, "10M", 16),
    "FINAL": Preset(
        "240k", 12000, "20M", 256, ("--irradiance-error", "0.002"),
        ("--near-field-rays", "4", "--error", "0.05"),
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Request:
    """What is to be rendered; zero leaves a number to the preset."""

    preset: str = "DEFAULT"
    vpls: int = 0
    samples: int = 0
    seed: int = 1
    threads: int = 0
    layers: tuple[str, ...] = ()
    transparent: bool = False
    for_denoiser: bool = False


def find_tool(tool: str, folder: str) -> str:
    """Path of a tool in the folder, or on the PATH where no folder is given."""
    found = shutil.which(tool, path=folder or None)
    if found is None:
        where = f"in {folder}" if folder else "on the PATH"
        raise ToolError(f"{tool} is not {where}; set the folder in the add-on's preferences")
    return found


def _candidates(preset: Preset, vpls: int) -> str:
    """The preset's number; more where VPLs ask for more: ten candidates for each."""
    counted = int(preset.candidates.removesuffix("k")) * 1000
    return preset.candidates if 10 * vpls <= counted else str(10 * vpls)


def _seed(request: Request) -> list[str]:
    return ["--seed", str(request.seed)] if request.seed != 1 else []


def _threads(request: Request) -> list[str]:
    return ["--threads", str(request.threads)] if request.threads else []


def _render(request: Request, inputs: list[str], options: tuple[str, ...]) -> list[str]:
    words = ["vpl-render", "scene.toml", *inputs, "-o", "image.exr"]
    words += ["--spp", str(request.samples or PRESETS[request.preset].samples), *options]
    words += _seed(request) + _threads(request)
    if request.transparent:
        words += ["--transparent", "on"]
    if request.for_denoiser:
        words += ["--for-denoiser", "on"]
    if request.layers:
        words += ["--layers", ",".join(request.layers)]
    return words


def commands(request: Request) -> list[list[str]]:
    """The four command lines, for the folder that holds scene.toml."""
    preset = PRESETS[request.preset]
    vpls = request.vpls or preset.vpls
    threads = _threads(request)
    common = _seed(request) + threads
    return [
        ["vpl-place", "scene.toml", "-o", "candidates.vpl", "-n", _candidates(preset, vpls)]
        + common,
        ["vpl-eliminate", "candidates.vpl", "-o", "vpls.vpl", "-n", str(vpls), *threads],
        ["vpl-estimate", "scene.toml", "vpls.vpl", "-o", "lit.vpl", "--photons", preset.photons]
        + [*preset.estimate, *common],
        _render(request, ["lit.vpl"], preset.render),
    ]


def path_command(request: Request) -> list[str]:
    """The command line for a view in which VPLs find no place: paths need none."""
    return _render(request, [], ("--integrator", "path"))


def make_folder(folder: Path, private: bool) -> None:
    """Makes the folder of a render's files, or takes one whose files the add-on wrote.

    Raises OSError for files of others, and for a private folder that another user could have made.
    """
    folder.mkdir(mode=0o700 if private else 0o777, parents=True, exist_ok=True)
    state = folder.lstat()
    if private and (not stat.S_ISDIR(state.st_mode) or state.st_uid != os.getuid()):
        raise PermissionError(f"{folder} belongs to another user; save the .blend, or remove it")
    for name, line in (("scene.toml", 0), ("render.sh", 1)):
        file = folder / name
        lines = file.read_text(errors="replace").split("\n", 2) if file.exists() else []
        if lines and MARK not in lines[line : line + 1]:
            raise FileExistsError(f"{file} is not of this add-on; choose another Folder")
    for name in ("scene.glb", "world.exr"):
        if (folder / name).exists() and not (folder / "scene.toml").exists():
            raise FileExistsError(f"{folder / name} is not of this add-on; choose another Folder")


def script(lines: list[list[str]], folder: str) -> str:
    """A shell script that renders again, by the tools in `folder` or else those on the PATH."""
    head = ["#!/bin/sh -e", MARK, 'cd "$(dirname "$0")"']
    if folder:
        head.append(f"PATH={shlex.quote(folder)}:$PATH")
    return "\n".join(head + [shlex.join(command) for command in lines]) + "\n"


@dataclass(frozen=True)
class Progress:
    tool: str
    phase: str
    share: float  # done part of the phase, 0 to 1
    left_s: float | None


def _progress(tool: str, line: str) -> Progress | None:
    if not line.startswith("{"):
        return None
    told = json.loads(line)
    share = told["done"] / told["total"] if told["total"] else 0.0
    return Progress(tool, told["phase"], min(1.0, share), told["left_s"])


def _send_lines(stream: IO[str], lines: queue.Queue[str | None]) -> None:
    for line in stream:
        lines.put(line.strip())
    lines.put(None)


def run_lines(
    command: list[str], folder: Path, on_line: Callable[[str], object], stop: Callable[[], bool]
) -> int:
    """Runs a command and gives every line of its output. Returns its exit code."""
    lines: queue.Queue[str | None] = queue.Queue()
    with subprocess.Popen(
        command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, text=True, errors="replace",
    ) as child:  # fmt: skip
        assert child.stdout is not None
        reader = threading.Thread(target=_send_lines, args=(child.stdout, lines), daemon=True)
        reader.start()
        try:
            while not stop():
                try:
                    line = lines.get(timeout=0.1)
                except queue.Empty:
                    continue
                if line is None:
                    return child.wait()
                on_line(line)
            raise Cancelled
        except BaseException:
            child.terminate()
            reader.join()
            raise


def run_tool(
    command: list[str],
    folder: Path,
    bin_folder: str,
    on_progress: Callable[[Progress], object],
    stop: Callable[[], bool],
) -> list[str]:
    """Runs a tool in a folder and returns its warnings. Raises ToolError with its error."""
    tool = command[0]
    told: list[str] = []

    def listen(line: str) -> None:
        progress = _progress(tool, line)
        if progress is not None:
            on_progress(progress)
        elif line:
            told.append(line)

    words = [find_tool(tool, bin_folder), *command[1:], "--quiet", "--progress", "json"]
    code = run_lines(words, folder, listen, stop)
    if code:
        raise ToolError(told[-1] if told else f"{tool}: exit code {code}")
    return told
