#!/usr/bin/env python3
"""Tests pipelines/slurm without Slurm: stand-ins for its commands run each task at once.

tests/cluster/test_submit.py build/release/bin
"""

import filecmp
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).resolve().parents[2]
BIN = Path("build/release/bin")
SIZES = [
    "--candidates",
    "2k",
    "--vpls",
    "100",
    "--photons",
    "20k",
    "--spp",
    "1",
    "--render-flags=--size 32x24",
]

# This sbatch runs the tasks of a job one after the other if all jobs that it depends on succeeded.
SBATCH = """\
import json, os, pathlib, shlex, subprocess, sys
state = pathlib.Path(os.environ["FAKE_SLURM"])
jobs = json.loads((state / "jobs.json").read_text())
words = dict(word[2:].split("=", 1) for word in sys.argv[1:] if "=" in word)
number = str(len(jobs) + 101)
how, _, needed = words.get("dependency", ":").partition(":")
well = how != "afterok" or all(jobs[each]["well"] for each in needed.split(":"))
tasks = []
for part in words.get("array", "").split("%")[0].split(","):
    first, _, last = part.partition("-")
    tasks += range(int(first), int(last or first) + 1) if part else [None]
for task in tasks if well else []:
    log = words["output"].replace("%a", str(task))
    name = {"SLURM_ARRAY_JOB_ID": number, "SLURM_ARRAY_TASK_ID": str(task)} if task else {}
    with open(log, "a") as out:
        code = subprocess.run(words["wrap"], shell=True, stdout=out, stderr=out,
                              env=os.environ | name | {"SLURM_JOB_ID": number}).returncode
    well = well and code == 0
jobs[number] = {"name": words["job-name"], "tasks": tasks, "well": well, "words": sys.argv[1:]}
(state / "jobs.json").write_text(json.dumps(jobs))
print(number)
"""
SQUEUE = (
    "import os, pathlib\nprint((pathlib.Path(os.environ['FAKE_SLURM']) / 'queued').read_text())\n"
)
# This scontrol logs a requeue and fails, so that the task ends.
SCONTROL = """\
import os, pathlib, sys
with open(pathlib.Path(os.environ["FAKE_SLURM"]) / "requeued", "a") as log: \
print(*sys.argv[1:], file=log)
sys.exit(1)
"""
# Tools: one that is killed, and one that saves a checkpoint when it is asked to stop.
KILLED = "#!/bin/sh\nkill -9 $$\n"
SAVES = (
    "#!/bin/sh\ntrap 'echo saved > $2; trap - TERM; kill -TERM $$' TERM\ntouch "
    "$2.ready\nwhile :; do sleep 0.1; done\n"
)
# A tool that signals the time limit as soon as it begins.
LATE = SAVES.replace("touch $2.ready", "kill -USR1 $PPID")
SLOW = "#!/bin/sh\ntouch $2.ready\nwhile :; do sleep 0.1; done\n"


