#!/usr/bin/python3
"""Tests the cross-check. Tests that need Blender are skipped where it is missing.

python3 eval/cycles/test_cross_check.py
"""

from __future__ import annotations

import json
import os
import shutil
import stat
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import cases  # noqa: E402
import compare  # noqa: E402
import cross_check  # noqa: E402
import gltf_file  # noqa: E402
import model_cases  # noqa: E402
import model_scenes  # noqa: E402
import scene_source as source  # noqa: E402
import walk  # noqa: E402

ROOT = HERE.parent.parent
VPL_RENDER = os.environ.get("VPL_RENDER", str(ROOT / "build/release/bin/vpl-render"))
OBJ = """mtllib m.mtl
v 0 0 0
v 2 0 0
v 2 3 0
v 0 3 0
vn 0 0 1
vt 0 0
vt 1 0
usemtl A
f 1/1/1 2/2/1 3/2/1 -1/1/1
usemtl B
f 1 2 2
f 1 2 4
"""
MTL = "newmtl A\nKd 0.1 0.2 0.3\nnewmtl B\nKd 0.5 0.5 0.5\nKe 1 2 3\nemission_sides 2\n"


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(HERE / "cross_check.py"), *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


class InFolder(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.write_text(text)
        return path


class Reader(InFolder):
    def mesh(self, matrix: npt.NDArray[Any], mtl: str = MTL) -> source.Mesh:
        self.write("m.mtl", mtl)
        return source.read_mesh(self.write("m.obj", OBJ), None, matrix)

    def test_quads_negative_indices_and_triangles_without_area(self) -> None:
        mesh = self.mesh(np.eye(4))
        self.assertEqual(
            mesh.position.tolist(),
            [
                [[0, 0, 0], [2, 0, 0], [2, 3, 0]],
                [[0, 0, 0], [2, 3, 0], [0, 3, 0]],
                [[0, 0, 0], [2, 0, 0], [0, 3, 0]],
            ],
        )
        self.assertEqual([mesh.materials[m].name for m in mesh.material], ["A", "A", "B"])
        self.assertEqual(mesh.uv[0].tolist(), [[0, 0], [1, 0], [1, 0]])
        self.assertTrue(np.isnan(mesh.normal[2]).all() and np.isnan(mesh.uv[2]).all())

    def test_material_fields(self) -> None:
        a, b = self.mesh(np.eye(4)).materials
        self.assertEqual((a.kd, a.ke, a.two_sided), ((0.1, 0.2, 0.3), (0, 0, 0), False))
        self.assertEqual((b.ke, b.two_sided), ((1, 2, 3), True))

    def test_scale_then_turns_then_shift(self) -> None:
        matrix = source.read_transform(
            {"scale": [2, 1, 1], "rotate_deg": [90, 0, 90], "translate": [0, 0, 5]}
        )
        # (1, 1, 0) is scaled to (2, 1, 0), rotated about x to (2, 0, 1) and about z to (0, 2, 1).
        np.testing.assert_allclose(matrix @ [1, 1, 0, 1], [0, 2, 6, 1], atol=1e-12)

    def test_a_reflection_keeps_the_lit_side(self) -> None:
        flip = np.diag([-1.0, 1.0, 1.0, 1.0])
        mesh = self.mesh(flip)
        p = mesh.position[0]
        self.assertGreater(np.cross(p[1] - p[0], p[2] - p[0])[2], 0)
        np.testing.assert_allclose(mesh.normal[0], [[0, 0, 1]] * 3)

    def test_normals_stay_upright_under_uneven_scale(self) -> None:
        slanted = OBJ.replace("vn 0 0 1", "vn 1 0 1")
        self.write("m.mtl", MTL)
        mesh = source.read_mesh(self.write("m.obj", slanted), None, np.diag([2.0, 1, 1, 1]))
        np.testing.assert_allclose(mesh.normal[0, 0], np.array([1, 0, 2]) / np.sqrt(5))

    def test_split_emitters_keep_area_side_and_the_rest(self) -> None:
        mesh = self.mesh(np.eye(4))
        fine = source.split_emitters(mesh, 1.0)
        lamp = fine.position[fine.material == 1]
        twice = np.cross(lamp[:, 1] - lamp[:, 0], lamp[:, 2] - lamp[:, 0])
        self.assertEqual(len(lamp), 16)  # edges 2, 3, 3.6 become 0.5, 0.75, 0.9
        np.testing.assert_allclose(twice, np.tile([0, 0, 6 / 16], (16, 1)))
        np.testing.assert_array_equal(fine.position[fine.material == 0], mesh.position[:2])

    def test_what_has_no_counterpart_is_refused_by_name(self) -> None:
        for line, said in (
            ("Ks 0.1 0.1 0.1", "Phong"),
            ("map_d a.png", "mask"),
            ("illum 7\nTf 0.5 1 1", "coloured glass"),
            ("illum 7\nNi 0.6", "below 1"),
            ("Ks 0.9 0.9 0.9\nillum 3", "more than it receives"),
        ):
            with self.assertRaisesRegex(source.SceneError, f"material 'B'.*{said}"):
                self.mesh(np.eye(4), MTL + line + "\n")


class Preparation(InFolder):
    def test_edited_library_keeps_mirrors(self) -> None:
        text = "# c\nnewmtl A\nKs 1 1 1\nKd 1 0 0\nnewmtl M\nKs 0.9 0.9 0.9\nillum 3\n"
        self.assertEqual(
            cases.edit_mtl(text, ("Ks",)),
            "# c\nnewmtl A\nKd 1 0 0\nnewmtl M\nKs 0.9 0.9 0.9\nillum 3\n",
        )

    def test_every_own_case_is_read(self) -> None:
        for case in cases.CASES:
            if case.scene.startswith("veach-ajar") or case.scene.endswith((".pbrt", ".glb")):
                continue  # downloads, and files that scene_source.py cannot read
            scene = source.read_scene(cases.prepare(case, ROOT / "scenes", self.folder / case.name))
            self.assertEqual((scene.width, scene.height), case.size)
            lit = any(any(m.ke) for mesh in scene.meshes for m in mesh.materials)
            self.assertEqual(lit, not case.lights, case.name)
            self.assertEqual(scene.lights, list(case.lights))


def volume(position: npt.NDArray[Any]) -> float:
    """Volume enclosed by triangles that run anti-clockwise seen from outside."""
    a, b, c = position[:, 0], position[:, 1], position[:, 2]
    return float((a * np.cross(b, c)).sum() / 6)


class ModelScenes(InFolder):
    def test_the_sphere_is_closed_and_its_outside_is_out(self) -> None:
        position, normal = model_scenes.sphere((1.0, 2.0, 3.0), 0.5)
        self.assertAlmostEqual(volume(position), np.pi / 6, delta=2e-3)
        np.testing.assert_allclose(position, np.add((1.0, 2.0, 3.0), normal / 2))

    def test_the_box_is_closed_and_faces_in(self) -> None:
        walls = [p for p in model_scenes.box_parts() if p.material != "lamp"]
        self.assertAlmostEqual(volume(np.concatenate([p.position for p in walls])), -8.0)
        lamp = model_scenes.box_parts()[-1].position
        twice = np.cross(lamp[:, 1] - lamp[:, 0], lamp[:, 2] - lamp[:, 0])
        np.testing.assert_allclose(twice.sum(axis=0) / 2, [0, -1, 0], atol=1e-12)

    def test_windows_are_holes(self) -> None:
        area = 0.0
        for part in model_scenes.room_with_windows().parts:
            p = part.position
            area += np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2
        self.assertAlmostEqual(area, 24 - 0.3 * 0.6 - 0.6 * 0.9 - 0.6 * 0.6)

    def test_a_glb_holds_what_it_says(self) -> None:
        for name in ("gltf-instances", "gltf-normal-map"):
            path = self.folder / f"{name}.glb"
            model_cases.write(name, path)
            data = path.read_bytes()
            self.assertEqual(struct.unpack("<4sII", data[:12]), (b"glTF", 2, len(data)))
            (size,) = struct.unpack("<I", data[12:16])
            scene, binary = json.loads(data[20 : 20 + size]), data[28 + size :]
            self.assertIn(len(binary) - scene["buffers"][0]["byteLength"], range(4))  # padding
            for accessor in scene["accessors"]:
                view = scene["bufferViews"][accessor["bufferView"]]
                width = int(accessor["type"][3])
                self.assertEqual(view["byteLength"], accessor["count"] * width * 4)
                self.assertLessEqual(view["byteOffset"] + view["byteLength"], len(binary))
            self.assertEqual(len(scene["nodes"]), 32 if name == "gltf-instances" else 8)

    def test_a_png_has_its_size_and_the_right_sums(self) -> None:
        image = oiio_size(self.folder / "a.png", gltf_file.png(np.zeros((3, 5, 3))))
        self.assertEqual(image, (5, 3))

    def test_every_model_case_has_both_files(self) -> None:
        for case in cases.CASES:
            if case.scene.endswith((".pbrt", ".glb")):
                path = cases.prepare(case, ROOT / "scenes", self.folder / case.name)
                self.assertGreater(path.stat().st_size, 1000)
                self.assertEqual(path.stem, case.name)


def oiio_size(path: Path, data: bytes) -> tuple[int, int]:
    path.write_bytes(data)
    spec = oiio.ImageBuf(str(path)).spec()
    return spec.width, spec.height


class Walks(unittest.TestCase):
    def both(
        self, scatter: walk.Scatter, cosine: float = 0.6, inside: bool = False
    ) -> npt.NDArray[Any]:
        """Scattered share of the light by our model and by that of Cycles, over all channels."""
        u = np.random.default_rng(3).random((1 << 15, 4))
        wo = np.tile([np.sqrt(1 - cosine**2), 0.0, cosine], (len(u), 1))
        result: npt.NDArray[Any] = scatter(wo, np.full(len(u), inside), u)[1].mean(axis=(0, 2))
        return result

    def test_smooth_facets_lose_nothing_and_are_the_same(self) -> None:
        for scatter in (walk.conductor(1e-3), walk.dielectric(1e-3, 1.5)):
            np.testing.assert_allclose(self.both(scatter), [1.0, 1.0], atol=1e-3)

    def test_rough_metal_loses_what_the_theory_page_says(self) -> None:
        for alpha, lost in (
            (0.2, 0.05),
            (0.5, 0.31),
            (1.0, 0.67),
        ):  # values of ggx/theory.md at 27 degrees
            ours, cycles = self.both(walk.conductor(alpha), np.cos(np.radians(27)))
            self.assertAlmostEqual(1 - ours, lost, delta=0.02)
            self.assertLess(cycles, ours)

    def test_a_white_base_below_our_coat_returns_all(self) -> None:
        self.assertAlmostEqual(self.both(walk.coated(0.3, 1.5, (1, 1, 1)))[0], 1.0, delta=0.015)

    def test_gltf_never_returns_more_than_arrives(self) -> None:
        for cosine in (0.05, 0.3, 1.0):
            scatter = walk.metallic_roughness((1, 1, 1), 0.0, 0.4)
            self.assertLess(self.both(scatter, cosine)[0], 1.01)

    def test_a_flat_map_changes_nothing(self) -> None:
        random = np.random.default_rng(2)
        n = np.tile([0.0, 0.0, 1.0], (50, 1))
        wo, wi = (walk.cosine_direction(random.random((50, 2))) for _ in range(2))
        for bend in (walk.our_bend, walk.cycles_bend):
            np.testing.assert_allclose(bend(n, wo, n), n, atol=1e-9)
        np.testing.assert_allclose(walk.softened(n, wi, n), 1.0)

    def test_bent_normals_mirror_the_viewer_above_the_surface(self) -> None:
        random = np.random.default_rng(4)
        n = np.tile([0.0, 0.0, 1.0], (500, 1))
        wo, normal = (walk.cosine_direction(random.random((500, 2))) for _ in range(2))
        for bend in (walk.our_bend, walk.cycles_bend):
            up = walk.reflected(wo, bend(normal, wo, n))[:, 2]
            self.assertGreater(up.min(), 0.0)


class Statistics(unittest.TestCase):
    def setUp(self) -> None:
        random = np.random.default_rng(7)
        self.a = 1.02 * random.gamma(4.0, 0.25, (4, 40, 36, 3))
        self.b = random.gamma(4.0, 0.25, (4, 40, 36, 3))

    def test_ratio_and_its_error(self) -> None:
        mean = compare.compare(self.a, self.b)["mean"]
        # Each image has 4 seeds x 1440 pixels x 3 channels with a standard deviation of 0.5.
        self.assertAlmostEqual(mean["error"], np.sqrt(2) * 0.5 / np.sqrt(4 * 1440 * 3), delta=2e-3)
        self.assertLess(abs(mean["ratio"] - 1.02), 3 * mean["error"])

    def test_a_local_difference_is_found_where_it_is(self) -> None:
        self.a[:, 16:24, 32:36] *= 2.0
        blocks = compare.compare(self.a, self.b)["blocks"]
        self.assertEqual((blocks["worst"]["x"], blocks["worst"]["y"]), (32, 16))
        self.assertAlmostEqual(blocks["worst"]["relative"], 1.04, delta=0.2)
        self.assertEqual(blocks["count"], 25)

    def test_black_against_black_and_against_light(self) -> None:
        black = np.zeros_like(self.a)
        self.assertEqual(compare.compare(black, black)["mean"]["ratio"], 1.0)
        self.assertIsNone(compare.compare(self.a, black)["mean"]["ratio"])

    def test_one_seed_or_two_sizes_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "two seeds"):
            compare.compare(self.a[:1], self.b[:1])
        with self.assertRaisesRegex(ValueError, "sizes differ"):
            compare.compare(self.a, self.b[:, :, :30])

    def test_verdict(self) -> None:
        def of(ratio: float | None, error: float) -> str:
            return cross_check.verdict({"mean": {"ratio": ratio, "error": error}}, 0.01)

        self.assertEqual(of(1.009, 0.001), "agrees")
        self.assertEqual(of(0.985, 0.001), "differs")
        self.assertEqual(of(1.012, 0.004), "differs")
        self.assertEqual(of(1.0, 0.006), "noisy")
        self.assertEqual(of(1.2, 0.02), "differs")
        self.assertEqual(of(None, 0.0), "differs")
        mean = {"mean": {"ratio": 1.05, "error": 0.001}}
        told = mean | {"expected": 1.048, "expected_error": 0.001}
        self.assertEqual(cross_check.verdict(told, 0.01), "agrees")
        told = mean | {"expected": 1.048, "expected_error": 0.006}
        self.assertEqual(cross_check.verdict(told, 0.01), "noisy")


