"""Tests stages with --checkpoint, which are killed, stopped or fail at any moment.

The same command resumes them and yields the same bytes.
"""

import errno
import os
import signal
import subprocess
import unittest
from dataclasses import replace

from test_signals import SLOW_DISK, heed_interrupts
from workbench import FULL, OK, OUTPUT, Command, Workbench, moments, needs_shim

SAVE = " --checkpoint {out}/work --checkpoint-every 0"  # saves after every unit of work
RESUMED = [
    Command(
        "estimate",
        "vpl-estimate",
        "{scene} {made}/v.vpl --photons 30k -o {out}/l.vpl --depfile {out}/l.d --stats "
        "{out}/l.json" + SAVE,
        ("l.vpl", "l.d", "l.json"),
    ),
    Command(
        "shard",
        "vpl-estimate",
        "{scene} {made}/v.vpl --photons 60k --shard 2/2 -o {out}/s.shard --depfile {out}/s.d "
        "--stats {out}/s.json" + SAVE,
        ("s.shard", "s.d", "s.json"),
    ),
    Command(
        "render",
        "vpl-render",
        "{scene} {made}/l.vpl --size 40x24 --spp 24 -o {out}/i.exr --png {out}/i.png --depfile "
        "{out}/i.d"
        " --stats {out}/i.json" + SAVE,
        ("i.exr", "i.png", "i.d", "i.json"),
    ),
]


class Checkpoints(Workbench):
    def assert_done(self, command: Command, why: str) -> None:
        self.assert_all(command, "new", why)
        self.assertEqual(
            self.left_over(),
            [],
            f"{command.name}: {why}: neither checkpoint nor partial files stay",
        )

    def strike_until_done(self, command: Command, number: int, seconds: float) -> int:
        """Strikes a command until a run ends by itself. Returns the number of runs."""
        self.put_old(command)
        for run in range(1, 40):
            process = self.start(command, SLOW_DISK, preexec_fn=heed_interrupts)
            moment = self.random.uniform(0.2, 0.6) * seconds * 1.1**run  # it may have become slower
            try:
                process.wait(moment)
            except subprocess.TimeoutExpired:
                process.send_signal(number)
            result = self.finish(process, 0)
            what = (
                f"{command.name}: run {run}, {signal.Signals(number).name} after {moment:.3f} "
                f"s: {result}"
            )
            self.assertIn(result.code, (OK, -number), what)
            self.assertNotIn("broken", self.states(command).values(), what)
            if result.code == OK:
                return run
            if number != signal.SIGKILL:
                self.assertLessEqual(set(self.left_over()), {"work"}, what)
                if result.err and "no output" not in result.err and "work" in self.left_over():
                    self.assert_one_line(command, result, "goes on from")
        self.fail(f"{command.name}: does not go on from its checkpoint")

    @needs_shim
    def test_struck_until_done(self) -> None:
        for command in RESUMED:
            self.right(command)
            seconds = self.run_command(command, SLOW_DISK).seconds
            struck = 0
            for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
                runs = [
                    self.strike_until_done(command, number, seconds) for _ in range(moments(5) // 5)
                ]
                struck += sum(runs) - len(runs)
                self.run_command(command)  # removes what the killed ones left
                self.assert_done(command, f"struck by {number}")
                self.say(
                    f"{signal.Signals(number).name} {command.name}: {sum(runs)} runs for "
                    f"{len(runs)} results"
                )
            self.assertGreater(struck, 0)

    @needs_shim
    def test_every_call_that_can_fail(self) -> None:
        """Failed saving means exit code 4, unchanged outputs, and an intact checkpoint."""
        for command in RESUMED:
            self.right(command)
            for call, error in (
                ("write", errno.ENOSPC),
                ("fsync", errno.EIO),
                ("rename", errno.EIO),
            ):
                tried, at = 0, 1
                while True:
                    self.put_old(command)
                    result = self.run_command(command, {"call": call, "at": at, "errno": error})
                    what = f"{command.name}: {call} {at}: {result}"
                    if result.code == OK:
                        break
                    tried += 1
                    self.assertEqual(result.code, OUTPUT, what)
                    self.assert_one_line(command, result, os.strerror(error))
                    self.assertLessEqual(set(self.left_over()), {"work"}, what)
                    if "was replaced" not in result.err:
                        self.assertEqual(self.states(command)[command.outputs[0]], "old", what)
                    self.assertEqual(self.run_command(command).code, OK, what)
                    self.assert_done(command, what)
                    at += 1 if FULL or at < 6 else self.random.randint(at // 2, at)
                self.assertGreater(tried, 5)
                self.say(f"{command.name}: {tried} calls of {call} failed in turn")

    def test_runs_that_share_a_checkpoint(self) -> None:
        """Each run resumes from what others have saved, and tolerates that the file is removed."""
        for command in RESUMED:
            self.right(command)
            for _ in range(moments(1)):
                self.put_old(command)
                for racer in [self.start(command) for _ in range(3)]:
                    result = self.finish(racer, 0)
                    self.assertEqual((result.code, result.err), (OK, ""), command.name)
                self.assert_done(command, "three at once")

    def test_checkpoints_that_cannot_be_written(self) -> None:
        for command in RESUMED:
            self.put_old(command)
            elsewhere = replace(
                command, arguments=command.arguments.replace("{out}/work", "{out}/absent/work")
            )
            result = self.run_command(elsewhere)
            self.assertEqual(result.code, OUTPUT, f"{command.name}: {result}")
            self.assert_one_line(command, result, "absent/", "No such file or directory")
            self.assert_all(command, "old", "no folder for the checkpoint")


if __name__ == "__main__":
    unittest.main()
