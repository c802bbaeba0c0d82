#!/usr/bin/python3
"""Tests that VPLs from elsewhere render with the right energy.

test_foreign.py BIN       # folder of the executables
"""

from __future__ import annotations

from typing import Any

import numpy as np

from support import GOLDEN, ROOT, SCENE, TestFolder, main

# isort: split
import bnvpl

FURNACE = ROOT / "scenes/furnace/scene.toml"
SIDE = 10  # VPLs along an edge of the furnace


class Foreign(TestFolder):
    def test_a_furnace_of_positions_normals_and_flux(self) -> None:
        # A closed unit cube, whose walls shine with radiance 1 and reflect half of what they
        # receive. They reflect the radiance 1 in all, of which they receive pi per unit of area.
        # Half of this is reflected to the camera: the indirect light is 0.5.
        rng = np.random.default_rng(1)
        cells = np.stack(np.meshgrid(np.arange(SIDE), np.arange(SIDE)), axis=2).reshape(-1, 2)
        position, normal = [], []
        for axis in range(3):
            for end in (0, 1):
                face = (cells + rng.random(cells.shape)) / SIDE
                position.append(np.insert(face, axis, end, axis=1))
                normal.append(np.tile(np.eye(3)[axis] * (1 - 2 * end), (len(cells), 1)))
        flux = np.full((6 * SIDE * SIDE, 3), 6 * np.pi / (6 * SIDE * SIDE))
        columns = {"position": np.concatenate(position), "normal": np.concatenate(normal)}
        bnvpl.write_vpl(self.folder / "f.vpl", {**columns, "flux": flux}, FURNACE)
        bnvpl.run("vpl-inspect", "check", self.folder / "f.vpl", scene=FURNACE)
        stats = bnvpl.run(
            "vpl-render", FURNACE, self.folder / "f.vpl", output=self.folder / "f.exr",
            size=(24, 24), spp=16, layers=["indirect"],
        )  # fmt: skip
        self.assertAlmostEqual(stats["mean_indirect"], 0.5, delta=0.01)
        self.assertAlmostEqual(stats["mean_direct"], 1.5, delta=0.01)
        image = bnvpl.read_exr(self.folder / "f.exr")
        self.assertAlmostEqual(image["indirect"].mean(), 0.5, delta=0.01)
        self.assertLess(image["indirect"].std(), 0.1)

    def test_what_vpl_place_lights_looks_the_same_from_three_columns(self) -> None:
        placed, again = self.folder / "placed.vpl", self.folder / "again.vpl"
        bnvpl.run("vpl-place", SCENE, output=placed, method="light", count=500)
        lit = bnvpl.read_vpl(placed)
        three = {name: lit[name] for name in ("position", "normal", "flux")}
        bnvpl.write_vpl(again, three, SCENE)
        means = []
        for file in (placed, again):
            bnvpl.run(
                "vpl-render", SCENE, file, output=self.folder / "x.exr",
                size=(24, 24), spp=16, layers=["indirect"], control="none",
            )  # fmt: skip
            means.append(bnvpl.read_exr(self.folder / "x.exr")["indirect"].mean())
        self.assertAlmostEqual(means[1] / means[0], 1, delta=0.003)
        # The radii are those of the tool.
        completed = bnvpl.read_vpl(again)
        np.testing.assert_allclose(completed.radius, lit.radius, rtol=1e-6)
        self.assertAlmostEqual(completed.r_max, lit.r_max, delta=1e-6 * lit.r_max)
        self.assertAlmostEqual(completed.area, lit.area, delta=1e-6 * lit.area)

    def test_emission_points_take_the_normals_of_their_vpls(self) -> None:
        lit = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        columns = {name: lit[name] for name in ("position", "normal", "radius", "flux")}
        columns["emit_position"] = np.repeat(lit.position[:, None], 3, axis=1)
        bnvpl.write_vpl(self.folder / "x.vpl", columns)
        back = bnvpl.read_vpl(self.folder / "x.vpl")
        self.assertEqual(back.emit_normal.tolist(), np.repeat(lit.normal[:, None], 3, 1).tolist())

    def test_candidates_for_the_other_stages(self) -> None:
        placed, mine = self.folder / "placed.vpl", self.folder / "mine.vpl"
        bnvpl.run("vpl-place", SCENE, output=placed, count=500)
        candidates = bnvpl.read_vpl(placed)
        two = {name: candidates[name] for name in ("position", "normal")}
        bnvpl.write_vpl(mine, two, SCENE)
        self.assertEqual(bnvpl.read_vpl(mine).stage, "candidates")
        bnvpl.run("vpl-eliminate", mine, output=self.folder / "v.vpl", n=50)
        vpls, lit = self.folder / "v.vpl", self.folder / "l.vpl"
        stats = bnvpl.run("vpl-estimate", SCENE, vpls, output=lit, photons="5k")
        self.assertEqual(stats["non_finite_samples"], 0)

    def test_vpls_of_another_scene_are_refused(self) -> None:
        lit = bnvpl.read_vpl(GOLDEN / "lit.vpl")
        bnvpl.write_vpl(self.folder / "x.vpl", lit)
        with self.assertRaisesRegex(bnvpl.ToolError, "0123456789abcdef"):
            bnvpl.run("vpl-render", SCENE, self.folder / "x.vpl", output=self.folder / "x.exr")
        bnvpl.write_vpl(self.folder / "x.vpl", lit, FURNACE)
        self.assertEqual(
            bnvpl.read_vpl(self.folder / "x.vpl").scene_hash, bnvpl.scene_hash(FURNACE)
        )
        self.assertEqual(lit.scene_hash, "0123456789abcdef")

    def test_columns_that_are_needed(self) -> None:
        one = np.zeros((1, 3))
        with self.assertRaisesRegex(ValueError, "VPLs of stage lit need the column normal"):
            bnvpl.make_vpls({"position": one, "flux": one})
        with self.assertRaisesRegex(ValueError, "column flux has the shape"):
            columns = {"position": one, "normal": one + [0, 0, 1], "radius": one[0, :1] + 1}
            bnvpl.write_vpl(self.folder / "x.vpl", columns | {"flux": one[0, :1]})

    def test_messages_name_the_file_and_the_column(self) -> None:
        """Files within the package are nobody's business."""
        file, one, down = self.folder / "x.vpl", [[0.3, 0.5, 0.3]], [[0, -1, 0]]
        cases: list[tuple[Any, Any, str]] = [
            (one, [[0, -2, 0]], "column normal, row 0: not of unit length"),
            ([], [], r"column position has the shape \(0,\), expected \(0, 3\)"),
            ("abc", down, "column position has values that are no real numbers"),
            (1, down, "column position is one value, not a row for each VPL"),
            ([[1, 2], [3]], down, "column position has rows of different lengths"),
            (one * 2, down, r"column normal has the shape \(1, 3\), expected \(2, 3\)"),
        ]
        for position, normal, problem in cases:
            columns: dict[str, Any] = {"position": position, "normal": normal, "flux": one}
            with self.assertRaisesRegex(ValueError, rf"\A{file}: not written: {problem}\Z"):
                bnvpl.write_vpl(file, columns)
            with self.assertRaisesRegex(ValueError, rf"\A{problem}\Z"):
                bnvpl.share_radii(position, normal)
            self.assertFalse(file.exists())

    def test_no_vpls_at_all(self) -> None:
        none = np.zeros((0, 3))
        columns = {"position": none, "normal": none, "flux": none}
        bnvpl.write_vpl(self.folder / "x.vpl", columns, SCENE)
        bnvpl.run("vpl-inspect", "check", self.folder / "x.vpl")
        self.assertEqual(bnvpl.read_vpl(self.folder / "x.vpl").flux.shape, (0, 3))


if __name__ == "__main__":
    main()
