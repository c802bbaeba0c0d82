"""Tests several runs that write the same outputs at once, and numbers of threads."""

import subprocess
import time
import unittest
from typing import Any

from workbench import COMMANDS, OK, SOURCE, USAGE, Command, Workbench, moments, needs_shim, require


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

    def start_with_seed(self, command: Command, seed: str, faults: dict[str, int] | None) -> Any:
        return self.start(command, faults, ["--threads", "1", "--seed", seed])

    @needs_shim
    def test_all_outputs_are_of_one_run(self) -> None:
        """Runs of different seeds end at about the same time, with time between their renames."""
        command = next(each for each in COMMANDS if each.name == "path")
        products, images = ("p.exr", "p.png"), {}
        for seed in ("1", "2", "3"):
            self.assertEqual(self.finish(self.start_with_seed(command, seed, None), 0).code, OK)
            images[tuple((self.folder / name).read_bytes() for name in products)] = seed
        self.assertEqual(len(images), 3)
        for _ in range(moments(15)):
            for racer in [
                self.start_with_seed(command, seed, {"delay_us": 10000}) for seed in images.values()
            ]:
                result = self.finish(racer, 0)
                self.assertEqual((result.code, result.err), (OK, ""))
            self.assertIn(tuple((self.folder / name).read_bytes() for name in products), images)
            self.assertEqual(self.left_over(), [])

    def test_a_folder_that_a_script_has_locked(self) -> None:
        """A run within `flock out vpl-render ...` waits a little, and goes on."""
        require("flock")
        command = next(each for each in COMMANDS if each.name == "path")
        words = ["flock", self.folder, *command.line(self.folder), "--quiet"]
        line = [str(word) for word in words]
        result = subprocess.run(line, cwd=SOURCE, capture_output=True, text=True, timeout=30)
        self.assertEqual((result.returncode, result.stderr), (OK, ""))


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
