#!/usr/bin/env python3
"""Runs the pipeline on a real Slurm, kills tasks and nodes, and compares with a plain run.

    tests/cluster/run.py --bin build/release/bin    # 16 shards of each stage, 30 kills: minutes

Starts a cluster of four nodes on this host (slurm_cluster.py) and submits the U-shape by
pipelines/slurm/submit.py. At random moments it kills the tool of a task, or a node with all that
runs on it, which comes back a little later. Then it compares every file, byte for byte. If a run
ends before all kills are done, another one with another seed follows. The exit code is 1 when
anything is lost or differs, and 77 where Slurm is not installed.
"""

import argparse
import filecmp
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from slurm_cluster import Cluster, kill, missing_programs, processes

SOURCE = Path(__file__).resolve().parents[2]
SKIPPED = 77
SCENE = "scenes/u-shape/scene.toml"
PRODUCTS = ("candidates.vpl", "vpls.vpl", "lit.vpl", "image.exr", "image.png")
RENDER = "--render-flags=--size 240x180 --layers all"
ESTIMATE = "--estimate-flags=--irradiance-error 0"  # uses all photons
SIZES = ["--candidates", "200k", "--vpls", "1500"]
SAVE_OFTEN = [
    "--place-flags=--checkpoint-every 0",
    f"{ESTIMATE} --checkpoint-every 0.2",
    f"{RENDER} --checkpoint-every 0.2",
]


def say(text: str) -> None:
    print(f"{time.strftime('%H:%M:%S')} {text}", flush=True)


class Killer:
    """Kills tools and nodes at random moments while the run lasts.

    A task is killed at most twice. One third of the kills is for estimate, and one for render.
    """

    THIRDS = (r"place|candidates|vpls", r"estimate|lit", r"render|image")

    def __init__(self, cluster: Cluster, chance: random.Random, most: int) -> None:
        self.cluster, self.chance, self.most = cluster, chance, most
        self.struck = {"tool": 0, "node": 0}
        self.next = time.monotonic() + chance.uniform(0.5, 5)
        self.returns: dict[str, float] = {}  # time at which each node comes back
        self.victims: dict[str, int] = {}  # number of kills of each task

    def count(self) -> int:
        return sum(self.struck.values())

    def step(self) -> None:
        now = time.monotonic()
        for node in [node for node, when in self.returns.items() if when <= now]:
            del self.returns[node]
            self.cluster.start_node(node)
        if now < self.next or self.count() >= self.most:
            return
        if self.strike():
            self.next = now + self.chance.uniform(0.5, 5)

    def strike(self) -> bool:
        """Kills a tool or a node. Returns whether there was one to kill."""
        steps, running = self.cluster.steps(), processes()
        tasks = {pid: self.task_of(running, pid) for pid in sorted(steps) if pid in running}
        tools = [
            pid
            for pid, task in tasks.items()
            if task
            and self.victims.get(task, 0) < 2
            and self.count() < self.most * self.third(task) / 3
        ]
        if not tools:
            return False
        pid = self.chance.choice(tools)
        what = self.task_of(running, pid)
        self.victims[what] = self.victims.get(what, 0) + 1
        if self.chance.random() < 0.5:
            kill([pid])
            self.struck["tool"] += 1
            say(f"kill {self.count()}: {what} on {steps[pid]}")
        else:
            node = steps[pid]
            away = self.chance.uniform(6, 14)
            self.cluster.fail_node(node)
            self.returns[node] = time.monotonic() + away
            self.struck["node"] += 1
            say(f"kill {self.count()}: {node} with {what}, back in {away:.1f} s")
        return True

    def third(self, task: str) -> int:
        return next((i for i, names in enumerate(self.THIRDS, 1) if re.match(names, task)), 3)

    @staticmethod
    def task_of(running: dict[int, tuple[int, list[str]]], pid: int) -> str:
        """Name of the output of a tool that slurm/task.py has started; '' for other processes."""
        parent, words = running[pid]
        if (
            not words
            or not os.path.basename(words[0]).startswith("vpl-")
            or "-o" not in words
            or not any(word.endswith("task.py") for word in running.get(parent, (0, []))[1])
        ):
            return ""
        return os.path.basename(words[words.index("-o") + 1])


