#!/usr/bin/env python3
"""Runs each stage in many shards, kills tasks at random moments, and compares with a single run.

    tests/shards/long.py --bin build/release/bin        # 1,000 shards of each stage: half an hour
    tests/shards/long.py --bin build/release/bin --shards 64 --kills 100

Prints a line for each stage: whether the files are the same, and CPU seconds of shards and merge.
The exit code is 1 when a file differs.
"""

import argparse
import filecmp
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).resolve().parents[2]
SCENE = SOURCE / "scenes/u-shape/scene.toml"
SMALL_FILM = ["--size", "160x120", "--layers", "all"]


class Stage:
    def __init__(self, name: str, tool: str, arguments: list[Any], product: str) -> None:
        self.name, self.tool, self.arguments, self.product = name, tool, arguments, product


STAGES = [
    Stage("place", "vpl-place", [SCENE, "-n", "800k"], "candidates.vpl"),
    Stage("estimate", "vpl-estimate", [SCENE, "vpls.vpl", "--photons", "8M"], "lit.vpl"),
    Stage(
        "estimate by paths",
        "vpl-estimate",
        [SCENE, "vpls.vpl", "--method", "paths", "--points", "16"],
        "paths.vpl",
    ),
    Stage("render", "vpl-render", [SCENE, "lit.vpl", *SMALL_FILM, "--spp", "8"], "image.exr"),
    Stage(
        "render path",
        "vpl-render",
        [SCENE, "--integrator", "path", *SMALL_FILM, "--spp", "16"],
        "path.exr",
    ),
    Stage(
        "render light",
        "vpl-render",
        [SCENE, "--integrator", "light", *SMALL_FILM, "--spp", "64"],
        "light.exr",
    ),
]


class Runner:
    def __init__(self, bin_folder: Path, folder: str, threads: int, kills: int, seed: int) -> None:
        self.bin, self.folder, self.threads, self.kills = (
            Path(bin_folder).resolve(),
            Path(folder),
            threads,
            kills,
        )
        self.random = random.Random(seed)
        self.killed = 0

    def start(self, tool: str, arguments: Iterable[object]) -> subprocess.Popen[bytes]:
        command = [
            str(self.bin / tool),
            *map(str, arguments),
            "--quiet",
            "--threads",
            str(self.threads),
        ]
        return subprocess.Popen(command, cwd=self.folder)

    def finish(self, process: subprocess.Popen[bytes]) -> tuple[int, float]:
        """Waits for a process. Returns its exit code and CPU seconds."""
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return process.returncode, usage.ru_utime + usage.ru_stime

    def run(self, tool: str, *arguments: object) -> float:
        process = self.start(tool, arguments)
        code, seconds = self.finish(process)
        if code:
            sys.exit(f"{tool} {' '.join(map(str, arguments))}: exit code {code}")
        return seconds

    def run_and_kill(self, tool: str, arguments: list[Any], moment: float) -> float:
        """Kills a run after `moment` seconds and starts it again, as a scheduler does."""
        process = self.start(tool, arguments)
        try:
            process.wait(moment)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            process.wait()
            self.killed += 1
        return self.run(tool, *arguments)

    def check(self, stage: Stage, shards: int) -> bool:
        whole = self.run(stage.tool, *stage.arguments, "-o", stage.product)
        struck = set(self.random.sample(range(1, shards + 1), min(self.kills, shards)))
        parts, spent, began = [], 0.0, time.monotonic()
        for part in range(1, shards + 1):
            parts.append(f"{part}.shard")
            arguments = [*stage.arguments, "--shard", f"{part}/{shards}", "-o", parts[-1]]
            if part in struck:
                saved = ["--checkpoint", "work", "--checkpoint-every", "0"]
                each = (time.monotonic() - began) / (part - 1) if part > 1 else 0.1
                spent += self.run_and_kill(
                    stage.tool, arguments + saved, self.random.uniform(0, each)
                )
            else:
                spent += self.run(stage.tool, *arguments)
        self.random.shuffle(parts)
        merged = "merged" + Path(stage.product).suffix
        merging = self.run("vpl-merge", *parts, "-o", merged)
        same = filecmp.cmp(self.folder / merged, self.folder / stage.product, shallow=False)
        size = sum((self.folder / name).stat().st_size for name in parts) / 1e6
        print(
            f"{stage.name}: {shards} shards {'the same' if same else 'DIFFERENT'}; whole "
            f"{whole:.2f} s, "
            f"shards {spent:.2f} s, merge {merging:.2f} s, files {size:.1f} MB",
            flush=True,
        )
        for name in parts:
            (self.folder / name).unlink()
        return same


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", default=SOURCE / "build/release/bin")
    parser.add_argument("--shards", type=int, default=1000)
    parser.add_argument(
        "--kills", type=int, default=20, help="tasks of each stage that are killed once"
    )
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--stages", default="", help="names, with commas; all unless given")
    args = parser.parse_args()
    named = [name for name in args.stages.split(",") if name]
    with tempfile.TemporaryDirectory(prefix="bnvpl-shards-") as folder:
        runner = Runner(args.bin, folder, args.threads, args.kills, args.seed)
        runner.run("vpl-place", SCENE, "-n", "50k", "-o", "few.vpl")
        runner.run("vpl-eliminate", "few.vpl", "-n", "2000", "-o", "vpls.vpl")
        runner.run("vpl-estimate", SCENE, "vpls.vpl", "-o", "lit.vpl")
        same = [
            runner.check(stage, args.shards) for stage in STAGES if not named or stage.name in named
        ]
        print(f"{runner.killed} tasks killed")
    sys.exit(0 if all(same) else 1)


if __name__ == "__main__":
    main()
