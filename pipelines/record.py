#!/usr/bin/env python3
"""Runs the command of a task and records what it took, for vpl-inspect run.

    pipelines/record.py out/u-shape/run place-3-of-64 --stage place -- vpl-place ...

Each attempt has a file of its own, FOLDER/TASK.ATTEMPT.task.json, which is written when the attempt
begins and again when it ends. A record without an end belongs to an attempt that was killed
together with this program, for example when its machine failed.

    task, stage, attempt       names of the task and its stage; number of the attempt, from 1
    after                      the stages whose files the task reads
    command, host, job         words of the command; node; the scheduler's job, _INDEX in an array
    resumed                    whether a checkpoint existed from which the command could resume
    start_s, end_s             seconds since 1970; there is no end_s while it runs
    cpu_s, peak_memory_MiB     cost of the command and its children; absent while it runs
    exit                       exit code; 128 plus the signal's number where a signal ended it
    made                       by slurm/task.py, of a success: size and time of inputs and outputs
"""

from __future__ import annotations

import argparse
import ctypes
import json
import os
import pathlib
import resource
import select
import signal
import socket
import subprocess
import sys
import time
from typing import Any, Union

import output_guard

SUFFIX = ".task.json"
PR_SET_PDEATHSIG = 1
Folder = Union[str, "os.PathLike[str]"]


def attempts(folder: Folder, name: str) -> list[dict[str, Any] | None]:
    """Records of the task's attempts, oldest first. A record that cannot be read is None."""
    found, number = [], 1
    while (file := record_file(folder, name, number)).exists():
        try:
            found.append(json.loads(file.read_text()))
        except (OSError, ValueError):
            found.append(None)
        number += 1
    return found


def record_file(folder: Folder, name: str, number: int) -> pathlib.Path:
    return pathlib.Path(folder) / f"{name}.{number}{SUFFIX}"


def job_id() -> str:
    job = os.environ.get("SLURM_ARRAY_JOB_ID") or os.environ.get("SLURM_JOB_ID")
    index = os.environ.get("SLURM_ARRAY_TASK_ID")
    return (f"{job}_{index}" if index else job) if job else ""


def node_name() -> str:
    return os.environ.get("SLURMD_NODENAME") or socket.gethostname()


def die_with_parent() -> None:
    """Makes the command end with this program, so that a rerun of the task never runs beside it."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class Attempt:
    """One run of a command, recorded in a file that no other attempt writes."""

    def __init__(
        self,
        folder: Folder,
        name: str,
        stage: str,
        after: list[str],
        command: list[str],
        checkpoint: str = "",
    ) -> None:
        self.record: dict[str, Any] = {
            "task": name,
            "stage": stage,
            "attempt": 1,
            "after": after,
            "command": command,
            "host": node_name(),
            "job": job_id(),
            "resumed": bool(checkpoint) and os.path.exists(checkpoint),
            "start_s": round(time.time(), 3),
        }
        self.folder = pathlib.Path(folder)
        self.process: subprocess.Popen[bytes] | None = None
        output_guard.make_folder(self.folder)
        self.claim()

    def claim(self) -> None:
        """Takes the first free number: a hard link publishes the whole file in one step."""
        while True:
            file = record_file(self.folder, self.record["task"], self.record["attempt"])
            if not file.exists():
                partial = self.write_beside()
                try:
                    os.link(partial, file)
                    return
                except FileExistsError:
                    pass
                finally:
                    partial.unlink()
            self.record["attempt"] += 1

    def write_beside(self) -> pathlib.Path:
        partial = self.folder / f".{self.record['task']}.{node_name()}.{os.getpid()}.partial"
        partial.write_text(json.dumps(self.record) + "\n")
        return partial

    def run(self, command: list[str]) -> int:
        """Runs the command. Returns its exit code, or 128 plus the signal's number."""
        # Who stops a task signals all its processes: the command saves its work, this one waits.
        for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(each, self.on_stop)
        woken, wake = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
        try:
            self.process = subprocess.Popen(command, preexec_fn=die_with_parent)
            self.tell_to_stop()
        except OSError as error:
            print(
                f"{pathlib.Path(sys.argv[0]).name}: {command[0]}: {error.strerror}", file=sys.stderr
            )
            return self.close(127, None)
        self.wait_until_ended(self.process.pid, woken)
        _, status, usage = os.wait4(self.process.pid, 0)
        code = os.waitstatus_to_exitcode(status)
        return self.close(code if code >= 0 else 128 - code, usage)

    def wait_until_ended(self, pid: int, woken: int) -> None:
        """Waits until the command ends; signals are handled meanwhile.

        Python runs the handlers of signals between its instructions only. A signal that arrives
        just before a plain wait4() blocks would not be handled until the command ends. Here it also
        writes a byte to a pipe, which ends the wait.
        """
        ended = os.pidfd_open(pid)
        while ended not in select.select([ended, woken], [], [])[0]:
            os.read(woken, 4096)
        os.close(ended)

    stopped = False
    asked_to_stop = told_to_stop = False

    def on_stop(self, *_: object) -> None:
        self.stopped = True

    def ask_to_stop(self) -> None:
        """Makes the command save its work and end, even if it has not begun yet."""
        self.asked_to_stop = True
        self.tell_to_stop()

    def tell_to_stop(self) -> None:
        process = self.process if self.process and self.process.returncode is None else None
        if self.asked_to_stop and process and not self.told_to_stop:
            self.told_to_stop = True
            process.send_signal(signal.SIGTERM)

    def close(self, code: int, usage: resource.struct_rusage | None) -> int:
        self.record |= {"end_s": round(time.time(), 3), "exit": code}
        if usage:
            self.record |= {
                "cpu_s": round(usage.ru_utime + usage.ru_stime, 3),
                "peak_memory_MiB": round(usage.ru_maxrss / 1024, 1),
            }
        self.save()
        return code

    def save(self) -> None:
        try:
            file = record_file(self.folder, self.record["task"], self.record["attempt"])
            self.write_beside().replace(file)
        except OSError as error:  # the task's output exists nevertheless
            print(f"{pathlib.Path(sys.argv[0]).name}: no record: {error}", file=sys.stderr)


def main() -> None:
    p = argparse.ArgumentParser(
        description="Run the command of a task, and record what it took for vpl-inspect run."
    )
    p.add_argument("folder", help="of the records")
    p.add_argument("task", help="its name")
    p.add_argument("--stage", required=True, help="the stage that it is part of")
    p.add_argument(
        "--after", action="append", default=[], metavar="STAGE", help="a stage whose files it reads"
    )
    p.add_argument("--checkpoint", default="", metavar="FILE", help="what the command goes on from")
    p.add_argument("command", nargs="+", help="after --")
    options = p.parse_args()
    for name in ("folder", "task"):
        if not getattr(options, name):
            p.error(f"{name} '' is empty; give it a value")
    attempt = Attempt(
        options.folder,
        options.task,
        options.stage,
        options.after,
        options.command,
        options.checkpoint,
    )
    sys.exit(attempt.run(options.command))


if __name__ == "__main__":
    output_guard.run(main)