class CommandLine(InFolder):
    def test_indirect_needs_the_direct_picture(self) -> None:
        self.assertEqual(cross_check.cycles_bounces((cases.INDIRECT,)), [0, 32])
        self.assertEqual(cross_check.cycles_bounces((cases.View("all", 5),)), [5])

    def test_reuse_renders_only_what_is_missing(self) -> None:
        def path(bounces: int, seed: int) -> Path:
            return self.folder / f"{bounces}.{seed}"

        for name in ("0.1", "0.2", "1.1"):
            self.write(name, "")
        seeds = range(1, 4)
        self.assertEqual(
            cross_check.missing_images([0, 1, 32], seeds, path, True),
            {(3,): [0], (2, 3): [1], (1, 2, 3): [32]},
        )
        self.assertEqual(
            cross_check.missing_images([0, 1], seeds, path, False), {(1, 2, 3): [0, 1]}
        )

    def assert_one_line(self, done: subprocess.CompletedProcess[str], code: int, said: str) -> None:
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn(said, done.stderr)

    def test_files_of_others_stay(self) -> None:
        """Files of others stay, even where OUT is the folder of the scenes."""
        scene = self.folder / "room-point" / "scene.toml"
        cases.prepare(
            next(case for case in cases.CASES if case.name == "room-point"),
            ROOT / "scenes",
            scene.parent,
        )
        cases.prepare(
            next(case for case in cases.CASES if case.name == "room-point"),
            ROOT / "scenes",
            scene.parent,
        )
        scene.write_text("[film]\nwidth = 8\n")
        fake = self.write("fake", "#!/bin/sh\nexit 0\n")
        fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
        words = (
            "room-point",
            "--blender",
            str(fake),
            "--vpl-render",
            str(fake),
            "--out",
            str(self.folder),
        )
        self.assert_one_line(
            command(*words), 3, "scene.toml: is not a scene that cross_check.py made"
        )
        self.assertEqual(scene.read_text(), "[film]\nwidth = 8\n")
        results = self.write("results.json", '{"asset": {"version": "2.0"}}')
        self.assert_one_line(
            command(*words),
            3,
            "results.json: is not results of cross_check.py, which --results would",
        )
        self.assertEqual(results.read_text(), '{"asset": {"version": "2.0"}}')

    def test_no_blender_is_one_line_and_code_3(self) -> None:
        done = command("cornell", "--blender", "no-such-blender", "--out", str(self.folder))
        self.assert_one_line(done, 3, "no-such-blender: no such program; apt-get install")

    def test_a_table_of_nothing_is_code_3(self) -> None:
        done = command("--table", "--out", str(self.folder))
        self.assert_one_line(done, 3, "results.json")

    def test_an_unknown_case_is_code_2(self) -> None:
        done = command("cornel")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no case 'cornel'", done.stderr)

    def test_a_blender_that_writes_nothing_is_code_3(self) -> None:
        fake = self.write("fake", "#!/bin/sh\nexit 0\n")
        fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
        if not Path(VPL_RENDER).is_file():
            self.skipTest("no vpl-render")
        done = command(
            "room-point",
            "--effort",
            "0.004",
            "--blender",
            str(fake),
            "--vpl-render",
            VPL_RENDER,
            "--out",
            str(self.folder / "out"),
        )
        self.assert_one_line(done, 3, "fake failed: exit code 0; all it said is in")
        self.assertFalse((self.folder / "out" / "results.json").exists())

    @unittest.skipUnless(shutil.which("blender") and Path(VPL_RENDER).is_file(), "no Blender")
    def test_a_small_cornell_box_agrees(self) -> None:
        done = command(
            "cornell",
            "--effort",
            "0.03",
            "--tolerance",
            "0.05",
            "--vpl-render",
            VPL_RENDER,
            "--out",
            str(self.folder),
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("agrees"), 3)
        table = command("--table", "--out", str(self.folder)).stdout.splitlines()
        self.assertEqual(
            [row.split(" | ")[:2] for row in table[2:]],
            [["| cornell", v.name] for v in cases.CASES[0].views],
        )
        self.assertTrue((self.folder / "cornell" / "indirect-32.png").is_file())

    @unittest.skipUnless(shutil.which("blender") and Path(VPL_RENDER).is_file(), "no Blender")
    def test_flat_faces_of_a_mesh_with_normals_stay_flat(self) -> None:
        # Without explicit flat normals, the normals of the knobs make Cycles shade the walls of
        # that mesh as if round, with 12 % too much direct light. The mirror teapot shows light that
        # must count as direct.
        command(
            "veach-door", "--effort", "0.06", "--vpl-render", VPL_RENDER, "--out", str(self.folder)
        )
        results = json.loads((self.folder / "results.json").read_text())
        mean = results["veach-door"]["views"]["direct-0"]["mean"]
        self.assertLess(abs(mean["ratio"] - 1.0), 0.05)
        self.assertLess(mean["error"], 0.02)


if __name__ == "__main__":
    unittest.main()
