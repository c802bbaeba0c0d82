#!/usr/bin/python3
"""Tests that Blender imports positions, normals and colours from `vpl-inspect export`.

test_blender.py BIN       # folder of the executables; skipped where Blender is missing
"""

import csv
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

ROOT = Path(__file__).resolve().parents[3]
BIN = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin"


Columns = Callable[[str, str], npt.NDArray[Any]]


def run(*command: object) -> str:
    return subprocess.run(
        [str(part) for part in command], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True
    ).stdout


def blender_import(file: Path) -> Any:
    out = run(
        "blender",
        "--background",
        "--factory-startup",
        "--python-exit-code",
        "1",
        "--python",
        Path(__file__).with_name("blender_import.py"),
        "--",
        file,
    )
    line = next(line for line in out.splitlines() if line.startswith("IMPORTED "))
    return json.loads(line[len("IMPORTED ") :])


def encode_srgb(linear: npt.NDArray[Any]) -> npt.NDArray[Any]:
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


@unittest.skipUnless(shutil.which("blender"), "no Blender here")
class Blender(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        scene = "scenes/cornell/scene.toml"
        c, v, lit = (self.folder / name for name in ("c.vpl", "v.vpl", "l.vpl"))
        run(BIN / "vpl-place", scene, "-o", c, "-n", "400", "--quiet")
        run(BIN / "vpl-eliminate", c, "-o", v, "-n", "80", "--quiet")
        run(BIN / "vpl-estimate", scene, v, "-o", lit, "--photons", "20k", "--quiet")

    def columns(self, stage: str) -> Columns:
        for kind in ("ply", "csv"):
            run(
                BIN / "vpl-inspect",
                "export",
                self.folder / f"{stage}.vpl",
                "-o",
                self.folder / f"{stage}.{kind}",
                "--quiet",
            )
        with open(self.folder / f"{stage}.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        return lambda name, parts: np.array(
            [[float(row[f"{name}_{p}"]) for p in parts] for row in rows]
        )

    def check(
        self, stage: str, place: str, normal: str, colour: Callable[[Columns], npt.NDArray[Any]]
    ) -> None:
        columns = self.columns(stage)
        scene = blender_import(self.folder / f"{stage}.ply")
        places = columns(place, "xyz")
        n = len(places)
        self.assertEqual(scene["faces"], n)
        self.assertEqual(len(scene["positions"]), 3 * n)
        np.testing.assert_array_equal(np.float32(scene["positions"][:n]), np.float32(places))
        np.testing.assert_allclose(scene["normals"][:n], columns(normal, "xyz"), atol=2e-3)
        expected = encode_srgb(colour(columns))
        np.testing.assert_allclose(np.array(scene["colours"][:n], float), expected, atol=1.01 / 255)
        self.assertGreater(np.ptp(expected), 0.5)

    def test_lit_rows_shine_with_their_flux(self) -> None:
        def colour(columns: Columns) -> npt.NDArray[Any]:
            flux = columns("flux", "rgb")
            strongest = np.sort(flux.max(axis=1))
            strongest = strongest[strongest > 0]
            result: npt.NDArray[Any] = flux / strongest[round(0.99 * (len(strongest) - 1))]
            return result

        self.check("l", "emit_position_0", "emit_normal_0", colour)

    def test_candidates_show_their_albedo(self) -> None:
        self.check("c", "position", "normal", lambda columns: columns("albedo", "rgb"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
