"""Tests stages that are killed, terminated or interrupted at a random moment.

Each output is the old file or the whole new one, a new product has its companions, and nothing else
remains.
"""

import signal
import time
import unittest

from workbench import COMMANDS, OK, PARTIAL, Command, Workbench, moments, needs_shim

# Every call takes 10 ms on this disk, so most of the run, and most moments, are in writing.
SLOW_DISK = {"delay_us": 10000}


def heed_interrupts() -> None:
    """Restores SIGINT, which background jobs of a shell ignore, and so would the tools."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class AtRandomMoments(Workbench):
    def strike(
        self, command: Command, number: int, faults: dict[str, int] | None, seconds: float
    ) -> str:
        """Sends the signal to a run at a random moment. Returns how the run ended."""
        self.put_old(command)
        moment = self.random.uniform(0, 1.1 * seconds)
        begin = time.monotonic()
        process = self.start(command, faults, preexec_fn=heed_interrupts)
        time.sleep(moment)
        process.send_signal(number)
        result = self.finish(process, begin)
        states = self.states(command)
        what = (
            f"{command.name}: {signal.Signals(number).name} after {moment:.4f} s: {result}, "
            f"{states}"
        )
        self.assertIn(result.code, (OK, -number), what)
        self.assertNotIn("broken", states.values(), what)
        self.assertNotIn("absent", states.values(), what)
        product = states[command.outputs[0]]
        if product == "new" or result.code == OK:
            self.assertEqual(set(states.values()), {"new"}, what)
        if number != signal.SIGKILL:
            self.assertEqual(self.left_over(), [], what)
        if result.code == -number and number != signal.SIGKILL and result.err:
            self.assert_one_line(command, result, f"interrupted ({signal.Signals(number).name})")
            if "no output was touched" in result.err:
                self.assertEqual(set(states.values()), {"old"}, what)
        for name in self.left_over():
            self.assertRegex(name, PARTIAL, what)
        self.assertLessEqual(len(self.left_over()), len(command.outputs), what)
        early = result.code == -number != -signal.SIGKILL and not result.err
        return "finished" if result.code == OK else "early" if early else product

    def strike_often(self, number: int, faults: dict[str, int] | None, few: int) -> None:
        for command in COMMANDS:
            with self.subTest(command.name):
                for file in self.folder.iterdir():
                    file.unlink()
                self.right(command)
                seconds = self.run_command(command, faults).seconds
                ends = [self.strike(command, number, faults, seconds) for _ in range(moments(few))]
                left = len(self.left_over())
                self.assertEqual(self.run_command(command).code, OK)
                self.assertEqual(
                    self.left_over(), [], "the next run removes what a killed one left"
                )
                self.assert_all(command, "new", "after the next run")
                counts = ", ".join(f"{ends.count(end)} {end}" for end in sorted(set(ends)))
                self.say(
                    f"{signal.Signals(number).name}{' slow disk' if faults else ''} "
                    f"{command.name}: "
                    f"{len(ends)} moments: {counts}; {left} partial files left, then none"
                )

    def test_killed(self) -> None:
        self.strike_often(signal.SIGKILL, None, 3)

    @needs_shim
    def test_killed_while_writing(self) -> None:
        self.strike_often(signal.SIGKILL, SLOW_DISK, 4)

    def test_terminated(self) -> None:
        self.strike_often(signal.SIGTERM, None, 2)

    @needs_shim
    def test_terminated_while_writing(self) -> None:
        self.strike_often(signal.SIGTERM, SLOW_DISK, 4)

    def test_interrupted(self) -> None:
        self.strike_often(signal.SIGINT, None, 2)

    @needs_shim
    def test_interrupted_while_writing(self) -> None:
        self.strike_often(signal.SIGINT, SLOW_DISK, 2)


if __name__ == "__main__":
    unittest.main()
