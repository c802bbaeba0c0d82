#!/usr/bin/env python3
"""Runs one task of a job of submit.py, unless its files are up to date.

    task.py out/u-shape/run/place.job.json      # as task SLURM_ARRAY_TASK_ID of an array

The task is queued again and resumes from its checkpoint when it nears its time limit (SIGUSR1), and
when its tool is killed, as often as the job allows. Slurm itself requeues it when a node fails.
"""

from __future__ import annotations

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
import urllib.parse
from collections.abc import Iterable
from typing import Any

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import output_guard  # noqa: E402
import record  # noqa: E402

# A record is JSON, which holds a file name that is not UTF-8 with this prefix and its bytes quoted.
QUOTED = "quoted:"
ASKED_TO_STOP = {128 + number for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}


def recorded(file: str) -> str:
    """The name of a file as a record holds it."""
    name = os.fsencode(file)
    try:
        return name.decode()
    except UnicodeDecodeError:
        return QUOTED + urllib.parse.quote(name)


def file_of(name: str) -> str:
    """The file of a recorded name."""
    if name.startswith(QUOTED):
        return os.fsdecode(urllib.parse.unquote_to_bytes(name.removeprefix(QUOTED)))
    return name


def signature(files: Iterable[str]) -> dict[str, list[int] | None]:
    """Size and time of each file; None where it does not exist, as for a bare command name."""

    def of(file: str) -> list[int] | None:
        try:
            state = os.stat(file)
            return [state.st_size, state.st_mtime_ns]
        except OSError:
            return None

    return {recorded(file): of(file) for file in files}


def dependencies(depfile: str) -> list[str]:
    """The files that a depfile names. Spaces, # and $ in it are escaped for Make."""
    try:
        text = os.fsdecode(pathlib.Path(depfile).read_bytes()).split(":", 1)[1]
    except (OSError, IndexError):
        return []
    words = re.findall(r"(?:\\.|[^\s\\])+", text.replace("\\\n", " "))
    return [re.sub(r"\\(.)", r"\1", word).replace("$$", "$") for word in words]


def up_to_date(folder: pathlib.Path, task: dict[str, Any]) -> bool:
    """Whether the command of the task has made its present outputs from its present inputs."""
    if any(state is None for state in signature(task["outputs"]).values()):
        return False
    for earlier in record.attempts(folder, task["name"]):
        if (
            earlier
            and earlier.get("exit") == 0
            and earlier.get("command") == task["command"]
            and all(
                "made" in earlier
                and signature(map(file_of, earlier["made"][kind])) == earlier["made"][kind]
                for kind in ("inputs", "outputs")
            )
        ):
            return True
    return False


class Job:
    def __init__(self, file: str) -> None:
        self.folder = pathlib.Path(file).parent
        number = os.environ.get("SLURM_ARRAY_TASK_ID", "1")
        try:
            described = json.loads(pathlib.Path(file).read_text())
            self.retries, self.threads = described["retries"], described["threads"]
            self.task = described["tasks"][int(number) - 1]
        except (ValueError, KeyError, TypeError, IndexError):
            raise output_guard.Refused(
                f"{file}: is no job of submit.py that has a task {number}; submit again"
            ) from None
        self.attempt: record.Attempt  # set by run()
        self.out_of_time = False

    def on_time_limit(self, *_: object) -> None:
        self.out_of_time = True
        self.attempt.ask_to_stop()

    def run(self) -> int:
        task = self.task
        for output in task["outputs"]:
            output_guard.make_folder(pathlib.Path(output).parent)
        self.attempt = record.Attempt(
            self.folder,
            task["name"],
            task["stage"],
            task["after"],
            task["command"],
            task["checkpoint"],
        )
        if task["checkpoint"]:  # a task without a checkpoint would lose its work by stopping early
            signal.signal(signal.SIGUSR1, self.on_time_limit)
        before = signature(task["inputs"])
        code = self.attempt.run([*task["command"], "--threads", str(self.threads)])
        if code == 0:
            self.attempt.record["made"] = {
                "inputs": self.learned(task["depfile"]) | before,
                "outputs": signature(task["outputs"]),
            }
            self.attempt.save()
        elif self.shall_run_again(code):
            self.queue_again()
        return code

    def learned(self, depfile: str) -> dict[str, list[int] | None]:
        """Signatures of the files that only the depfile names; None where they changed meanwhile.

        The command may have read what they held before, so the task is not up to date then.
        """
        start_ns = (self.attempt.record["start_s"] - 0.01) * 1e9  # clocks of files are coarse
        found = signature(dependencies(depfile))
        return {f: state if state and state[1] < start_ns else None for f, state in found.items()}

    def shall_run_again(self, code: int) -> bool:
        if self.attempt.stopped or "SLURM_JOB_ID" not in os.environ:
            return False
        if self.out_of_time:
            begun = os.path.exists(self.task["checkpoint"])
            if not begun:
                print(
                    f"task.py: {self.task['name']} saved nothing before its time limit; give it "
                    "more --time",
                    flush=True,
                )
            return begun
        return code > 128 and code not in ASKED_TO_STOP and self.killed_before() < self.retries

    def killed_before(self) -> int:
        """Number of attempts of this job whose tools were killed."""
        mine = self.attempt.record
        return sum(
            1
            for earlier in record.attempts(self.folder, self.task["name"])
            if earlier
            and earlier["job"] == mine["job"]
            and earlier["attempt"] != mine["attempt"]
            and earlier.get("exit", 0) > 128
            and earlier["exit"] not in ASKED_TO_STOP
        )

    def queue_again(self) -> None:
        print(f"task.py: {self.task['name']} is queued again, to go on", flush=True)
        # The work is saved, so scontrol may end this process.
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        if subprocess.run(["scontrol", "requeue", os.environ["SLURM_JOB_ID"]]).returncode == 0:
            time.sleep(600)  # until Slurm ends this attempt


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(__doc__.strip())
        sys.exit(0 if sys.argv[1:] in (["-h"], ["--help"]) else 2)
    job = Job(sys.argv[1])
    if up_to_date(job.folder, job.task):
        print(f"task.py: {job.task['name']} is up to date")
        return
    sys.exit(job.run())


if __name__ == "__main__":
    output_guard.run(main)
