#!/usr/bin/python3
"""Tests that formats/README.md shows .vpl files as the tools write them.

    test_readme.py BIN              # folder of the executables
    test_readme.py BIN --write      # renews the record and the table of inputs in the README

Hashes and versions differ between builds and are not compared.
"""

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "formats/README.md"
BIN = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin"
SCENE = "scenes/cornell/scene.toml"


def run(tool: str, *arguments: object) -> str:
    done = subprocess.run(
        [str(BIN / tool), *map(str, arguments), "--quiet"],
        cwd=ROOT,
        check=True,
        stdout=subprocess.PIPE,
        text=True,
    )
    return done.stdout


def history(file: Path) -> Any:
    return json.loads(run("vpl-inspect", "info", file, "--json"))["provenance"]


def make(folder: Path) -> tuple[Path, Path, Path]:
    c, v, lit, image = (folder / name for name in ("c.vpl", "v.vpl", "l.vpl", "i.exr"))
    run("vpl-place", SCENE, "-o", c, "-n", "300")
    run("vpl-eliminate", c, "-o", v, "-n", "50")
    run("vpl-estimate", SCENE, v, "-o", lit, "--photons", "5k")
    run("vpl-render", SCENE, lit, "-o", image, "--spp", "1", "--size", "16x12")
    return c, lit, image


def record_block(record: dict[str, Any]) -> str:
    """The record as JSON, with a line for each key."""
    lines = ",\n  ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in record.items())
    return "```json\n[{" + lines + "}]\n```\n"


def inputs_block(records: list[dict[str, Any]]) -> str:
    lines = "".join(
        "| `{}` | {} |\n".format(r["tool"], ", ".join(f"`{name}`" for name in r["inputs"]))
        for r in records
    )
    return "| Tool | Inputs |\n|---|---|\n" + lines


def masked(text: str) -> str:
    text = re.sub(r'"[0-9a-f]{16}"', '"HASH"', text)
    return re.sub(r'"(version|commit|build|source)": "[^"]*"', r'"\1": "TEXT"', text)


class Readme(unittest.TestCase):
    folder: tempfile.TemporaryDirectory[str]
    candidates: Path
    lit: Path
    image: Path
    text: str

    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.candidates, cls.lit, cls.image = make(Path(cls.folder.name))
        cls.text = README.read_text()

    def test_the_record(self) -> None:
        shown = masked(self.text)
        self.assertIn(masked(record_block(history(self.candidates)[0])), shown)

    def test_the_inputs(self) -> None:
        self.assertIn("\n\n" + inputs_block(history(self.image)) + "\n", self.text)

    def test_the_manual_page_has_the_same_offsets(self) -> None:
        page = (ROOT / "install/man/vpl.5.in").read_text()
        shown = re.findall(r"^(\d+)\t([^\t]+)\t", page, re.M)
        told = re.findall(r"^\| (\d+) \| ([^|]+) \|", self.text, re.M)
        self.assertGreater(len(told), 18)
        self.assertEqual(shown, told)

    def columns(self, file: Path) -> Any:
        code = re.findall(r"```python\n(.*?)```", self.text, re.DOTALL)[0]
        self.assertIn('"lit.vpl"', code)
        scope: dict[str, Any] = {}
        exec(code.replace("lit.vpl", str(file)), scope)
        return scope["vpl"]

    def test_the_numpy_example(self) -> None:
        vpl = self.columns(self.lit)
        info = json.loads(run("vpl-inspect", "info", self.lit, "--json"))
        self.assertEqual(vpl["position"].shape, (50, 3))
        energy = info["energy_W"]
        np.testing.assert_allclose(
            vpl["flux"].sum(axis=0, dtype=float), [energy[c] for c in "RGB"], rtol=1e-12
        )

    def test_the_numpy_example_reads_columns_of_methods(self) -> None:
        vpl = self.columns(ROOT / "tests/formats/golden/methods.vpl")
        self.assertEqual(
            vpl["rich.lobes"].tolist(), [[0, 0.25, 0.5, 0.75], [-1, -0.75, -0.5, -0.25]]
        )
        self.assertEqual(vpl["light-slice.cluster"].dtype, "<u4")
        self.assertEqual(vpl["rich.seeds"].tolist(), [[0, 1], [1 << 33, (1 << 33) + 1]])


def write() -> None:
    with tempfile.TemporaryDirectory() as folder:
        candidates, _, image = make(Path(folder))
        text = README.read_text()
        record, inputs = record_block(history(candidates)[0]), inputs_block(history(image))
        text = re.sub(
            r"```json\n.*?```\n|@RECORD@\n", lambda _: record, text, count=1, flags=re.DOTALL
        )
        text = re.sub(
            r"(\| Tool \| Inputs \|\n(\|.*\n)*)|@INPUTS@\n", lambda _: inputs, text, count=1
        )
        README.write_text(text)


if __name__ == "__main__":
    if "--write" in sys.argv:
        write()
    else:
        unittest.main(argv=sys.argv[:1])
