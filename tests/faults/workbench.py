"""What the fault tests share: every command that writes files, and what it may leave behind.

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
from dataclasses import dataclass
from pathlib import Path

BIN = Path(os.environ["BNVPL_BIN"])
SOURCE = Path(os.environ["BNVPL_SOURCE"])
SHIM = os.environ.get("BNVPL_SHIM", "")  # empty where nothing can be preloaded: a sanitizer's build
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
    """A tool with its arguments; the outputs stand in the test's folder, the product first."""

    name: str
    tool: str
    arguments: str
    outputs: tuple[str, ...]

    def line(self, folder: Path) -> list[str]:
        words = [str(BIN / self.tool)]
        for word in self.arguments.split():
            words.append(word.format(scene=SCENE, made=Workbench.made, out=folder))
        return words


# A tenth of a second each on an idle core; with --quiet, so that stderr holds what went wrong.
COMMANDS = [
    Command(
        "place",
        "vpl-place",
        "{scene} -n 10k -o {out}/c.vpl --depfile {out}/c.d --stats {out}/c.json",
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
        "{scene} {made}/v.vpl --photons 50k -o {out}/l.vpl --depfile {out}/l.d --stats {out}/l.json",
        ("l.vpl", "l.d", "l.json"),
    ),
    Command(
        "render",
        "vpl-render",
        "{scene} {made}/l.vpl --spp 1 -o {out}/i.exr --png {out}/i.png --depfile {out}/i.d --stats {out}/i.json",
        ("i.exr", "i.png", "i.d", "i.json"),
    ),
    Command(
        "path",
        "vpl-render",
        "{scene} --integrator path --spp 8 -o {out}/p.exr --png {out}/p.png --depfile {out}/p.d",
        ("p.exr", "p.png", "p.d"),
    ),
    Command(
        "shard",
        "vpl-estimate",
        "{scene} {made}/v.vpl --photons 50k --shard 1/2 -o {out}/s.shard --depfile {out}/s.d --stats {out}/s.json",
        ("s.shard", "s.d", "s.json"),
    ),
    Command(
        "merge",
        "vpl-merge",
        "{made}/2.shard {made}/1.shard -o {out}/m.exr --png {out}/m.png --depfile {out}/m.d --stats {out}/m.json",
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
        "plot {made}/l.vpl --scene {scene} --size 160x120 -o {out}/d.png --depfile {out}/d.d --stats {out}/d.json",
        ("d.png", "d.d", "d.json"),
    ),
]


@dataclass
class Outcome:
    code: int  # negative: the signal that ended it
    out: str
    err: str
    seconds: float


class Workbench(unittest.TestCase):
    """Makes the inputs and each command's right outputs once; every test has an empty folder."""

    made: Path = None
    new: dict[str, bytes] = {}  # of every output but the summaries, whose times differ
    seconds: dict[str, float] = {}  # that a command takes by itself

    @classmethod
    def setUpClass(cls):
        if Workbench.made:
            return
        holder = tempfile.TemporaryDirectory(prefix="bnvpl-faults-")
        atexit.register(holder.cleanup)
        Workbench.made = Path(holder.name)
        run = lambda tool, words: subprocess.run(
            [BIN / tool, *map(str, words), "--quiet"], check=True, cwd=SOURCE
        )
        c, v, l = (Workbench.made / name for name in ("c.vpl", "v.vpl", "l.vpl"))
        run("vpl-place", [SCENE, "-o", c, "-n", "10k"])
        run("vpl-eliminate", [c, "-o", v, "-n", "500"])
        run("vpl-estimate", [SCENE, v, "-o", l, "--photons", "20k"])
        for part in ("1", "2"):
            run(
                "vpl-render",
                [
                    SCENE,
                    l,
                    "--spp",
                    "1",
                    "--shard",
                    f"{part}/2",
                    "-o",
                    Workbench.made / f"{part}.shard",
                ],
            )

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="bnvpl-faults-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.random = random.Random(time.time_ns())

    def old(self, name: str) -> bytes:
        """An older file of the kind, which alone an output replaces."""
        begin = {
            ".vpl": b"\x89VPL\r\n\x1a\n",
            ".exr": b"\x76\x2f\x31\x01",
            ".png": b"\x89PNG\r\n\x1a\n",
            ".shard": b"\x89VPLSHD\n",
            ".csv": b"old,file\n",
            ".json": b'{"tool": "vpl-old"}',
            ".d": b"old: \\\n ",
        }
        return begin[Path(name).suffix] + f"old {name}\n".encode()

    def put_old(self, command: Command) -> None:
        for name in command.outputs:
            (self.folder / name).write_bytes(self.old(name))

    def start(
        self, command: Command, faults: dict | None = None, more=(), **settings
    ) -> subprocess.Popen:
        environment = dict(os.environ)
        if faults:
            # By its name, for a path in LD_PRELOAD ends at a space.
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

    def finish(self, process: subprocess.Popen, begin: float) -> Outcome:
        try:
            out, err = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            process.kill()
            self.fail(f"{process.args} hangs")
        return Outcome(
            process.returncode,
            (out or b"").decode(),
            (err or b"").decode(),
            time.monotonic() - begin,
        )

    def run_command(
        self, command: Command, faults: dict | None = None, more=(), **settings
    ) -> Outcome:
        begin = time.monotonic()
        return self.finish(self.start(command, faults, more, **settings), begin)

    def right(self, command: Command) -> None:
        """Learns what the outputs are when nothing goes wrong, and how long that takes."""
        if command.name in self.seconds:
            return
        for _ in range(2):  # the first run finds cold files
            result = self.run_command(command)
            self.assertEqual((result.code, result.err), (OK, ""), command.name)
        self.seconds[command.name] = result.seconds
        for name in command.outputs:
            text = (self.folder / name).read_bytes()
            # The depfile names the product, whose folder is the test's own.
            self.new[name] = text.replace(str(self.folder).encode(), b"FOLDER")
            (self.folder / name).unlink()

    def state(self, command: Command, name: str) -> str:
        """'old', 'new', 'absent', or 'broken'."""
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
        """What is in the folder and no output of any command."""
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
