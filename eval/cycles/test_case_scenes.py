#!/usr/bin/python3
"""Tests the scenes of the cross-check: their reader, their preparation and the built ones.

python3 eval/cycles/test_case_scenes.py
"""

from __future__ import annotations

import json
import struct
import sys
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import cases  # noqa: E402
import gltf_file  # noqa: E402
import model_cases  # noqa: E402
import model_scenes  # noqa: E402
import scene_source as source  # noqa: E402
from in_folder import InFolder  # noqa: E402

ROOT = HERE.parent.parent
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


class Reader(InFolder):
    def mesh(self, matrix: npt.NDArray[Any], mtl: str = MTL) -> source.Mesh:
        self.write("m.mtl", mtl)
        return source.read_mesh(self.write("m.obj", OBJ), None, matrix)

    def test_what_would_make_another_scene_is_refused(self) -> None:
        self.write("m.mtl", MTL)
        self.write("m.obj", OBJ)
        film = "[film]\nwidth = 4\nheight = 3\n"
        camera = "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\nvertical_fov_deg = 40\n"
        mesh = '[[mesh]]\nfile = "m.obj"\n'
        source.read_scene(self.write("good.toml", film + camera + mesh))
        for more, problem in (
            (camera + "lens_radius = 0.1\n" + mesh, r"\[camera\] lens_radius is not mapped"),
            (camera + mesh + "[[mesh.instance]]\nscale = 2\n", r"\[mesh\] instance is not mapped"),
            (camera + mesh + '[[material]]\nname = "A"\n', r"\[material\] is not mapped"),
            (camera + mesh + '[[light]]\ntype = "area"\n', "light 'area' is none of point, spot"),
        ):
            with self.assertRaisesRegex(source.SceneError, problem):
                source.read_scene(self.write("bad.toml", film + more))

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


if __name__ == "__main__":
    unittest.main()
