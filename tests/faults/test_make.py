"""GNU Make is stopped while vpl-render works with a checkpoint: the work is saved, and the next make goes on from it.

Who stops Make makes one request, but the tool may get several signals: the terminal's, as a member of Make's process
group, and the SIGTERM that Make sends on to what it runs."""

import os
import signal
import subprocess
import time
import unittest

from test_signals import heed_interrupts
from workbench import BIN, OK, SCENE, SOURCE, Workbench, require

SETTINGS = [
    "-f",
    "pipelines/Makefile",
    f"SCENE=scene/{SCENE.name}",
    "BIN=bin",
    "CANDIDATES=2k",
    "VPLS=200",
    "PHOTONS=50k",
    "SPP=128",
    "RENDER_FLAGS=--size 64x48 --checkpoint-every 0",
    "RUN_FLAGS=--quiet --threads 2",
]


def terminate_group(pid):
    """Make is held back: its SIGTERM reaches the tool as a second one, and not together with the group's."""
    os.kill(pid, signal.SIGSTOP)
    os.killpg(pid, signal.SIGTERM)
    time.sleep(0.05)
    os.kill(pid, signal.SIGCONT)


class UnderMake(Workbench):
    def setUp(self):
        super().setUp()
        require("make")
        # The project's path may hold a space, which Make cannot handle.
        for name, target in (
            ("pipelines", SOURCE / "pipelines"),
            ("scene", SCENE.parent),
            ("bin", BIN),
        ):
            (self.folder / name).symlink_to(target)

    def start_make(self, out, *goals):
        return subprocess.Popen(
            ["make", *SETTINGS, f"OUT={out}", *(f"{out}/{goal}" for goal in goals)],
            cwd=self.folder,
            start_new_session=True,
            preexec_fn=heed_interrupts,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    def make(self, out, *goals):
        result = self.finish(self.start_make(out, *goals), time.monotonic())
        self.assertEqual((result.code, result.err), (OK, ""), result)

    def stop(self, process, checkpoint, send):
        """Once the tool has saved its work for the first time."""
        end = time.monotonic() + 30
        while not checkpoint.exists():
            self.assertIsNone(process.poll(), "vpl-render ends before it saves its work")
            self.assertLess(time.monotonic(), end, "vpl-render saves nothing")
            time.sleep(0.002)
        send(process.pid)
        return self.finish(process, time.monotonic())

    def test_stopped_and_made_again(self):
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
                self.make(out.name)  # without a warning that the work begins anew
                self.assertFalse(checkpoint.exists())
                self.assertEqual((out / "image.exr").read_bytes(), image)


if __name__ == "__main__":
    unittest.main()
