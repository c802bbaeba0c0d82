"""Renders the views of a case with vpl-render and with Cycles, for cross_check.py."""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import compare
from cases import Case, View

HERE = Path(__file__).resolve().parent


class ToolError(Exception):
    """A program is missing or failed; the message is one line."""


def require_program(name: str, cure: str) -> str:
    found = shutil.which(name)
    if not found:
        raise ToolError(f"{name}: no such program; {cure}")
    return found


def run(command: list[str], log: Path, wanted: list[Path]) -> float:
    """Runs a command. Returns its wall time in s.

    Blender may fail with exit code 0, so its outputs are checked.
    """
    start = time.monotonic()
    with open(log, "w") as out:
        done = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT, check=False)
    missing = [path for path in wanted if not path.is_file()]
    if done.returncode != 0 or missing:
        told = [
            line
            for line in log.read_text().splitlines()
            if re.match(r"\S+: ", line) and not line.startswith("Fra:")
        ]
        cause = told[-1] if told else f"exit code {done.returncode}"
        raise ToolError(f"{Path(command[0]).name} failed: {cause}; all it said is in {log}")
    return time.monotonic() - start


def samples(case: Case, options: argparse.Namespace) -> tuple[int, int]:
    return (
        max(1, round(case.spp * options.effort)),
        max(1, round(case.cycles_spp * options.effort)),
    )


def render_ours(
    case: Case, scene: Path, options: argparse.Namespace
) -> tuple[dict[View, npt.NDArray[Any]], float]:
    spp, seconds = samples(case, options)[0], 0.0
    stacks = {}
    for view in case.views:
        images = []
        for seed in range(1, case.seeds + 1):
            image = scene.parent / f"ours.{view.name}.{spp}spp.{seed}.exr"
            command = [
                options.vpl_render,
                str(scene),
                "-o",
                str(image),
                "--integrator",
                "path",
                "--only",
                view.quantity,
                "--spp",
                str(spp),
                "--seed",
                str(seed),
                "--threads",
                str(options.threads),
                "--quiet",
                "--size",
                "x".join(map(str, case.size)),
            ]
            if view.quantity != "direct":  # direct light has no bounce
                command += ["--max-bounces", str(view.bounces)]
            if not (options.reuse and image.is_file()):
                image.unlink(missing_ok=True)
                seconds += run(command, scene.parent / "ours.log", [image])
            images.append(compare.read_exr(image))
        stacks[view] = np.stack(images)
    return stacks, seconds


def cycles_bounces(views: tuple[View, ...]) -> list[int]:
    """Limits of bounces to render. Cycles' indirect picture is the whole minus the direct one."""
    limits = {view.bounces for view in views}
    return sorted(limits | ({0} if any(v.quantity == "indirect" for v in views) else set()))


def missing_images(
    limits: list[int], seeds: range, path: Callable[[int, int], Path], reuse: bool
) -> dict[tuple[int, ...], list[int]]:
    """Limits of bounces to render for each set of seeds. Each entry is one start of Blender."""
    jobs: dict[tuple[int, ...], list[int]] = {}
    for bounces in limits:
        todo = tuple(s for s in seeds if not (reuse and path(bounces, s).is_file()))
        if todo:
            jobs.setdefault(todo, []).append(bounces)
    return jobs


def render_cycles(
    case: Case, scene: Path, options: argparse.Namespace
) -> tuple[dict[View, npt.NDArray[Any]], float]:
    spp, seconds = samples(case, options)[1], 0.0
    limits, seeds = cycles_bounces(case.views), range(1, case.seeds + 1)
    kind = "cycles-encoded" if options.encoded_textures else "cycles"
    name = f"{kind}.{{bounces}}.{spp}spp.{{seed}}.exr"

    def path(bounces: int, seed: int) -> Path:
        return scene.parent / name.format(bounces=bounces, seed=seed)

    for todo, bounces in missing_images(limits, seeds, path, options.reuse).items():
        wanted = [path(b, s) for b in bounces for s in todo]
        for image in wanted:
            image.unlink(missing_ok=True)
        command = [
            options.blender,
            "-b",
            "--factory-startup",
            "--python-exit-code",
            "3",
            "--python",
            str(HERE / "render_cycles.py"),
            "--",
            str(scene),
            "--output",
            str(scene.parent / name),
            "--spp",
            str(spp),
            "--bounces",
            ",".join(map(str, bounces)),
            "--seeds",
            ",".join(map(str, todo)),
            "--threads",
            str(options.threads),
        ]
        command += ["--encoded-textures"] if options.encoded_textures else []
        seconds += run(command, scene.parent / "cycles.log", wanted)
    stacks = {b: np.stack([compare.read_exr(path(b, s)) for s in seeds]) for b in limits}
    return {
        v: stacks[v.bounces] - (stacks[0] if v.quantity == "indirect" else 0.0) for v in case.views
    }, seconds
