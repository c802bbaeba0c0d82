#!/usr/bin/env python3
"""Runs the command of a task and writes down what it took, for vpl-inspect run.

  pipelines/record.py out/u-shape/run place-3-of-64 --stage place -- vpl-place ...

Each attempt has a file of its own, FOLDER/TASK.ATTEMPT.task.json: written as it begins, and again as it ends. One
that has no end was killed together with this program, as when its machine fails.

  task, stage, attempt, after    what it is, counted from 1; the stages whose files it reads
  command, host, job             the words; where; the scheduler's job, with _INDEX where it is one of an array
  resumed                        there was a checkpoint to go on from
  start_s, end_s                 seconds since 1970; no end while it runs
  cpu_s, peak_memory_MiB         of the command and all it started; no figures while it runs
  exit                           its exit code; 128 and the signal's number where a signal ended it
"""

import argparse
import ctypes
import json
import os
import pathlib
import select
import signal
import socket
import subprocess
import sys
import time

SUFFIX = ".task.json"
PR_SET_PDEATHSIG = 1


def attempts(folder, name):
    """The records of a task so far, oldest first; those that cannot be read are None."""
    found, number = [], 1
    while (file := record_file(folder, name, number)).exists():
        try:
            found.append(json.loads(file.read_text()))
        except (OSError, ValueError):
            found.append(None)
        number += 1
    return found


def record_file(folder, name, number):
    return pathlib.Path(folder) / f"{name}.{number}{SUFFIX}"


def job_id():
    job = os.environ.get("SLURM_ARRAY_JOB_ID") or os.environ.get("SLURM_JOB_ID")
    index = os.environ.get("SLURM_ARRAY_TASK_ID")
    return (f"{job}_{index}" if index else job) if job else ""


def node_name():
    return os.environ.get("SLURMD_NODENAME") or socket.gethostname()


def die_with_parent():
    """The command does not outlive this program: who runs the task again must not meet it."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


class Attempt:
    """One run of a command, recorded in a file that no other attempt writes."""

    def __init__(self, folder, name, stage, after, command, checkpoint=""):
        self.record = {
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
        self.folder, self.process = pathlib.Path(folder), None
        self.folder.mkdir(parents=True, exist_ok=True)
        self.claim()

    def claim(self):
        """Takes the first number that is free, with a whole file at once."""
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

    def write_beside(self):
        partial = self.folder / f".{self.record['task']}.{node_name()}.{os.getpid()}.partial"
        partial.write_text(json.dumps(self.record) + "\n")
        return partial

    def run(self, command):
        """The exit code, or 128 and the number of the signal."""
        # Whoever stops a task tells all its processes: the command saves its work, and this waits for it.
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
        self.wait_until_ended(woken)
        _, status, usage = os.wait4(self.process.pid, 0)
        code = os.waitstatus_to_exitcode(status)
        return self.close(code if code >= 0 else 128 - code, usage)

    def wait_until_ended(self, woken):
        """Python runs handlers of signals between its instructions only. A signal that comes just before a plain wait4()
        blocks would not be heard until the command ends; here its byte in the pipe ends the wait."""
        ended = os.pidfd_open(self.process.pid)
        while ended not in select.select([ended, woken], [], [])[0]:
            os.read(woken, 4096)
        os.close(ended)

    stopped = False
    asked_to_stop = told_to_stop = False

    def on_stop(self, *_):
        self.stopped = True

    def ask_to_stop(self):
        """Lets the command save its work and end, also where it is just about to begin."""
        self.asked_to_stop = True
        self.tell_to_stop()

    def tell_to_stop(self):
        running = self.process and self.process.returncode is None
        if self.asked_to_stop and running and not self.told_to_stop:
            self.told_to_stop = True
            self.process.send_signal(signal.SIGTERM)

    def close(self, code, usage):
        self.record |= {"end_s": round(time.time(), 3), "exit": code}
        if usage:
            self.record |= {
                "cpu_s": round(usage.ru_utime + usage.ru_stime, 3),
                "peak_memory_MiB": round(usage.ru_maxrss / 1024, 1),
            }
        self.save()
        return code

    def save(self):
        try:
            file = record_file(self.folder, self.record["task"], self.record["attempt"])
            self.write_beside().replace(file)
        except OSError as error:  # the work is done all the same
            print(f"{pathlib.Path(sys.argv[0]).name}: no record: {error}", file=sys.stderr)


def main():
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
    main()