class Test:
    def __init__(self, options: argparse.Namespace, folder: str) -> None:
        self.options, self.folder = options, Path(folder)
        self.bin = Path(options.bin).resolve()
        # The path is relative, as the pipelines refuse spaces.
        self.named_bin = os.path.relpath(self.bin, SOURCE)
        self.failures: list[str] = []
        self.environment = os.environ | {"PATH": f"/usr/bin:/bin:{os.environ.get('PATH', '')}"}

    def expect(self, holds: bool, problem: str) -> None:
        if not holds:
            self.failures.append(problem)
            say(f"FAILED: {problem}")

    def arguments(self, out: str, seed: int) -> list[str]:
        return [
            SCENE,
            "--out",
            str(self.folder / out),
            "--bin",
            self.named_bin,
            "--seed",
            str(seed),
            *SIZES,
            "--photons",
            self.options.photons,
            "--spp",
            self.options.spp,
            ESTIMATE,
            RENDER,
        ]

    def run_here(self, seed: int) -> None:
        """Runs the pipeline with one process a stage."""
        began = time.monotonic()
        generate = [
            sys.executable,
            "pipelines/generate_ninja.py",
            *self.arguments(f"here-{seed}", seed),
        ]
        subprocess.run(generate, cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)
        ninja = ["ninja", "--quiet", "-f", str(self.folder / f"here-{seed}" / "build.ninja")]
        done = subprocess.run(ninja, cwd=SOURCE, text=True, stdout=subprocess.PIPE)
        if done.returncode:
            sys.exit(f"the run without shards failed:\n{done.stdout}")
        say(f"the run in one process a stage took {time.monotonic() - began:.0f} s")

    def submit(self, cluster: Cluster, seed: int) -> str:
        command = [
            sys.executable,
            "pipelines/slurm/submit.py",
            *self.arguments(f"there-{seed}", seed),
            *SAVE_OFTEN,
            "--shards",
            str(self.options.shards),
            "--cpus",
            "1",
            "--memory",
            "500M",
            "--time",
            "10",
            "--retries",
            str(self.options.kills),
        ]
        done = subprocess.run(
            command,
            cwd=SOURCE,
            env=cluster.environment | {"PATH": self.environment["PATH"]},
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        if done.returncode:
            sys.exit(f"submit.py failed:\n{done.stdout}")
        return done.stdout

    def run_there(self, cluster: Cluster, seed: int, killer: Killer) -> None:
        began = time.monotonic()
        say("submitted:\n" + self.submit(cluster, seed).rstrip())
        asked = 0.0
        while time.monotonic() - began < self.options.limit:
            killer.step()
            time.sleep(0.1)
            if time.monotonic() - asked > 2 and not killer.returns:
                asked = time.monotonic()
                jobs = cluster.ask("squeue", "-h", "-o", "%i %T")
                # An empty answer may mean that squeue failed, so sinfo must answer too. The summary
                # is the last job to end.
                if not jobs.strip() and cluster.ask("sinfo", "-h"):
                    break
        else:
            self.expect(
                False,
                f"not done after {self.options.limit} s:\n{cluster.ask('squeue')}"
                f"{cluster.ask('sinfo')}",
            )
        say(f"the run on the cluster took {time.monotonic() - began:.0f} s")

    def check(self, cluster: Cluster, seed: int) -> dict[str, Any]:
        here, there = (
            self.folder / f"here-{seed}" / "u-shape",
            self.folder / f"there-{seed}" / "u-shape",
        )
        for name in PRODUCTS:
            same = (there / name).is_file() and filecmp.cmp(
                here / name, there / name, shallow=False
            )
            self.expect(same, f"{name} {'differs' if (there / name).is_file() else 'is missing'}")
        left = [
            str(file.relative_to(there))
            for file in there.rglob("*")
            if re.search(r"\.partial|\.checkpoint$", file.name)
            and "run" not in file.relative_to(there).parts[:1]
        ]
        self.expect(not left, f"left behind: {', '.join(left)}")
        inspected = subprocess.run(
            [self.bin / "vpl-inspect", "run", there / "run", "--json"],
            text=True,
            stdout=subprocess.PIPE,
        )
        self.expect(inspected.returncode == 0, "vpl-inspect run failed")
        run: dict[str, Any] = json.loads(inspected.stdout or "{}")
        self.expect(
            run.get("tasks") == 3 * self.options.shards + 4,
            f"{run.get('tasks')} tasks are recorded",
        )
        self.expect(run.get("unfinished") == [], f"not done: {run.get('unfinished')}")
        self.expect((there / "run" / "timeline.svg").is_file(), "the summary made no timeline.svg")
        again = self.submit(cluster, seed)
        self.expect("is up to date" in again, f"submitted again, it is not up to date: {again}")
        print(
            (there / "run" / "summary.log").read_text()
            if (there / "run" / "summary.log").is_file()
            else "no summary"
        )
        if self.failures:
            self.show_logs(there)
        return run

    def show_logs(self, there: Path) -> None:
        for file in sorted((there / "run").glob("*.log")):
            say(f"{file.name}:\n{file.read_text(errors='replace')[-800:]}")

    def run(self) -> bool:
        chance = random.Random(self.options.seed)
        requeued = resumed = 0
        struck = {"tool": 0, "node": 0}
        with Cluster(self.folder / "slurm") as cluster:
            say(f"a cluster of {cluster.ask('sinfo', '-h', '-o', '%D nodes, %t').strip()}")
            for seed in range(1, 10):
                self.run_here(seed)
                killer = Killer(cluster, chance, self.options.kills - sum(struck.values()))
                self.run_there(cluster, seed, killer)
                run = self.check(cluster, seed)
                struck = {kind: count + killer.struck[kind] for kind, count in struck.items()}
                requeued += run.get("attempts", 0) - run.get("tasks", 0)
                resumed += run.get("resumed", 0)
                if self.failures or sum(struck.values()) >= self.options.kills:
                    break
            if self.failures:
                print(cluster.log_of("slurmctld"))
        if self.options.kills:
            self.expect(resumed > 0, "no task went on from a checkpoint")
        print(
            f"{'FAILED' if self.failures else 'the same bytes'}: {struck['tool']} tools and "
            f"{struck['node']} nodes killed, "
            f"{requeued} attempts more than tasks, {resumed} of them resumed from checkpoints"
        )
        return not self.failures


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", default=SOURCE / "build/release/bin")
    parser.add_argument("--shards", type=int, default=16)
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--seed", type=int, default=1, help="of the moments and victims")
    parser.add_argument(
        "--photons", default="12M", help="more make the tasks longer (default %(default)s)"
    )
    parser.add_argument("--spp", default="12", help="likewise (default %(default)s)")
    parser.add_argument(
        "--limit", type=float, default=1200, metavar="S", help="for a run on the cluster"
    )
    parser.add_argument("--keep", action="store_true", help="keep the folder, and say where it is")
    options = parser.parse_args()
    if missing := missing_programs():
        print(
            f"skipped: {', '.join(missing)} not found; apt-get install slurmctld slurmd "
            "slurm-client munge"
        )
        sys.exit(SKIPPED)
    for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(each, lambda number, _: sys.exit(128 + number))
    print(f"seed {options.seed}", flush=True)
    folder = tempfile.mkdtemp(prefix="bnvpl-slurm-")
    try:
        passed = Test(options, folder).run()
    finally:
        if options.keep:
            print(f"kept in {folder}")
        else:
            shutil.rmtree(folder, ignore_errors=True)
    sys.exit(0 if passed else 1)


if __name__ == "__main__":
    main()
