#!/usr/bin/env python3
"""Programs of pipelines/ refuse values and files in one line, without traceback or output.

tests/pipeline/test_programs.py build/release/bin
"""

import ast
import importlib
import os
import re
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Sequence
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).resolve().parents[2]
BIN = Path("build/release/bin")
TAKE_TOOLS = ("generate_ninja.py", "slurm/submit.py")
SMALL = ["CANDIDATES=2k", "VPLS=200", "PHOTONS=20k", "SPP=1", "RUN_FLAGS=--quiet"]


class Programs(unittest.TestCase):
    def setUp(self) -> None:
        holder = tempfile.TemporaryDirectory(prefix="bnvpl-programs-")
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        # The project's path may hold a space, which neither Make nor the scripts can handle.
        for target in (SOURCE / "pipelines", SOURCE / "scenes"):
            (self.folder / target.name).symlink_to(target)
        (self.folder / "bin").symlink_to(BIN)
        self.scene = "scenes/test/one-bounce.toml"
        (self.folder / "notes").write_text("somebody's\n")

    def call(self, *command: str | Path, **settings: Any) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(word) for word in command],
            cwd=self.folder,
            text=True,
            capture_output=True,
            timeout=60,
            env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
            **settings,
        )

    def refused(self, command: Sequence[str | Path], *parts: str, **settings: Any) -> None:
        before = self.listing()
        result = self.call(*command, **settings)
        self.assertNotEqual(result.returncode, 0, result)
        self.assertGreater(result.returncode, 0, result)  # no signal
        lines = [
            line for line in result.stderr.splitlines() if not line.startswith(("usage: ", " "))
        ]
        self.assertEqual(len(lines), 1, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        for part in parts:
            self.assertIn(part, lines[0])
        self.assertEqual(self.listing(), before)

    def listing(self) -> list[str]:
        return sorted(str(path) for path in self.folder.rglob("*"))

    def script(self, name: str, *words: str) -> list[str]:
        tools = ["--bin", "bin"] if name in TAKE_TOOLS and "--bin" not in words else []
        return [sys.executable, f"pipelines/{name}", *tools, *words]

    def farm(self, *words: str) -> list[str]:
        return [sys.executable, str(SOURCE / "eval/scaling/farm.py"), *words]

    def make(self, *words: str) -> list[str]:
        given = ["BIN=bin", f"SCENE={self.scene}", *SMALL, *words]
        return ["make", "-f", "pipelines/Makefile", *given]


class Snakefile(unittest.TestCase):
    def test_it_calls_functions_that_exist(self) -> None:
        """Snakemake is not installed everywhere, so that its own test may be skipped."""
        text = (SOURCE / "pipelines/Snakefile").read_text()
        sys.path.insert(0, str(SOURCE / "pipelines"))
        used = set(re.findall(r"\b(stages|stage_options|tool_options)\.(\w+)", text))
        self.assertGreater(len(used), 4)
        for module, name in used:
            found = importlib.import_module(module)
            self.assertEqual(getattr(found, name).__module__, module, f"{module}.{name}")


class Nodes(unittest.TestCase):
    def test_their_programs_are_of_python_3_9(self) -> None:
        """Annotations are not evaluated there; types with | at other places would be."""
        for name in ("slurm/task.py", "record.py", "output_guard.py"):
            tree = ast.parse((SOURCE / "pipelines" / name).read_text(), feature_version=(3, 9))
            imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
            self.assertIn("__future__", [node.module for node in imports], name)
            for node in tree.body:
                if isinstance(node, ast.Assign):
                    unions = [n for n in ast.walk(node) if isinstance(n, ast.BitOr)]
                    self.assertEqual(unions, [], f"{name}:{node.lineno}")


class Values(Programs):
    def test_empty_values(self) -> None:
        """Empty values come from unset variables; an empty OUT would be the root folder."""
        for name in ("OUT", "SCENE", "BIN", "CANDIDATES", "VPLS", "PHOTONS"):
            self.refused(self.make("-n", f"{name}="), f"{name} is empty; give it a value")
        for program in ("generate_ninja.py", "slurm/submit.py"):
            for name in ("out", "bin", "candidates", "vpls", "photons"):
                more = ["--dry-run"] if "submit" in program else []
                self.refused(
                    self.script(program, self.scene, f"--{name}", "", *more),
                    f"--{name} '' is empty",
                )
            self.refused(self.script(program, ""), "there is no scene ''")
        self.refused(
            self.script("record.py", "", "task", "--stage", "place", "--", "true"),
            "folder '' is empty",
        )

    def test_numbers_of_shards(self) -> None:
        """Make ends by a signal where a list of names is too long."""
        for count in ("99999999", "1501", "18446744073709551617", "inf", "place=99999999", "1e3"):
            self.refused(
                self.make("OUT=out", f"SHARDS={count}"), "is not a whole number from 1 to 1500"
            )
        self.refused(
            self.script("generate_ninja.py", self.scene, "--shards", "99999999"),
            "is more than 1500",
        )

    def test_quotes_that_are_not_closed(self) -> None:
        for option in (
            "--place-flags",
            "--eliminate-flags",
            "--estimate-flags",
            "--render-flags",
            "--launcher",
        ):
            words = [f"{option}=--x 'y", "--shards", "2"]
            self.refused(
                self.script("generate_ninja.py", self.scene, *words), option, "No closing quotation"
            )
        self.refused(
            self.script(
                "slurm/submit.py",
                self.scene,
                "--dry-run",
                "--memory",
                "1G",
                "--time",
                "9",
                "--sbatch='x",
            ),
            "--sbatch",
            "No closing quotation",
        )

    def test_commas(self) -> None:
        """A comma in a name is no separator of arguments of a function of Make."""
        (self.folder / "my,room").symlink_to(SOURCE / "scenes/test")
        for more, out in (
            (["SCENE=my,room/one-bounce.toml"], "out/my,room-one-bounce"),
            (["OUT=a,b"], "a,b"),
            (["OUT=c,d", "SHARDS=2"], "c,d"),
        ):
            result = self.call(*self.make(*more))
            self.assertEqual((result.returncode, result.stderr), (0, ""), result)
            self.assertTrue((self.folder / out / "image.png").exists(), result)
            self.assertIn("Nothing to be done", self.call(*self.make(*more)).stdout)
            self.assertEqual(self.call(*self.make(*more, "clean")).returncode, 0)
            self.assertFalse((self.folder / out / "image.exr").exists())

    def test_views_that_are_none(self) -> None:
        for option in ("--views", "--place-views"):
            for text in ("", ",", ",,"):
                self.refused(
                    self.script("generate_ninja.py", self.scene, f"{option}={text}"),
                    f"{option}: '{text}' names no view",
                )

    def test_paths_that_look_like_options(self) -> None:
        for name in ("OUT", "SCENE"):
            self.refused(self.make("-n", f"{name}=-x"), f"{name}='-x' begins with -", "write ./-x")
        self.refused(self.script("generate_ninja.py", self.scene, "--out=-x"), "write ./-x")
        self.assertEqual(self.call(*self.make("OUT=./-x", "./-x/candidates.vpl")).returncode, 0)
        self.assertTrue((self.folder / "-x/candidates.vpl").exists())


class ToolOptions(Programs):
    """What the tools would refuse only when they run."""

    def test_counts_and_seeds(self) -> None:
        for option, text, problem in (
            ("--candidates", "foo", "is not a whole number such as 3000, 3k or 10M"),
            ("--vpls", "-5", "is out of range: 1 to"),
            ("--photons", "1.5", "is not a whole number"),
            ("--photons", "9T", "is not a whole number"),
            ("--spp", "0", "is out of range: 1 to"),
            ("--seed", "x", "is not a whole number"),
            ("--define", "DIR", "is not NAME=VALUE"),
        ):
            self.refused(
                self.script("generate_ninja.py", self.scene, f"{option}={text}"),
                f"{option} '{text}' {problem}",
            )

    def test_flags_of_a_stage(self) -> None:
        for stage, words, problem in (
            ("render", "--siz 3x3", "--siz is no option of vpl-render; did you mean --size?"),
            ("render", "--size=3", "--size '3' is not WIDTHxHEIGHT"),
            ("render", "--gather al", "--gather 'al' is none of its choices; did you mean all?"),
            ("render", "--time", "--time needs a value: DURATION"),
            ("render", "--time --quiet", "--time needs a value: DURATION"),
            ("render", "--time 2", "--time '2' is not a duration"),
            ("render", "--clamp -1", "--clamp '-1' is out of range"),
            ("estimate", "-z 3", "-z is no option of vpl-estimate; see vpl-estimate --help"),
            ("place", "more", "'more' is neither an option of vpl-place nor the value of one"),
            ("eliminate", "--uniform-share x", "--uniform-share 'x' is not a number"),
            ("estimate", "--stats x", "--stats is given to vpl-estimate twice; leave it out"),
        ):
            self.refused(
                self.script("generate_ninja.py", self.scene, f"--{stage}-flags={words}"),
                f"--{stage}-flags: {problem}",
            )

    def test_what_the_tools_take(self) -> None:
        flags = "--size=8x6 --exposure -2 --layers N,Z --define A=b --quiet --split .5 --max-cut 1K"
        counts = ["--candidates=1.5k", "--photons=1e5", "--vpls=1K", "--spp=", "--seed=3"]
        words = [*counts, f"--render-flags={flags}", "--define=A=b=c", "--quality=final"]
        done = self.call(*self.script("generate_ninja.py", self.scene, *words))
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_folders_without_tools(self) -> None:
        for folder, problem in (("/nope", "is missing"), ("broken", "does not run here")):
            broken = self.folder / "broken/vpl-place"
            broken.parent.mkdir(exist_ok=True)
            broken.touch()
            self.refused(
                self.script("generate_ninja.py", self.scene, "--bin", folder),
                f"{folder}/vpl-place: {problem}; build the project first, or pass --bin",
            )


class Make(Programs):
    def test_variables_that_nothing_reads(self) -> None:
        for word, cure in (
            ("QUALTIY=final", "did you mean QUALITY?"),
            ("PHOTON=40M", "did you mean PHOTONS?"),
            ("spp=3", "did you mean SPP?"),
            ("THREADS=4", "use SCENE OUT"),
            ("SPONZA_DIR=/data", "DEFINES='SPONZA_DIR=...' for a scene"),
        ):
            name = word.partition("=")[0]
            self.refused(self.make("-n", word), f"{name} is no variable of this Makefile; ", cure)
        for words in (["SHELL=/bin/bash"], ["CC=gcc", "CFLAGS=-O2"], ["QUALITY=x", "VPLS.x=9"]):
            self.assertEqual(self.call(*self.make("-n", *words)).returncode, 0, words)

    def test_variables_of_a_makefile_that_calls_this_one(self) -> None:
        (self.folder / "outer").write_text(f"all:\n\t@$(MAKE) -n {' '.join(self.make()[1:])}\n")
        for word, code in (("PROJECT=film", 0), ("THREADS=4", 0), ("PHOTON=9", 2)):
            self.assertEqual(self.call("make", "-f", "outer", word).returncode, code, word)

    def test_a_file_where_the_folder_is_to_be(self) -> None:
        for out in ("notes", "notes/below/it"):
            self.refused(self.make(f"OUT={out}"), f"OUT='{out}': notes is no folder; choose")

    def test_clean_keeps_what_the_tools_would_not_replace(self) -> None:
        out = self.folder / "out"
        out.mkdir()
        own = {name: f"{name} of somebody" for name in ("image.png", "eliminate.d", "place.shard")}
        for name, text in own.items():
            (out / name).write_text(text)

        def left() -> dict[str, str]:
            os.mkfifo(out / "render.checkpoint")  # clean does not wait for its bytes
            self.assertEqual(self.call(*self.make("OUT=out", "clean")).returncode, 0)
            (out / "render.checkpoint").unlink()
            return {path.name: path.read_text() for path in out.rglob("*")}

        for replaced in (False, True):
            if replaced:  # after a run that went well
                (out / "image.png").unlink()
                self.assertEqual(self.call(*self.make("OUT=out")).returncode, 0)
                (out / "image.png").write_text(own["image.png"])
            done = self.call(*self.make("OUT=out", "SPP=2"))
            self.assertIn("out/image.png: is not a PNG picture of vpl-render", done.stderr)
            self.assertTrue((out / "lit.vpl").exists())
            self.assertEqual(left(), own)

    def test_clean_removes_what_a_run_left(self) -> None:
        """This holds for shards of other counts and for a stage whose later run has failed."""
        for shards in ("2", "render=3", "1"):
            self.assertEqual(self.call(*self.make("OUT=out", f"SHARDS={shards}")).returncode, 0)
        self.assertNotEqual(self.call(*self.make("OUT=out", "SPP=x")).returncode, 0)
        (self.folder / "out/render.checkpoint").write_bytes(b"\x89VPLCKP\n")
        self.assertEqual(self.call(*self.make("OUT=out", "clean")).returncode, 0)
        self.assertEqual(list((self.folder / "out").iterdir()), [])


class Files(Programs):
    def test_a_file_where_a_folder_is_needed(self) -> None:
        for out in ("notes", "notes/below"):
            self.refused(
                self.script("generate_ninja.py", self.scene, "--out", out),
                "is no folder, or is below a file",
                "another folder for --out",
            )
            self.refused(
                self.script("record.py", out, "task", "--stage", "place", "--", "true"),
                "is no folder",
            )
        self.refused(
            self.script("slurm/submit.py", self.scene, "--dry-run", "--bin", "notes"),
            "there is no notes/vpl-inspect",
        )

    def test_files_that_cannot_be_read(self) -> None:
        (self.folder / "list.json").write_text("[]")
        for name, part in (
            ("absent.json", "absent.json: No such file"),
            ("notes", "is no cost model"),
            ("list.json", "is no cost model"),
            ("scenes", "scenes: Is a directory"),
        ):
            self.refused(self.farm("--model", name), part)
        for name, part in (
            ("absent.json", "absent.json: No such file"),
            ("notes", "is no job of submit.py"),
            ("list.json", "is no job of submit.py"),
            ("scenes", "scenes: Is a directory"),
        ):
            self.refused(self.script("slurm/task.py", name), part)

    def test_a_folder_that_nobody_can_make(self) -> None:
        self.refused(
            self.script("generate_ninja.py", self.scene, "--out", "/proc/sys/bnvpl"),
            "/proc/sys/bnvpl: ",
        )

    def test_a_reader_that_leaves(self) -> None:
        words = self.farm("--nodes", ",".join(str(n) for n in range(1, 9)))
        result = self.call("bash", "-c", 'exec "$@" 1> >(exec true)', "x", *words)
        self.assertNotIn("Traceback", result.stderr)
        self.assertNotIn("Exception", result.stderr)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        BIN = Path(sys.argv.pop(1)).resolve()
    unittest.main()
