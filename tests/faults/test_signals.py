"""A stage that is killed, terminated or interrupted at a random moment: each output is the old file or the whole new
one, a new product has its companions, and nothing else stays behind."""

import signal
import time
import unittest

from workbench import COMMANDS, OK, PARTIAL, Workbench, moments, needs_shim

# A disk on which every call takes 10 ms: most of the run is writing, so that most moments fall into it.
SLOW_DISK = {"delay_us": 10000}


def heed_interrupts():
    """A shell ignores Ctrl-C in what it starts in the background, and the tools keep to that."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class AtRandomMoments(Workbench):
    def strike(self, command, number, faults, seconds):
        """One run that gets the signal at a random moment; returns how it ended."""
        self.put_old(command)
        moment = self.random.uniform(0, 1.1 * seconds)
        begin = time.monotonic()
        process = self.start(command, faults, preexec_fn=heed_interrupts)
        time.sleep(moment)
        process.send_signal(number)
        result = self.finish(process, begin)
        states = self.states(command)
        what = f"{command.name}: {signal.Signals(number).name} after {moment:.4f} s: {result}, {states}"
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

    def strike_often(self, number, faults, few):
        for command in COMMANDS:
            with self.subTest(command.name):
                for left in self.folder.iterdir():
                    left.unlink()
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
                    f"{signal.Signals(number).name}{' slow disk' if faults else ''} {command.name}: "
                    f"{len(ends)} moments: {counts}; {left} partial files left, then none"
                )

    def test_killed(self):
        self.strike_often(signal.SIGKILL, None, 3)

    @needs_shim
    def test_killed_while_writing(self):
        self.strike_often(signal.SIGKILL, SLOW_DISK, 4)

    def test_terminated(self):
        self.strike_often(signal.SIGTERM, None, 2)

    @needs_shim
    def test_terminated_while_writing(self):
        self.strike_often(signal.SIGTERM, SLOW_DISK, 4)

    def test_interrupted(self):
        self.strike_often(signal.SIGINT, None, 2)

    @needs_shim
    def test_interrupted_while_writing(self):
        self.strike_often(signal.SIGINT, SLOW_DISK, 2)


if __name__ == "__main__":
    unittest.main()
