"""Stops GNU Make while a tool runs: saved work and finished shards stay, and make resumes.

One request to stop Make may reach the tool as several signals: that of the terminal, as the tool is
in Make's process group, and the SIGTERM that Make sends to its children.
"""

import os
import signal
import subprocess
import time
import unittest
from collections.abc import Callable
from pathlib import Path

from test_signals import heed_interrupts
from workbench import BIN, OK, SCENE, SOURCE, Outcome, Workbench, require

SETTINGS = [
    "-f",
    "pipelines/Makefile",
    f"SCENE=scene/{SCENE.name}",
    "BIN=bin",
    "CANDIDATES=2k",
    "VPLS=200",
    "PHOTONS=50k",
    "SPP=48",
    "RENDER_FLAGS=--size 64x48 --checkpoint-every 0",
    "RUN_FLAGS=--quiet --threads 2",
]


def terminate_group(pid: int) -> None:
    """Pauses Make, so that its SIGTERM reaches the tool as a second one after that of the group."""
    os.kill(pid, signal.SIGSTOP)
    os.killpg(pid, signal.SIGTERM)
    time.sleep(0.05)
    os.kill(pid, signal.SIGCONT)


class UnderMake(Workbench):
    def setUp(self) -> None:
        super().setUp()
        require("make")
        # Links avoid the project's path, which may contain a space, which Make cannot handle.
        for name, target in (
            ("pipelines", SOURCE / "pipelines"),
            ("scene", SCENE.parent),
            ("bin", BIN),
        ):
            (self.folder / name).symlink_to(target)

    def start_make(
        self, out: str | Path, *goals: str, settings: tuple[str, ...] = ()
    ) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            ["make", *SETTINGS, *settings, f"OUT={out}", *(f"{out}/{goal}" for goal in goals)],
            cwd=self.folder,
            start_new_session=True,
            preexec_fn=heed_interrupts,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    def make(self, out: str | Path, *goals: str) -> None:
        result = self.finish(self.start_make(out, *goals), time.monotonic())
        self.assertEqual((result.code, result.err), (OK, ""), result)

    def stop(
        self, process: subprocess.Popen[bytes], checkpoint: Path, send: Callable[[int], None]
    ) -> Outcome:
        """Stops the process once the tool has saved its work for the first time."""
        end = time.monotonic() + 30
        while not checkpoint.exists():
            self.assertIsNone(process.poll(), "vpl-render ends before it saves its work")
            self.assertLess(time.monotonic(), end, "vpl-render saves nothing")
            time.sleep(0.002)
        send(process.pid)
        return self.finish(process, time.monotonic())

    def test_stopped_and_made_again(self) -> None:
        self.make("whole")
        image = (self.folder / "whole/image.exr").read_bytes()
        requests = {
            "Ctrl-C, which the group gets": lambda pid: os.killpg(pid, signal.SIGINT),
            "SIGTERM to the group, which Make sends on": terminate_group,
            "SIGTERM to Make alone": lambda pid: os.kill(pid, signal.SIGTERM),
        }
        for number, (name, send) in enumerate(requests.items()):
            with self.subTest(name):
                out = self.folder / f"out{number}"
                checkpoint = out / "render.checkpoint"
                self.make(out.name, "lit.vpl")
                result = self.stop(self.start_make(out.name), checkpoint, send)
                self.assertNotEqual(result.code, OK, result)
                self.assertIn("the same command goes on from", result.err)
                self.assertTrue(checkpoint.exists(), result)
                self.assertFalse((out / "image.exr").exists(), result)
                self.make(out.name)  # there is no warning that the work begins anew
                self.assertFalse(checkpoint.exists())
                self.assertEqual((out / "image.exr").read_bytes(), image)

    def test_a_finished_shard_stays_though_its_launcher_still_runs(self) -> None:
        launcher = self.folder / "launch"
        launcher.write_text('#!/bin/sh\n"$@"\nexec sleep 60\n')
        launcher.chmod(0o755)
        shard = self.folder / "out/shards/place-1-of-2.shard"
        process = self.start_make(
            "out", "shards/place-1-of-2.shard", settings=("SHARDS=2", "LAUNCHER=./launch")
        )
        result = self.stop(process, shard, lambda pid: os.killpg(pid, signal.SIGINT))
        self.assertNotEqual(result.code, OK, result)
        self.assertTrue(shard.exists(), result)

    def test_all_is_made_again_where_that_is_asked(self) -> None:
        process = self.start_make("out", settings=("--always-make", "--dry-run"))
        result = self.finish(process, time.monotonic())
        self.assertEqual((result.code, result.err), (OK, ""), result)

    def test_a_definition_with_a_blank_is_refused(self) -> None:
        for text in ("DIR='/data/my room'", "DIR=/data/my\\ room"):
            process = self.start_make("out", settings=(f"DEFINES={text}",))
            result = self.finish(process, time.monotonic())
            self.assertNotEqual(result.code, OK, result)
            self.assertIn("is not NAME=VALUE; blanks separate definitions", result.err)


if __name__ == "__main__":
    unittest.main()