class SubmitTest(unittest.TestCase):
    def setUp(self) -> None:
        self.keep = tempfile.TemporaryDirectory(prefix="bnvpl-submit-")
        self.folder = Path(self.keep.name)
        self.addCleanup(self.keep.cleanup)
        for name, text in (
            ("sbatch", SBATCH),
            ("squeue", SQUEUE),
            ("scontrol", SCONTROL),
            ("scancel", ""),
        ):
            self.program(f"slurm/{name}", f"#!{sys.executable}\n{text}")
        (self.folder / "jobs.json").write_text("{}")
        (self.folder / "queued").write_text("")
        slurm = {name: value for name, value in os.environ.items() if not name.startswith("SLURM")}
        self.environment = slurm | {
            "FAKE_SLURM": str(self.folder),
            "PATH": f"{self.folder}/slurm:{os.environ['PATH']}",
        }

    def program(self, name: str, text: str) -> str:
        file = self.folder / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        file.chmod(0o755)
        return str(file)

    def call(self, *command: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *map(str, command)],
            cwd=SOURCE,
            env=self.environment,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )

    def submit(self, *more: str) -> subprocess.CompletedProcess[str]:
        return self.call(
            "pipelines/slurm/submit.py",
            "scenes/u-shape/scene.toml",
            "--out",
            str(self.folder / "out"),
            "--bin",
            str(BIN),
            *SIZES,
            *more,
        )

    def jobs(self) -> dict[str, Any]:
        """Jobs since the last call, by their names without the scene's."""
        file = self.folder / "jobs.json"
        found = json.loads(file.read_text())
        file.write_text("{}")
        return {job["name"].removeprefix("u-shape-"): job for job in found.values()}

    def at(self, name: str) -> Path:
        return self.folder / "out/u-shape" / name

    def test_makes_what_one_run_makes_and_later_only_what_is_missing(self) -> None:
        done = self.submit("--shards", "3")
        self.assertEqual(done.returncode, 0, done.stdout)
        jobs = self.jobs()
        self.assertEqual(
            list(jobs),
            [
                "place",
                "merge-place",
                "eliminate",
                "estimate",
                "merge-estimate",
                "render",
                "merge-render",
                "summary",
            ],
        )
        self.assertTrue(all(job["well"] for job in jobs.values()), self.logs())
        self.assertEqual(jobs["render"]["tasks"], [1, 2, 3])
        self.assertIn("--dependency=afterok:105", jobs["render"]["words"])
        self.assertIn("--requeue", jobs["render"]["words"])
        self.assertIn("critical path", self.at("run/summary.log").read_text())
        self.assertTrue(self.at("run/timeline.svg").read_text().startswith("<svg"))
        whole = self.folder / "whole"
        self.call(
            "pipelines/generate_ninja.py",
            "scenes/u-shape/scene.toml",
            "--out",
            str(whole),
            "--bin",
            str(BIN),
            *SIZES,
        )
        subprocess.run(
            ["ninja", "-f", str(whole / "build.ninja")],
            cwd=SOURCE,
            check=True,
            stdout=subprocess.DEVNULL,
        )
        for name in ("candidates.vpl", "vpls.vpl", "lit.vpl", "image.exr", "image.png"):
            self.assertTrue(
                filecmp.cmp(self.at(name), whole / "u-shape" / name, shallow=False), name
            )

        again = self.submit("--shards", "3")
        self.assertIn("is up to date", again.stdout)
        self.assertEqual(self.jobs(), {})
        self.at("shards/render-2-of-3.shard").unlink()
        self.assertEqual(self.submit("--shards", "3").returncode, 0)
        jobs = self.jobs()
        self.assertEqual(list(jobs), ["render", "merge-render", "summary"])
        self.assertEqual(jobs["render"]["tasks"], [2])
        self.assertEqual(self.submit("--shards", "3", "--photons", "30k").returncode, 0)
        self.assertEqual(
            list(self.jobs()), ["estimate", "merge-estimate", "render", "merge-render", "summary"]
        )
        # A task that is done does nothing when Slurm starts it again.
        task = self.call("pipelines/slurm/task.py", str(self.at("run/eliminate.job.json")))
        self.assertIn("is up to date", task.stdout)

    def logs(self) -> str:
        return "".join(file.read_text() for file in sorted(self.at("run").glob("*.log")))

    def test_what_fails_stops_what_comes_after_it_and_is_made_by_the_next_submission(self) -> None:
        self.submit("--shards", "2", "--estimate-flags=--photon-count 3")
        jobs = self.jobs()
        self.assertFalse(jobs["estimate"]["well"])
        self.assertFalse(jobs["render"]["well"])
        self.assertTrue(jobs["summary"]["well"])
        self.assertIn(
            "not done: estimate-1-of-2, exit code 2", self.at("run/summary.log").read_text()
        )
        self.assertFalse(self.at("lit.vpl").exists())
        self.submit("--shards", "2")
        jobs = self.jobs()
        self.assertEqual(
            list(jobs), ["estimate", "merge-estimate", "render", "merge-render", "summary"]
        )
        self.assertTrue(all(job["well"] for job in jobs.values()), self.logs())
        self.assertNotIn(
            "not done", self.at("run/summary.log").read_text().rpartition("tasks in")[2]
        )

    def test_ninja_records_what_its_tasks_take(self) -> None:
        self.call(
            "pipelines/generate_ninja.py",
            "scenes/u-shape/scene.toml",
            "--out",
            str(self.folder / "out"),
            "--bin",
            str(BIN),
            "--shards",
            "2",
            "--record",
            *SIZES,
        )
        ninja = ["ninja", "-f", str(self.folder / "out/build.ninja")]
        subprocess.run(ninja, cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)
        inspected = subprocess.run(
            [SOURCE / BIN / "vpl-inspect", "run", self.at("run"), "--json"],
            text=True,
            stdout=subprocess.PIPE,
        )
        run = json.loads(inspected.stdout)
        self.assertEqual(
            [(stage["stage"], stage["tasks"]) for stage in run["stages"]],
            [
                ("place", 2),
                ("merge-place", 1),
                ("eliminate", 1),
                ("estimate", 2),
                ("merge-estimate", 1),
                ("render", 2),
                ("merge-render", 1),
            ],
        )
        self.assertEqual(len(run["critical_path"]["tasks"]), 7)
        again = subprocess.run(ninja, cwd=SOURCE, text=True, stdout=subprocess.PIPE)
        self.assertIn("no work to do", again.stdout)

    def test_records_of_other_shards_are_put_aside(self) -> None:
        self.submit("--shards", "2")
        self.submit("--shards", "3")
        names = {file.name.split(".")[0] for file in self.at("run").glob("*.task.json")}
        self.assertIn("place-1-of-3", names)
        self.assertNotIn("place-1-of-2", names)
        self.assertTrue(self.at("run/earlier/place-1-of-2.1.task.json").exists())

    def test_shards_of_each_stage(self) -> None:
        done = self.submit("--dry-run", "--shards", "place=2,render=5")
        rows = {
            row.split("--job-name=u-shape-")[1].split()[0]: row for row in done.stdout.splitlines()
        }
        self.assertIn("--array=1-2 ", rows["place"])
        self.assertIn("--array=1-16 ", rows["estimate"])
        self.assertIn("--array=1-5 ", rows["render"])
        done = self.submit("--shards", "1", "--shards", "render=2")
        self.assertEqual(done.returncode, 0, done.stdout)
        jobs = self.jobs()
        self.assertEqual(
            list(jobs), ["place", "eliminate", "estimate", "render", "merge-render", "summary"]
        )
        self.assertTrue(all(job["well"] for job in jobs.values()), self.logs())
        self.assertEqual(jobs["render"]["tasks"], [1, 2])

    def test_limits_of_each_stage(self) -> None:
        done = self.submit(
            "--dry-run",
            "--memory",
            "2G,eliminate=9G",
            "--time",
            "render=2:00:00",
            "--cpus",
            "8",
            "--sbatch=--partition=long --nice",
            "--at-once",
            "5",
        )
        rows = {
            row.split("--job-name=u-shape-")[1].split()[0]: row for row in done.stdout.splitlines()
        }
        self.assertIn("--mem=9G --time=11 ", rows["eliminate"])
        self.assertIn("--mem=2G --time=2:00:00", rows["render"])
        self.assertIn("--cpus-per-task=8", rows["merge-place"])
        self.assertIn("--array=1-16%5", rows["place"])
        self.assertTrue(all("--partition=long --nice" in row for row in rows.values()))
        self.assertFalse(self.at("run").exists())

    def test_memory_and_time_follow_the_counts(self) -> None:
        def asked(*more: str) -> dict[str, list[int]]:
            done = self.submit("--dry-run", *more)
            self.assertEqual(done.returncode, 0, done.stdout)
            rows = {
                row.split("--job-name=u-shape-")[1].split()[0]: row
                for row in done.stdout.splitlines()
            }
            return {
                name: [int(re.findall(f"--{what}=(\\d+)", row)[0]) for what in ("mem", "time")]
                for name, row in rows.items()
            }

        small = asked()
        self.assertTrue(all(memory <= 384 and time <= 11 for memory, time in small.values()), small)
        large = asked(
            "--candidates",
            "100M",
            "--vpls",
            "1M",
            "--photons",
            "10G",
            "--spp",
            "64",
            "--render-flags=--size 3840x2160",
            "--shards",
            "estimate=4,render=4",
        )
        for stage in ("place", "eliminate", "estimate", "render", "merge-render"):
            self.assertGreater(large[stage][0], small[stage][0], stage)
        self.assertGreater(large["eliminate"][0], 15000)  # 100M candidates need 15 GiB
        for stage in ("eliminate", "estimate", "render"):
            self.assertGreater(large[stage][1], small[stage][1] + 5, stage)
        done = self.submit("--dry-run", "--bin", "nowhere")
        self.assertIn("nowhere/vpl-inspect", done.stdout)
        self.assertIn("--memory and --time", done.stdout)

    def test_errors_name_what_is_wrong(self) -> None:
        for more, problem in (
            (["--memory", "much"], "'much' is not a size"),
            (["--time", "paint=3"], "'paint' is none of"),
            (["--cpus", "0"], "'0' is not a count"),
            (["--shards", "0"], "--shards 0"),
            (["--shards", "merge=2"], "'merge' is none of place, estimate, render"),
            (["--place-flags=--method light"], "no work to vpl-estimate"),
            (["--at-once", "0"], "--at-once 0"),
            (["--out", "a b"], "'a b' contains a space"),
            (["--retries", "-1"], "--retries -1"),
        ):
            done = self.submit(*more)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(problem, done.stdout)
        (self.folder / "slurm/sbatch").unlink()
        self.environment["PATH"] = f"{self.folder}/slurm"
        self.assertIn("there is no sbatch here", self.submit().stdout)

    def test_what_is_refused_moves_no_records_and_submits_nothing(self) -> None:
        self.submit("--shards", "2")
        before = sorted(file.name for file in self.at("run").rglob("*"))
        self.jobs()
        done = self.submit("--shards", "3", "--photons", "many", "--bin", str(BIN.resolve()))
        self.assertNotEqual(done.returncode, 0)
        (self.folder / "slurm/sbatch").unlink()
        self.assertIn("there is no sbatch here", self.submit("--shards", "3").stdout)
        self.assertEqual(sorted(file.name for file in self.at("run").rglob("*")), before)
        self.assertEqual(self.jobs(), {})

    def test_files_of_others_stay(self) -> None:
        self.submit("--shards", "2")
        # A run replaces its own files.
        self.assertEqual(self.submit("--shards", "2", "--seed", "3").returncode, 0)
        self.jobs()
        for name, content in (
            ("jobs.json", '{"asset": {"version": "2.0"}}'),
            ("jobs.json", "[1"),
            ("render.job.json", "{}"),
            ("place.job.json", "\x89VPL"),
        ):
            file = self.at(f"run/{name}")
            own = file.read_bytes()
            file.write_text(content)
            done = self.submit("--shards", "2", "--seed", "4")
            self.assertRegex(
                done.stdout,
                rf"\Asubmit.py: \S*/{name}: is not a .* of this program, [^\n]*; name another "
                r"[^\n]*\n\Z",
            )
            self.assertEqual(done.returncode, 1)
            self.assertEqual(file.read_text(), content)
            file.write_bytes(own)
        self.assertEqual(self.jobs(), {})
        other = self.folder / "other/u-shape/run"
        other.parent.mkdir(parents=True)
        other.write_text("a file")
        self.assertIn(
            "is no folder, which the run needs there",
            self.submit("--out", str(self.folder / "other")).stdout,
        )

    def test_a_run_that_is_queued_is_not_submitted_again(self) -> None:
        self.submit("--shards", "1")
        (self.folder / "queued").write_text("101 101")
        done = self.submit("--shards", "1")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("101 of this run are still queued", done.stdout)

    def start_task(self, tool: str, retries: int = 2, **more: Any) -> subprocess.Popen[bytes]:
        """Starts task.py as job 9 for a tool of these tests."""
        saved = str(self.folder / "saved")
        task = {
            "name": "t",
            "stage": "s",
            "after": [],
            "command": [tool, "--checkpoint", saved],
            "inputs": [tool],
            "outputs": [str(self.folder / "made")],
            "depfile": "",
            "checkpoint": saved,
        }
        (self.folder / "run").mkdir(exist_ok=True)
        (self.folder / "run/s.job.json").write_text(
            json.dumps({"threads": 1, "retries": retries, "tasks": [task]})
        )
        return subprocess.Popen(
            [sys.executable, SOURCE / "pipelines/slurm/task.py", self.folder / "run/s.job.json"],
            env=self.environment | {"SLURM_JOB_ID": "9"},
            stdout=subprocess.DEVNULL,
            **more,
        )

    def wait_until_ready(self) -> None:
        while not (self.folder / "saved.ready").exists():
            time.sleep(0.05)

    def requeued(self) -> list[str]:
        file = self.folder / "requeued"
        return file.read_text().splitlines() if file.exists() else []

    def record(self, number: int) -> Any:
        return json.loads((self.folder / f"run/t.{number}.task.json").read_text())

    def test_a_killed_tool_is_queued_again_so_many_times(self) -> None:
        tool = self.program("killed", KILLED)
        for attempt, requeued in ((1, 1), (2, 2), (3, 2)):
            self.assertEqual(self.start_task(tool).wait(), 137)
            self.assertEqual(self.requeued(), ["requeue 9"] * requeued)
            self.assertEqual(self.record(attempt)["exit"], 137)

    def test_near_its_time_limit_a_task_saves_and_is_queued_again(self) -> None:
        tool = self.program("saves", SAVES)
        for attempt in (1, 2):
            (self.folder / "saved.ready").unlink(missing_ok=True)
            task = self.start_task(tool)
            self.wait_until_ready()
            task.send_signal(10)  # SIGUSR1
            self.assertEqual(task.wait(), 128 + 15)
            self.assertEqual(self.requeued(), ["requeue 9"] * attempt)
            self.assertEqual(self.record(attempt)["resumed"], attempt == 2)

    def test_a_time_limit_is_heard_while_the_tool_begins(self) -> None:
        tool = self.program("late", LATE)
        for _ in range(30):  # the signal comes before or after the tool is known
            self.assertEqual(self.start_task(tool).wait(timeout=60), 128 + 15)

    def test_whole_tasks_go_on_from_their_checkpoints(self) -> None:
        """Stops a render, one whole task of the pipeline, near its time limit."""
        arguments = [
            "--shards",
            "1",
            "--spp",
            "32",
            "--render-flags=--size 64x48 --checkpoint-every 0",
        ]
        rows = {
            row.split("--job-name=u-shape-")[1].split()[0]: row
            for row in self.submit(*arguments, "--dry-run").stdout.splitlines()
        }
        for stage in ("place", "estimate", "render"):
            self.assertIn("--signal=B:USR1@60", rows[stage])
        self.assertNotIn("--signal", rows["eliminate"])
        self.submit(*arguments)
        whole = self.at("image.exr").read_bytes()
        self.at("image.exr").unlink()
        program, job = SOURCE / "pipelines/slurm/task.py", self.at("run/render.job.json")
        task = [sys.executable, str(program), str(job)]
        begun = subprocess.Popen(
            task,
            cwd=SOURCE,
            env=self.environment | {"SLURM_JOB_ID": "9"},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        while begun.poll() is None and not self.at("render.checkpoint").exists():
            time.sleep(0.005)
        begun.send_signal(10)
        self.assertEqual(begun.wait(), 128 + 15)
        self.assertEqual(self.requeued(), ["requeue 9"])
        self.assertFalse(self.at("image.exr").exists())
        self.assertEqual(
            subprocess.run(
                task, cwd=SOURCE, env=self.environment, stdout=subprocess.DEVNULL
            ).returncode,
            0,
        )
        self.assertTrue(json.loads(self.at("run/render.3.task.json").read_text())["resumed"])
        self.assertEqual(self.at("image.exr").read_bytes(), whole)
        self.assertFalse(self.at("render.checkpoint").exists())

    def test_a_task_that_saves_nothing_before_its_time_limit_fails(self) -> None:
        tool = self.program("slow", SLOW)
        task = self.start_task(tool)
        self.wait_until_ready()
        task.send_signal(10)
        self.assertEqual(task.wait(), 128 + 15)
        self.assertEqual(self.requeued(), [])

    def test_a_task_that_is_ended_is_not_queued_again(self) -> None:
        tool = self.program("saves", SAVES)
        task = self.start_task(tool, start_new_session=True)
        self.wait_until_ready()
        os.killpg(task.pid, 15)
        self.assertEqual(task.wait(), 128 + 15)
        self.assertEqual(self.requeued(), [])

    def test_a_tool_ends_with_its_task(self) -> None:
        tool = self.program("saves", SAVES)
        task = self.start_task(tool)
        self.wait_until_ready()
        child = int(
            subprocess.run(["pgrep", "-P", str(task.pid)], text=True, stdout=subprocess.PIPE).stdout
        )
        task.kill()
        task.wait()
        for _ in range(100):
            if not self.lives(child):
                break
            time.sleep(0.1)
        self.assertFalse(self.lives(child))
        self.assertNotIn("exit", self.record(1))

    @staticmethod
    def lives(pid: int) -> bool:
        try:
            return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
        except OSError:
            return False


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        # The path is relative, as the pipelines refuse spaces.
        BIN = Path(os.path.relpath(Path(sys.argv.pop(1)).resolve(), SOURCE))
    unittest.main()
