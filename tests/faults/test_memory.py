"""Tests too little memory, from the least with which a tool starts to the least that it needs.

It yields exit code 6 and one line. Below that range the libraries fail to load, or end the process
before main(): log4cplus, on which OpenVDB depends, starts threads.
"""

import functools
import resource
import subprocess
import unittest
from collections.abc import Callable

from workbench import BIN, COMMANDS, FULL, MEMORY, OK, Command, Outcome, Workbench, needs_shim

MIB = 1 << 20


@needs_shim  # a sanitizer's build reserves terabytes of address space
class LimitedMemory(Workbench):
    def limit(self, mib: float) -> Callable[[], None]:
        return lambda: resource.setrlimit(resource.RLIMIT_AS, (int(mib * MIB), int(mib * MIB)))

    def limited(self, command: Command, mib: float, threads: int) -> Outcome:
        return self.run_command(
            command, more=["--threads", str(threads)], preexec_fn=self.limit(mib)
        )

    def starts(self, command: Command, mib: float) -> bool:
        done = subprocess.run(
            [BIN / command.tool, "--version"], capture_output=True, preexec_fn=self.limit(mib)
        )
        return done.returncode == OK

    def between(self, low: int, high: int, enough: Callable[[int], bool]) -> int:
        """The smallest size in MiB that is enough."""
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if enough(middle) else (middle, high)
        return high

    def test_every_limit(self) -> None:
        for command in COMMANDS:
            with self.subTest(command.name):
                self.right(command)
                least = self.between(1, 4096, functools.partial(self.starts, command))
                most = self.between(least, 8192, functools.partial(self.fits, command))
                steps = 60 if FULL else 6
                ends = []
                for step in range(steps):
                    mib = least + (most - least) * (step + self.random.random()) / steps
                    for threads in (1, 2):
                        ends.append(self.at_limit(command, mib, threads))
                self.say(
                    f"{command.name}: {least} to {most} MiB: {ends.count(MEMORY)} runs out of "
                    "memory, "
                    f"{ends.count(OK)} done"
                )

    def fits(self, command: Command, mib: float) -> bool:
        return self.limited(command, mib, 2).code == OK

    def at_limit(self, command: Command, mib: float, threads: int) -> int:
        self.put_old(command)
        result = self.limited(command, mib, threads)
        what = f"{command.name}, {mib:.1f} MiB, {threads} threads: {result}"
        self.assertIn(result.code, (OK, MEMORY), what)
        self.assertEqual(self.left_over(), [], what)
        if result.code == MEMORY:
            self.assert_one_line(command, result, "memory")
        # A thread that oneTBB starts late may fail when the outputs are written already.
        ends = {"new"} if result.code == OK else set(self.states(command).values())
        self.assertIn(ends, ({"old"}, {"new"}), what)
        self.assert_all(command, ends.pop(), what)
        return result.code


if __name__ == "__main__":
    unittest.main()
