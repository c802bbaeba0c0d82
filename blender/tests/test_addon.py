# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the add-on's parts that need no Blender: test_addon.py BIN."""

from __future__ import annotations

import math
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path += [str(ROOT / "blender"), str(ROOT / "python")]
import bnvpl  # noqa: E402
from bnvpl_blender import bl_info, exr_file, lamps, toml_text, tools  # noqa: E402

BIN = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else ROOT / "build/release/bin"
PLACED = [[1.0, 0.0, 0.0, 2.0], [0.0, 1.0, 0.0, 3.0], [0.0, 0.0, 1.0, 4.0]]


class SectionsTest(unittest.TestCase):
    def test_text_is_toml(self) -> None:
        section: toml_text.Section = {"name": 'a "b"\n\\ß\x7f', "sides": 2, "thin": True}
        text = toml_text.scene_text([("[[light]]", section | {"power": [0.1, 1e-9, 3]})])
        told = tomllib.loads(text)["light"][0]
        self.assertEqual(told, section | {"power": [0.1, 1e-9, 3]})

    def lamp(self, kind: str, **keys: object) -> toml_text.Section:
        lamp = lamps.Lamp("L", kind, PLACED, (8.0, 4.0, 2.0), **keys)  # type: ignore[arg-type]
        return lamps.light_section(lamp)

    def test_axes(self) -> None:
        told = self.lamp("POINT")
        self.assertEqual(told["position"], [2, 4, -3])
        self.assertEqual(self.lamp("SUN")["direction"], [0, -1, 0])

    def test_units(self) -> None:
        self.assertEqual(self.lamp("POINT")["power"], (8.0, 4.0, 2.0))
        self.assertEqual(self.lamp("POINT", radius=0.1)["type"], "sphere")
        area = self.lamp("AREA", shape="RECTANGLE", size=2.0, size_y=0.5)
        self.assertEqual((area["width"], area["height"]), (2.0, 0.5))
        self.assertEqual(area["power"], (8.0, 4.0, 2.0))
        self.assertEqual(lamps.area_share((3, 6, 5)), math.pi / 4)
        self.assertEqual(lamps.area_share((4, 0, 0)), 1.0)
        self.assertEqual(self.lamp("AREA", shape="DISK", size=2.0)["radius"], 1.0)
        oval = self.lamp("AREA", shape="ELLIPSE", size=2.0, size_y=0.5)
        width, height = oval["width"], oval["height"]
        assert isinstance(width, float) and isinstance(height, float)
        self.assertAlmostEqual(width * height, math.pi * 0.25)

    def test_a_share_of_the_film_is_cut_as_in_whole_numbers(self) -> None:
        self.assertEqual(lamps.pixels_of(1600, 29), 464)
        self.assertEqual(lamps.pixels_of(101, 50), 50)
        self.assertEqual(lamps.pixels_of(3, 10), 1)

    def test_a_region_is_cut_as_in_single_precision(self) -> None:
        self.assertEqual(lamps.pixel_at(0.55, 48), 26)
        self.assertEqual(lamps.pixel_at(0.58, 100), 58)  # 57.99999999999999 in double precision
        self.assertEqual(lamps.pixel_at(1.0, 1920), 1920)

    def test_camera(self) -> None:
        projection = [[1.0, 0.0, 0.2], [0.0, 2.0, -0.1]]
        told = lamps.camera_section(PLACED, projection, 2.0, lamps.Lens())
        self.assertEqual(told["shift"], [0.2, -0.05])
        fov = told["vertical_fov_deg"]
        assert isinstance(fov, float)
        self.assertAlmostEqual(math.tan(math.radians(fov / 2)), 0.5)
        self.assertNotIn("lens_radius", told)

    def test_tools_read_all_sections(self) -> None:
        kinds = (
            self.lamp("POINT"),
            self.lamp("POINT", radius=0.1),
            self.lamp("SPOT", spot_size=0.8, spot_blend=0.15),
            self.lamp("SUN", angle=0.01),
            self.lamp("AREA", size=1.0),
            self.lamp("AREA", shape="DISK", size=1.0),
        )
        lens = lamps.Lens(0.01, 3.0)
        projection = lamps.viewport_projection(50, 64, 48)
        sections: list[tuple[str, toml_text.Section]] = [
            ("[film]", {"width": 64, "height": 48}),
            ("[camera]", lamps.camera_section(PLACED, projection, 4 / 3, lens)),
            ("[[mesh]]", {"file": str(ROOT / "scenes/gltf-room/room.glb")}),
            *(("[[light]]", kind) for kind in kinds),
        ]
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "scene.toml"
            scene.write_text(toml_text.scene_text(sections))
            command = [str(BIN / "vpl-inspect"), "scene", str(scene)]
            told = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        self.assertEqual(told.count("light 'L'"), 3, told)


