"""Tests inputs that vanish, shrink, grow, are overwritten or replaced while they are read.

The run yields the result of a whole file, or exit code 3 and one line. It never crashes, and never
uses half a file.
"""

import os
import shutil
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from random import Random

from workbench import COMMANDS, FULL, INPUT, OK, SCENE, Command, Workbench, moments, needs_shim

# A slow disk leaves time to change what has not been read yet.
SLOW_DISK = {"read_delay_us": 4000, "read_bytes": 16384}


def truncate(path: Path, random: Random) -> None:
    os.truncate(path, random.randrange(path.stat().st_size))


def empty(path: Path, random: Random) -> None:
    os.truncate(path, 0)


def append(path: Path, random: Random) -> None:
    with path.open("ab") as file:
        file.write(b"more")


def overwrite(path: Path, random: Random) -> None:
    with path.open("r+b") as file:
        file.seek(random.randrange(path.stat().st_size))
        file.write(bytes(random.randrange(256) for _ in range(64)))


def vanish(path: Path, random: Random) -> None:
    path.unlink()


def replace(path: Path, random: Random) -> None:
    """Replaces a file as the tools do: a reader that has opened the old file keeps it."""
    other = path.with_name("other")
    other.write_bytes(path.read_bytes())
    other.rename(path)


CHANGES = [truncate, empty, append, overwrite, vanish, replace]


@needs_shim
class ChangingInputs(Workbench):
    def with_copies(self, command: Command) -> tuple[Command, Path]:
        """The command with copies of its inputs, which may be changed, and their folder."""
        inputs = self.folder / "inputs"
        shutil.rmtree(inputs, ignore_errors=True)
        shutil.copytree(self.made, inputs)
        for file in SCENE.parent.glob(SCENE.stem + ".*"):
            shutil.copy(file, inputs)
        arguments = command.arguments.replace("{made}", str(inputs)).replace(
            "{scene}", str(inputs / SCENE.name)
        )
        return Command(command.name, command.tool, arguments, command.outputs), inputs

    def spoil(
        self, command: Command, name: str, change: Callable[[Path, Random], None], seconds: float
    ) -> int:
        copied, inputs = self.with_copies(command)
        self.put_old(command)
        begin = time.monotonic()
        process = self.start(copied, SLOW_DISK)
        time.sleep(self.random.uniform(0, seconds))
        change(inputs / name, self.random)
        result = self.finish(process, begin)
        states = {
            output: self.state(command, output)
            for output in command.outputs
            if not output.endswith(".d")
        }
        what = f"{command.name}: {change.__name__} {name}: {result} {states}"
        self.assertIn(result.code, (OK, INPUT), what)
        if result.code == INPUT:
            self.assertRegex(result.err, rf"(\A|\n){command.tool}: [^\n]+\n\Z", what)
            self.assertEqual(set(states.values()), {"old"}, what)
        elif states[command.outputs[0]] != "new":
            # A scene that changes before the tool reads it is another, whole scene.
            product = (self.folder / command.outputs[0]).read_bytes()
            self.assertEqual(self.run_command(copied).code, OK, what)
            self.assertEqual((self.folder / command.outputs[0]).read_bytes(), product, what)
        return result.code

    # The shard is left out: it names its inputs, which are copies here.
    def test_vpl_files_and_shards(self) -> None:
        for command in COMMANDS:
            for name in () if command.name == "shard" else ("c.vpl", "v.vpl", "l.vpl", "1.shard"):
                if "{made}/" + name in command.arguments:
                    self.spoil_often(command, name)

    def test_scenes(self) -> None:
        for command in COMMANDS:
            if "{scene}" in command.arguments and command.name not in ("path", "shard"):
                for name in (SCENE.name, SCENE.stem + ".obj"):
                    self.spoil_often(command, name)

    def spoil_often(self, command: Command, name: str) -> None:
        self.right(command)
        seconds = self.run_command(command, SLOW_DISK).seconds
        ends = [
            self.spoil(command, name, CHANGES[k % len(CHANGES)], seconds) for k in range(moments(6))
        ]
        self.say(
            f"{command.name} {name}: {len(ends)} changes: {ends.count(INPUT)} refused, "
            f"{ends.count(OK)} unharmed"
        )

    def test_read_errors(self) -> None:
        """Each read of an input fails in turn, and with it all later ones."""
        for command in COMMANDS:
            self.right(command)
            failed = 0
            for at in range(1, 1000, 1 if FULL else 5):
                self.put_old(command)
                result = self.run_command(command, {"call": "read", "at": at, "errno": 5})
                what = f"{command.name}: read {at}: {result}"
                if result.code == OK:
                    self.assert_all(command, "new", what)
                    break
                self.assertEqual(result.code, INPUT, what)
                self.assert_all(command, "old", what)
                failed += 1
            else:
                self.fail(f"{command.name} ended with no number of failing reads")
            self.assertGreater(failed, 0, command.name)


if __name__ == "__main__":
    unittest.main()
