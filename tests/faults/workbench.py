"""Shared by the fault tests: all commands that write files, and what they may leave behind.

BNVPL_BIN, BNVPL_SOURCE, BNVPL_SHIM   set by ctest
BNVPL_FAULTS=full                     50 random moments of each command instead of a few
"""

import atexit
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

BIN = Path(os.environ["BNVPL_BIN"])
SOURCE = Path(os.environ["BNVPL_SOURCE"])
# The shim is empty for builds with a sanitizer, which allow no preloading.
SHIM = os.environ.get("BNVPL_SHIM", "")
FULL = os.environ.get("BNVPL_FAULTS") == "full"
SCENE = SOURCE / "scenes/test/one-bounce.toml"
OK, INTERNAL, USAGE, INPUT, OUTPUT, DIFFERENT, MEMORY = range(7)  # core/errors.h
PARTIAL = re.compile(r"\.partial-\d+-\d+$")

needs_shim = unittest.skipUnless(
    SHIM, "a build with sanitizers takes no LD_PRELOAD and no limit on memory"
)


def moments(few: int) -> int:
    return 50 if FULL else few


@dataclass(frozen=True)
class Command:
    """A tool with its arguments. Its outputs are in the test's folder; the product is the first."""

    name: str
    tool: str
    arguments: str
    outputs: tuple[str, ...]

    def line(self, folder: Path) -> list[str]:
        words = [str(BIN / self.tool)]
        for word in self.arguments.split():
            words.append(word.format(scene=SCENE, made=Workbench.made, out=folder))
        return words


# Each takes a tenth of a second on an idle core. They run with --quiet, so stderr has errors only.
COMMANDS = [
    Command(
        "place",
        "vpl-place",
        "{scene} -n 4k -o {out}/c.vpl --depfile {out}/c.d --stats {out}/c.json",
        ("c.vpl", "c.d", "c.json"),
    ),
    Command(
        "eliminate",
        "vpl-eliminate",
        "{made}/c.vpl -n 1k -o {out}/v.vpl --depfile {out}/v.d --stats {out}/v.json",
        ("v.vpl", "v.d", "v.json"),
    ),
    Command(
        "estimate",
        "vpl-estimate",
        "{scene} {made}/v.vpl --photons 50k -o {out}/l.vpl --depfile {out}/l.d --stats "
        "{out}/l.json",
        ("l.vpl", "l.d", "l.json"),
    ),
    Command(
        "render",
        "vpl-render",
        "{scene} {made}/l.vpl --spp 1 -o {out}/i.exr --png {out}/i.png --depfile {out}/i.d "
        "--stats {out}/i.json",
        ("i.exr", "i.png", "i.d", "i.json"),
    ),
    Command(
        "path",
        "vpl-render",
        "{scene} --integrator path --spp 4 -o {out}/p.exr --png {out}/p.png --depfile {out}/p.d",
        ("p.exr", "p.png", "p.d"),
    ),
    Command(
        "shard",
        "vpl-estimate",
        "{scene} {made}/v.vpl --photons 50k --shard 1/2 -o {out}/s.shard --depfile {out}/s.d "
        "--stats {out}/s.json",
        ("s.shard", "s.d", "s.json"),
    ),
    Command(
        "merge",
        "vpl-merge",
        "{made}/2.shard {made}/1.shard -o {out}/m.exr --png {out}/m.png --depfile {out}/m.d "
        "--stats {out}/m.json",
        ("m.exr", "m.png", "m.d", "m.json"),
    ),
    Command(
        "export",
        "vpl-inspect",
        "export {made}/c.vpl -o {out}/c.csv --stats {out}/e.json",
        ("c.csv", "e.json"),
    ),
    Command(
        "plot",
        "vpl-inspect",
        "plot {made}/l.vpl --scene {scene} --size 80x60 -o {out}/d.png --depfile {out}/d.d "
        "--stats {out}/d.json",
        ("d.png", "d.d", "d.json"),
    ),
]


@dataclass
class Outcome:
    code: int  # exit code, or the negative number of the signal that ended it
    out: str
    err: str
    seconds: float