class ToolsTest(unittest.TestCase):
    def test_presets_are_those_of_the_pipelines(self) -> None:
        text = (ROOT / "pipelines/quality.mk").read_text()
        found = dict(re.findall(r"^(\w+\.\w+) *:= *(.*)$", text, re.MULTILINE))

        def number(name: str) -> int:
            count = found[name]
            return int(count.removesuffix("k")) * (1000 if count.endswith("k") else 1)

        for key, preset in tools.PRESETS.items():
            quality = key.lower()
            self.assertEqual(preset.candidates, found[f"CANDIDATES.{quality}"])
            self.assertEqual(preset.photons, found[f"PHOTONS.{quality}"])
            self.assertEqual(preset.vpls, number(f"VPLS.{quality}"))
            self.assertEqual(preset.samples, number(f"SPP.{quality}"))
            self.assertEqual(" ".join(preset.estimate), found[f"ESTIMATE.{quality}"])
            self.assertEqual(" ".join(preset.render), found[f"RENDER.{quality}"])

    def test_version(self) -> None:
        self.assertEqual("{}.{}.{}".format(*bl_info["version"]), bnvpl.__version__)
        manifest = tomllib.loads((ROOT / "blender/bnvpl_blender/blender_manifest.toml").read_text())
        self.assertEqual(manifest["version"], bnvpl.__version__)

    def test_run(self) -> None:
        """Progress comes, errors are the tool's own, and a stopped tool ends."""
        request = tools.Request(preset="DRAFT", vpls=20, samples=1, layers=("A",), transparent=True)
        seen: list[tools.Progress] = []
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            cornell = f'[[mesh]]\nfile = "{ROOT}/scenes/cornell/scene.toml"\n'
            (folder / "scene.toml").write_text(cornell + "[film]\nwidth = 17\nheight = 9\n")
            for command in tools.commands(request):
                tools.run_tool(command, folder, str(BIN), seen.append, lambda: False)
            self.assertEqual({p.tool for p in seen}, set(tools.TOOLS))
            tools.run_tool(
                tools.path_command(request), folder, str(BIN), seen.append, lambda: False
            )
            self.check_image(folder / "image.exr")
            (folder / "lit.vpl").unlink()
            command = tools.commands(request)[-1]
            with self.assertRaisesRegex(tools.ToolError, "vpl-render: .*lit.vpl"):
                tools.run_tool(command, folder, str(BIN), seen.append, lambda: False)
            endless = [*tools.path_command(request), "--spp", "1M"]
            with self.assertRaises(tools.Cancelled):
                tools.run_tool(endless, folder, str(BIN), seen.append, lambda: True)

    def test_paths_keep_every_other_option(self) -> None:
        request = tools.Request(preset="DRAFT", threads=2, samples=4, seed=2, layers=("A",))
        words = " ".join(tools.path_command(request))
        self.assertEqual(
            words,
            "vpl-render scene.toml -o image.exr --spp 4 --integrator path --seed 2 --threads 2 "
            "--layers A",
        )

    def test_files_of_others_stay(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "new"
            for text in (tools.MARK + "\n", "[film]\n"):
                tools.make_folder(folder, private=True)
                self.assertEqual(folder.stat().st_mode & 0o777, 0o700)
                (folder / "scene.toml").write_text(text)
                (folder / "scene.glb").write_text("")
                (folder / "render.sh").write_text(tools.script([["true"]], ""))
            with self.assertRaisesRegex(FileExistsError, "scene.toml is not of this add-on"):
                tools.make_folder(folder, private=False)
            (folder / "scene.toml").unlink()
            with self.assertRaisesRegex(FileExistsError, "scene.glb is not of this add-on"):
                tools.make_folder(folder, private=False)
            link = Path(name) / "link"
            link.symlink_to(folder)
            with self.assertRaises(PermissionError):
                tools.make_folder(link, private=True)

    def check_image(self, path: Path) -> None:
        """Our reader and OpenImageIO read the same."""
        ours, reference = exr_file.read_exr(path), bnvpl.read_exr(path)
        np.testing.assert_array_equal(exr_file.layer(ours, "", "RGB"), reference["RGB"])
        np.testing.assert_array_equal(exr_file.layer(ours, "A", "A")[..., 0], reference["A"])

    def test_the_script_finds_the_tools_of_the_preferences(self) -> None:
        with tempfile.TemporaryDirectory(prefix="bnvpl's tools ") as name:
            tool, script = Path(name) / "vpl-place", Path(name) / "render.sh"
            tool.write_text("#!/bin/sh\necho found\n")
            script.write_text(tools.script([["vpl-place"]], name))
            for file in (tool, script):
                file.chmod(0o755)
            done = subprocess.run([script], text=True, capture_output=True)
            self.assertEqual((done.stdout, done.stderr), ("found\n", ""))

    def test_missing_tool(self) -> None:
        with self.assertRaisesRegex(tools.ToolError, "preferences"):
            tools.find_tool("vpl-place", "/nowhere")


class ExrTest(unittest.TestCase):
    def test_half_and_ids(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "image.exr"
            scene = ROOT / "scenes/cornell/scene.toml"
            command = [str(BIN / "vpl-render"), str(scene), "-o", str(path)]
            options = "--integrator path --spp 1 --size 33x20 --pixels half --layers objectid,N"
            subprocess.run([*command, *options.split()], check=True, capture_output=True)
            ours, reference = exr_file.read_exr(path), bnvpl.read_exr(path)
            for name, components in (("N", "XYZ"), ("", "RGB"), ("objectid", "")):
                values = exr_file.layer(ours, name, components) if components else ours[name]
                np.testing.assert_array_equal(values, reference[name or "RGB"])

    def test_other_files_are_refused(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "image.exr"
            path.write_bytes(b"no image")
            with self.assertRaises(exr_file.ExrError):
                exr_file.read_exr(path)
        for name in ("tiled.exr", "b44a.exr", "dwaa.exr"):
            with self.assertRaises(exr_file.ExrError):
                exr_file.read_exr(ROOT / "fuzz/corpus/exr" / name)


if __name__ == "__main__":
    unittest.main()
