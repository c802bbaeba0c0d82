"""Runs the tools and measures CPU seconds, peak memory, and size of the file."""

from __future__ import annotations

import functools
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cost import Counts

if TYPE_CHECKING:
    from cost_model import Scene


class Bench:
    """Measures runs. The files that they read are made once, in `folder`."""

    def __init__(self, bin_folder: Path, folder: Path) -> None:
        self.bin, self.folder, self.spent_s = bin_folder, folder, 0.0
        self.made: dict[str, Path] = {}

    def run(self, tool: str, *words: object, threads: int = 1) -> tuple[float, float]:
        """Runs a tool. Returns CPU seconds and peak memory in MiB."""
        stats = self.folder / "stats.json"
        common = ("--quiet", "--threads", threads, "--stats", stats)
        command = [str(w) for w in (self.bin / tool, *words, *common)]
        # Linux counts the memory of the process that starts a tool as the tool's. A shell in
        # between forks, so its small memory is counted instead of this program's.
        process = subprocess.Popen(
            ["sh", "-c", '"$@"; exit $?', "sh", *command], stderr=subprocess.PIPE, text=True
        )
        assert process.stderr is not None
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            sys.exit(f"cost_model.py: {said.strip()}")
        cpu_s = usage.ru_utime + usage.ru_stime
        self.spent_s += cpu_s
        return cpu_s, json.loads(stats.read_text())["peak_memory_MiB"]

    def once(self, name: str, make: Callable[[Path], object]) -> Path:
        """The file of this name. make(file) writes it the first time."""
        if name not in self.made:
            self.made[name] = self.folder / name
            make(self.made[name])
        return self.made[name]

    def candidates(self, scene: Scene, n: float) -> Path:
        return self.once(
            f"{scene.name}.{n:.0f}.candidates.vpl",
            lambda file: self.run("vpl-place", scene.file, "-o", file, "-n", f"{n:.0f}"),
        )

    def vpls(self, scene: Scene, n: float) -> Path:
        return self.once(
            f"{scene.name}.{n:.0f}.vpls.vpl",
            lambda file: self.run(
                "vpl-eliminate", self.candidates(scene, 10 * n), "-o", file, "-n", f"{n:.0f}"
            ),
        )

    def lit(self, scene: Scene, n: float) -> Path:
        return self.once(
            f"{scene.name}.{n:.0f}.lit.vpl",
            lambda file: self.run(
                "vpl-estimate",
                scene.file,
                self.vpls(scene, n),
                "-o",
                file,
                "--method",
                "guarded",
                "--photons",
                f"{50 * n:.0f}",
            ),
        )

    def command(
        self, scene: Scene, stage: str, c: Counts, part: int = 1
    ) -> tuple[str, list[Any], str]:
        """Tool, words without -o, and extension of the output."""
        shard = ["--shard", f"{part}/{c.shards}"] if c.shards > 1 else []
        if stage == "place":
            return "vpl-place", [scene.file, "-n", f"{c.candidates:.0f}", *shard], "vpl"
        if stage == "eliminate":
            return (
                "vpl-eliminate",
                [self.candidates(scene, c.candidates), "-n", f"{c.vpls:.0f}"],
                "vpl",
            )
        if stage == "estimate":
            return (
                "vpl-estimate",
                [
                    scene.file,
                    self.vpls(scene, c.vpls),
                    "--photons",
                    f"{c.photons:.0f}",
                    "--irradiance-error",
                    "0",
                    *shard,
                ],
                "vpl",
            )
        width = round((c.pixels * 4 / 3) ** 0.5)
        return (
            "vpl-render",
            [
                scene.file,
                self.lit(scene, c.vpls),
                "--size",
                f"{width}x{c.pixels / width:.0f}",
                "--spp",
                f"{c.spp:.0f}",
                *shard,
            ],
            "exr",
        )

    def shards(self, scene: Scene, stage: str, c: Counts) -> list[Path]:
        """Shards that a merge reads. Those of images are path traced, which is fast."""

        def make(part: int, file: Path) -> None:
            tool, words, _ = self.command(scene, stage, c, part)
            words = [words[0], "--integrator", "path", *words[2:]] if stage == "render" else words
            self.run(tool, *words, "-o", file)

        beside = f"{scene.name}.{stage}.{c.candidates:.0f}-{c.vpls:.0f}-{c.pixels:.0f}"
        return [
            self.once(f"{beside}.{part}-of-{c.shards}.shard", functools.partial(make, part))
            for part in range(1, c.shards + 1)
        ]

    def measure(self, scene: Scene, stage: str, c: Counts) -> dict[str, float]:
        """Figures of one run."""
        if stage.startswith("merge-"):
            kind = stage.removeprefix("merge-")
            tool, words, ending = (
                "vpl-merge",
                self.shards(scene, kind, c),
                "exr" if kind == "render" else "vpl",
            )
        else:
            tool, words, ending = self.command(scene, stage, c)
        output = self.folder / f"out.{'shard' if tool != 'vpl-merge' and c.shards > 1 else ending}"
        output.unlink(missing_ok=True)  # the tools replace no file of another kind
        cpu_s, memory = self.run(tool, *words, "-o", output, threads=c.threads)
        found = {"cpu_s": cpu_s, "memory_MiB": memory}
        return found | ({} if tool == "vpl-merge" else {"file_bytes": output.stat().st_size})


class Repeated:
    """A run, repeated until its two least CPU times agree, as other load only adds to them."""

    AGREE, MOST = 1.04, 8

    def __init__(self, row: dict[str, Any], once: bool = False) -> None:
        self.row, self.most = row, 1 if once else self.MOST
        self.taken: list[dict[str, float]] = []

    def wanted(self) -> bool:
        least = sorted(each["cpu_s"] for each in self.taken)[:2]
        return len(self.taken) < self.most and (len(least) < 2 or least[1] > self.AGREE * least[0])

    def result(self) -> dict[str, Any]:
        return (
            self.row
            | {
                figure: round(min(each[figure] for each in self.taken), 4)
                for figure in self.taken[0]
            }
            | {"repeats": len(self.taken)}
        )