class Workbench(unittest.TestCase):
    """Makes the inputs and each command's right outputs once. Every test has an empty folder."""

    made: Path
    new: dict[str, bytes] = {}  # outputs except the summaries, whose times differ
    seconds: dict[str, float] = {}  # time that a command takes when nothing else runs

    @classmethod
    def setUpClass(cls) -> None:
        if hasattr(Workbench, "made"):
            return
        holder = tempfile.TemporaryDirectory(prefix="bnvpl-faults-")
        atexit.register(holder.cleanup)
        Workbench.made = Path(holder.name)

        def run(tool: str, words: list[Any]) -> None:
            subprocess.run([BIN / tool, *map(str, words), "--quiet"], check=True, cwd=SOURCE)

        c, v, lit = (Workbench.made / name for name in ("c.vpl", "v.vpl", "l.vpl"))
        run("vpl-place", [SCENE, "-o", c, "-n", "10k"])
        run("vpl-eliminate", [c, "-o", v, "-n", "500"])
        run("vpl-estimate", [SCENE, v, "-o", lit, "--photons", "20k"])
        for part in ("1", "2"):
            run(
                "vpl-render",
                [
                    SCENE,
                    lit,
                    "--spp",
                    "1",
                    "--shard",
                    f"{part}/2",
                    "-o",
                    Workbench.made / f"{part}.shard",
                ],
            )

    def setUp(self) -> None:
        holder = tempfile.TemporaryDirectory(prefix="bnvpl-faults-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.random = random.Random(time.time_ns())

    def old(self, name: str) -> bytes:
        """An older file of the same kind, the only one that an output may replace."""
        begin = {
            ".vpl": b"\x89VPL\r\n\x1a\n",
            ".exr": b"\x76\x2f\x31\x01\x02\0\0\0bnvpl.hash\0",
            ".png": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\0\0\0\0"
            b"\0\0\0\x13tEXtSoftware\0bnvpl 0.1\0\0\0\0IDAT",
            ".shard": b"\x89VPLSHD\n",
            ".csv": b"position_x,position_y,position_z,normal_x,normal_y,normal_z,"
            b"albedo_r,albedo_g,albedo_b,id\n",
            ".json": b'{"tool": "vpl-old"}',
            ".d": b"old: \\\n ",
        }
        return begin[Path(name).suffix] + f"old {name}\n".encode()

    def put_old(self, command: Command) -> None:
        for name in command.outputs:
            (self.folder / name).write_bytes(self.old(name))

    def start(
        self,
        command: Command,
        faults: dict[str, Any] | None = None,
        more: Iterable[str] = (),
        **settings: Any,
    ) -> subprocess.Popen[bytes]:
        environment = dict(os.environ)
        if faults:
            # Only the name is preloaded, as a path in LD_PRELOAD ends at a space.
            folder, name = os.path.split(SHIM)
            environment.update(
                {f"FAULT_{key.upper()}": str(value) for key, value in faults.items()},
                LD_PRELOAD=name,
                LD_LIBRARY_PATH=folder,
            )
        settings = {
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.PIPE,
        } | settings
        return subprocess.Popen(
            [*command.line(self.folder), "--quiet", *more], cwd=SOURCE, env=environment, **settings
        )

    def finish(self, process: subprocess.Popen[bytes], begin: float) -> Outcome:
        try:
            out, err = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            self.fail(f"{process.args!r} hangs")
        return Outcome(
            process.returncode,
            (out or b"").decode(),
            (err or b"").decode(),
            time.monotonic() - begin,
        )

    def run_command(
        self,
        command: Command,
        faults: dict[str, Any] | None = None,
        more: Iterable[str] = (),
        **settings: Any,
    ) -> Outcome:
        begin = time.monotonic()
        return self.finish(self.start(command, faults, more, **settings), begin)

    def right(self, command: Command) -> None:
        """Records the outputs and the time of an undisturbed run."""
        if command.name in self.seconds:
            return
        for _ in range(2):  # the first run only warms the file cache
            result = self.run_command(command)
            self.assertEqual((result.code, result.err), (OK, ""), command.name)
        self.seconds[command.name] = result.seconds
        for name in command.outputs:
            text = (self.folder / name).read_bytes()
            # The depfile contains the test's folder in the name of the product.
            self.new[name] = text.replace(str(self.folder).encode(), b"FOLDER")
            (self.folder / name).unlink()

    def state(self, command: Command, name: str) -> str:
        """State of an output: 'old', 'new', 'absent', or 'broken'."""
        path = self.folder / name
        if not path.exists():
            return "absent"
        text = path.read_bytes()
        if text == self.old(name):
            return "old"
        if name.endswith(".json"):
            try:
                return "new" if json.loads(text)["tool"] == command.tool else "broken"
            except (ValueError, KeyError):
                return "broken"
        return (
            "new"
            if text.replace(str(self.folder).encode(), b"FOLDER") == self.new[name]
            else "broken"
        )

    def states(self, command: Command) -> dict[str, str]:
        return {name: self.state(command, name) for name in command.outputs}

    def left_over(self) -> list[str]:
        """Names in the folder that are no outputs of any command."""
        outputs = {name for command in COMMANDS for name in command.outputs}
        return sorted({path.name for path in self.folder.iterdir()} - outputs)

    def assert_all(self, command: Command, state: str, why: str) -> None:
        self.assertEqual(
            self.states(command), dict.fromkeys(command.outputs, state), f"{command.name}: {why}"
        )

    def assert_one_line(self, command: Command, result: Outcome, *parts: str) -> None:
        what = f"{command.name}: {result}"
        self.assertRegex(result.err, rf"\A{command.tool}: [^\n]+\n\Z", what)
        self.assertNotIn("internal error", result.err, what)
        for part in parts:
            self.assertIn(part, result.err, what)

    def say(self, text: str) -> None:
        print(text, file=sys.stderr, flush=True)


def require(program: str) -> str:
    path = shutil.which(program)
    if not path:
        raise unittest.SkipTest(f"{program} is not installed")
    return path
