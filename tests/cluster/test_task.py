#!/usr/bin/env python3
"""Tests pipelines/slurm/task.py: tools that are killed, and tasks near their time limit.

tests/cluster/test_task.py build/release/bin
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import slurm_stand_in
from slurm_stand_in import SOURCE, SlurmTest

# Tools: one that is killed, and one that saves a checkpoint when it is asked to stop.
KILLED = "#!/bin/sh\nkill -9 $$\n"
SAVES = (
    "#!/bin/sh\ntrap 'echo saved > $2; trap - TERM; kill -TERM $$' TERM\ntouch "
    "$2.ready\nwhile :; do sleep 0.1; done\n"
)
# A tool that signals the time limit as soon as it begins.
LATE = SAVES.replace("touch $2.ready", "kill -USR1 $PPID")
SLOW = "#!/bin/sh\ntouch $2.ready\nwhile :; do sleep 0.1; done\n"


class TaskTest(SlurmTest):
    def start_task(
        self, tool: str, retries: int = 2, inputs: tuple[str, ...] = (), **more: Any
    ) -> subprocess.Popen[bytes]:
        """Starts task.py as job 9 for a tool of these tests."""
        saved = str(self.folder / "saved")
        task = {
            "name": "t",
            "stage": "s",
            "after": [],
            "command": [tool, "--checkpoint", saved],
            "inputs": [tool, *inputs],
            "outputs": [str(self.folder / "made")],
            "depfile": str(self.folder / "made.d"),
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

    def test_inputs_that_change_while_the_tool_runs_make_its_outputs_stale(self) -> None:
        """Whether the task or only its depfile names the input."""
        for name, named in (("scene", True), ("texture", False)):
            file = self.folder / name
            file.write_text("as the tool read it\n")
            os.utime(file, (1e9, 1e9))
            change = f"[ -e {name}.changed ] || echo changed >> {name}; touch {name}.changed"
            tool = self.program(
                f"reads-{name}",
                f"#!/bin/sh\ncd '{self.folder}'; echo run >> {name}.runs; {change}\n"
                f"echo 'made: {file}' > made.d; touch made\n",
            )
            for runs in (1, 2, 2):
                task = self.start_task(tool, inputs=(str(file),) if named else ())
                self.assertEqual(task.wait(), 0)
                done = (self.folder / f"{name}.runs").read_text()
                self.assertEqual(done.count("run"), runs, name)

    def test_an_input_whose_name_is_not_text_is_watched(self) -> None:
        file = os.fsencode(self.folder) + b"/caf\xe9.png"
        Path(os.fsdecode(file)).write_text("a texture\n")
        os.utime(file, (1e9, 1e9))
        tool = self.program(
            "reads-latin-1",
            f"#!/bin/sh\ncd '{self.folder}'; echo run >> runs\n"
            f"printf 'made: {self.folder}/caf\\351.png' > made.d; touch made\n",
        )
        for runs in (1, 1, 2):
            if runs == 2:
                os.utime(file, (1e9 + 1, 1e9 + 1))
            self.assertEqual(self.start_task(tool).wait(), 0)
            self.assertEqual((self.folder / "runs").read_text().count("run"), runs)
        self.assertIn("quoted:", str(self.record(1)["made"]["inputs"]))

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
    slurm_stand_in.main()
