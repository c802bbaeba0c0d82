"""Tests several runs that write the same outputs at once, and numbers of threads."""

import time
import unittest

from workbench import COMMANDS, OK, USAGE, Command, Workbench, moments, needs_shim


class Races(Workbench):
    def race(self, command: Command, faults: dict[str, int] | None, rounds: int) -> None:
        self.right(command)
        for _ in range(rounds):
            self.put_old(command)
            begin = time.monotonic()
            racers = []
            for _ in range(3):
                racers.append(self.start(command, faults, ["--threads", "1"]))
                time.sleep(self.random.uniform(0, 0.3 * self.seconds[command.name]))
            for racer in racers:
                result = self.finish(racer, begin)
                self.assertEqual((result.code, result.err), (OK, ""), command.name)
            self.assert_all(command, "new", "after a race")
            self.assertEqual(self.left_over(), [])

    def test_same_outputs_at_once(self) -> None:
        for command in COMMANDS:
            self.race(command, None, moments(1) // 5 + 1)

    @needs_shim
    def test_same_outputs_at_once_on_a_slow_disk(self) -> None:
        """Each run finds the locked partial files of the others, and does not touch them."""
        for command in COMMANDS:
            self.race(command, {"delay_us": 10000}, moments(1) // 5 + 1)


class Threads(Workbench):
    def test_any_number_gives_the_same_bytes(self) -> None:
        for command in COMMANDS:
            self.right(command)
            for number in ("0", "1", "3", "500"):
                result = self.run_command(command, more=["--threads", number])
                self.assertEqual(
                    (result.code, result.err), (OK, ""), f"{command.name} --threads {number}"
                )
                self.assert_all(command, "new", f"--threads {number}")

    def test_numbers_that_are_none(self) -> None:
        for command in COMMANDS:
            for number in ("-1", "x", "1.5", "99999999999999999999"):
                result = self.run_command(command, more=[f"--threads={number}"])
                self.assertEqual(result.code, USAGE, f"{command.name} --threads {number}: {result}")


if __name__ == "__main__":
    unittest.main()
