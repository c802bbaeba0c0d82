#!/usr/bin/python3
"""Tests that the examples work, on the page and in their folder.

test_examples.py BIN       # folder of the executables
"""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import OpenImageIO as oiio

from support import PACKAGE, ROOT, SCENE, TestFiles, TestFolder, main

# isort: split
import bnvpl

README = PACKAGE / "README.md"
EXAMPLES = PACKAGE / "examples"
MAX_LINES_OF_ELIMINATION = 60


def example(name: str, *words: str | Path) -> None:
    subprocess.run([sys.executable, EXAMPLES / name, *words], check=True)


class Page(TestFolder):
    def test_the_code_runs_as_it_stands(self) -> None:
        (self.folder / "scenes").symlink_to(ROOT / "scenes")
        blocks = re.findall(r"```python\n(.*?)```", README.read_text(), re.S)
        self.assertGreaterEqual(len(blocks), 5)
        scope: dict[str, Any] = {"print": lambda *_: None}
        before = Path.cwd()
        os.chdir(self.folder)
        try:
            for block in blocks:
                exec(compile(block, str(README), "exec"), scope)
        finally:
            os.chdir(before)
        # The red wall, at x = 0.55, lights the others and not itself.
        red = bnvpl.read_vpl(self.folder / "red.vpl")
        self.assertGreater(len(red), 50)
        self.assertGreater(red.position[:, 0].min(), 0.5)
        image = bnvpl.read_exr(self.folder / "red.exr")["RGB"]
        self.assertGreater(image[:, 80:, 0].mean(), 5 * image[:, 80:, 1].mean())
        self.assertLess(image[40:80, 7].max(), 1e-3 * image.mean())
        self.assertTrue((self.folder / "red.png").exists())
        # The light from elsewhere has no effect above itself.
        mine = bnvpl.read_exr(self.folder / "mine.exr")["RGB"]
        self.assertGreater(mine[50:].mean(), 0)
        self.assertFalse((self.folder / "x.vpl").exists())


class Examples(TestFiles):
    def spacing(self, file: Path) -> Any:
        return bnvpl.run("vpl-inspect", "info", file)["info"]["spacing"]

    def test_elimination_stands_in_for_the_tool(self) -> None:
        lines = len((EXAMPLES / "eliminate.py").read_text().splitlines())
        self.assertLessEqual(lines, MAX_LINES_OF_ELIMINATION)
        mine, tools = self.folder / "mine.vpl", self.folder / "tools.vpl"
        example("eliminate.py", self.candidates, mine, "300")
        bnvpl.run("vpl-eliminate", self.candidates, output=tools, n=300, density="uniform")
        bnvpl.run("vpl-inspect", "check", self.candidates, mine, scene=SCENE)
        a, b = bnvpl.read_vpl(mine), bnvpl.read_vpl(tools)
        self.assertEqual(len(set(a.id.tolist())), 300)
        self.assertAlmostEqual(a.r_max / b.r_max, 1, delta=0.05)
        spread = [self.spacing(file)["distance"]["mean"] for file in (mine, tools)]
        self.assertAlmostEqual(spread[0] / spread[1], 1, delta=0.03)
        # The later stages go on from it and find the same light.
        means = []
        for vpls in (mine, tools):
            lit, image = self.folder / "l.vpl", self.folder / "i.exr"
            bnvpl.run("vpl-estimate", SCENE, vpls, output=lit, photons="40k")
            stats = bnvpl.run("vpl-render", SCENE, lit, output=image, size=(24, 24), spp=8)
            means.append(stats["mean_indirect"])
        self.assertAlmostEqual(means[0] / means[1], 1, delta=0.03)
        tools_of = [record["tool"] for record in bnvpl.read_exr(image).provenance]
        self.assertEqual(len(tools_of), 4)

    def test_the_plot_of_flux(self) -> None:
        picture = self.folder / "flux.png"
        example("plot_flux.py", self.lit, picture)
        self.expect_same_kind(picture, EXAMPLES / "flux.png")

    def test_the_spectra(self) -> None:
        chosen = self.folder / "random.vpl"
        bnvpl.run("vpl-eliminate", self.candidates, output=chosen, n=300, method="random")
        picture = self.folder / "spectrum.png"
        words = ["spectrum.py", str(self.vpls), str(chosen), str(picture)]
        with mock.patch.object(sys, "argv", words):
            script = runpy.run_path(str(EXAMPLES / "spectrum.py"))
        self.expect_same_kind(picture, EXAMPLES / "spectrum.png", colour=0.003)
        low = []
        for file in (self.vpls, chosen):
            frequency, power = script["radial_spectrum"](*script["points_on_wall"](file), bins=12)
            low.append(np.mean([p for f, p in zip(frequency, power, strict=True) if f < 0.5]))
        self.assertLess(low[0], 0.5)
        self.assertGreater(low[1], 0.8)

    def expect_same_kind(self, picture: Path, shown: Path, colour: float = 0.01) -> None:
        """Both are of the same size, and have colours besides those of axes and texts."""
        shapes = []
        for file in (picture, shown):
            pixels = np.asarray(oiio.ImageBuf(str(file)).get_pixels(oiio.UINT8))[:, :, :3]
            shapes.append(pixels.shape)
            self.assertGreater((np.ptp(pixels.astype(int), axis=2) > 60).mean(), colour)
        self.assertEqual(*shapes)


if __name__ == "__main__":
    main()
