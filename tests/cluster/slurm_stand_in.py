"""Stands in for Slurm: its commands run each task at once, in a folder of the test."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any, ClassVar

SOURCE = Path(__file__).resolve().parents[2]
SIZES = [
    "--candidates",
    "2k",
    "--vpls",
    "100",
    "--photons",
    "20k",
    "--spp",
    "1",
    "--render-flags=--size 32x24",
]

# This sbatch runs the tasks of a job one after the other if all jobs that it depends on succeeded.
SBATCH = """\
import json, os, pathlib, shlex, subprocess, sys
state = pathlib.Path(os.environ["FAKE_SLURM"])
jobs = json.loads((state / "jobs.json").read_text())
words = dict(word[2:].split("=", 1) for word in sys.argv[1:] if "=" in word)
number = str(len(jobs) + 101)
how, _, needed = words.get("dependency", ":").partition(":")
well = how != "afterok" or all(jobs[each]["well"] for each in needed.split(":"))
tasks = []
for part in words.get("array", "").split("%")[0].split(","):
    first, _, last = part.partition("-")
    tasks += range(int(first), int(last or first) + 1) if part else [None]
for task in tasks if well else []:
    log = words["output"].replace("%a", str(task))
    name = {"SLURM_ARRAY_JOB_ID": number, "SLURM_ARRAY_TASK_ID": str(task)} if task else {}
    with open(log, "a") as out:
        code = subprocess.run(words["wrap"], shell=True, stdout=out, stderr=out,
                              env=os.environ | name | {"SLURM_JOB_ID": number}).returncode
    well = well and code == 0
jobs[number] = {"name": words["job-name"], "tasks": tasks, "well": well, "words": sys.argv[1:]}
(state / "jobs.json").write_text(json.dumps(jobs))
print(number)
"""
SQUEUE = (
    "import os, pathlib\nprint((pathlib.Path(os.environ['FAKE_SLURM']) / 'queued').read_text())\n"
)
# This scontrol logs a requeue and fails, so that the task ends. It knows no limit of arrays.
SCONTROL = """\
import os, pathlib, sys
if sys.argv[1] != "requeue": sys.exit(1)
with open(pathlib.Path(os.environ["FAKE_SLURM"]) / "requeued", "a") as log: \
print(*sys.argv[1:], file=log)
sys.exit(1)
"""


class SlurmTest(unittest.TestCase):
    """A test in a folder of its own, with the commands of Slurm that this module makes."""

    bin: ClassVar[Path] = Path("build/release/bin")

    def setUp(self) -> None:
        self.keep = tempfile.TemporaryDirectory(prefix="bnvpl-submit-")
        self.folder = Path(self.keep.name)
        self.addCleanup(self.keep.cleanup)
        for name, text in (
            ("sbatch", SBATCH),
            ("squeue", SQUEUE),
            ("scontrol", SCONTROL),
            ("scancel", ""),
        ):
            self.program(f"slurm/{name}", f"#!{sys.executable}\n{text}")
        (self.folder / "jobs.json").write_text("{}")
        (self.folder / "queued").write_text("")
        slurm = {name: value for name, value in os.environ.items() if not name.startswith("SLURM")}
        self.environment = slurm | {
            "FAKE_SLURM": str(self.folder),
            "PATH": f"{self.folder}/slurm:{os.environ['PATH']}",
        }

    def program(self, name: str, text: str) -> str:
        file = self.folder / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        file.chmod(0o755)
        return str(file)

    def call(self, *command: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, *map(str, command)],
            cwd=SOURCE,
            env=self.environment,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )

    def submit(self, *more: str) -> subprocess.CompletedProcess[str]:
        return self.call(
            "pipelines/slurm/submit.py",
            "scenes/u-shape/scene.toml",
            "--out",
            str(self.folder / "out"),
            "--bin",
            str(self.bin),
            *SIZES,
            *more,
        )

    def jobs(self) -> dict[str, Any]:
        """Jobs since the last call, by their names without the scene's."""
        file = self.folder / "jobs.json"
        found = json.loads(file.read_text())
        file.write_text("{}")
        return {job["name"].removeprefix("u-shape-"): job for job in found.values()}

    def at(self, name: str) -> Path:
        return self.folder / "out/u-shape" / name

    def logs(self) -> str:
        return "".join(file.read_text() for file in sorted(self.at("run").glob("*.log")))


def main() -> None:
    """Runs the tests of the program. A first argument names the folder of the tools."""
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        # The path is relative, as the pipelines refuse spaces.
        SlurmTest.bin = Path(os.path.relpath(Path(sys.argv.pop(1)).resolve(), SOURCE))
    unittest.main()
