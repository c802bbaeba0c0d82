"""Tests that the key of a scene holds each file that the scene consists of, and no other."""

import gzip
import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bnvpl_eval.scene_files import scene_key  # noqa: E402 (after the path that it needs)


class SceneFiles(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def write(self, name: str, content: str) -> Path:
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        data = content.encode()
        file.write_bytes(gzip.compress(data) if file.suffix == ".gz" else data)
        return file

    def expect_in_key(self, scene: Path, *names: str) -> None:
        for name in names:
            before, file = scene_key(scene), self.folder / name
            old = file.read_bytes()
            file.write_bytes(old + b"\n# changed")
            self.assertNotEqual(scene_key(scene), before, name)
            file.write_bytes(old)
            self.assertEqual(scene_key(scene), before, name)

    def test_models_materials_textures_and_skies(self) -> None:
        scene = self.write(
            "scene.toml",
            '[[mesh]]\nfile = "${MODELS}/my room.obj"\nmaterials = "matt.mtl"\n'
            '[[light]]\ntype = "environment"\nfile = "sky.exr"\n',
        )
        self.write("models/my room.obj", "mtllib my room.mtl\nv 0 0 0\n")
        self.write(
            "models/my room.mtl", "newmtl a\nmap_Kd -s 2 2 1 textures/red wall.jpg\nbump b.png\n"
        )
        for name in ("models/textures/red wall.jpg", "models/b.png", "matt.mtl", "sky.exr"):
            self.write(name, name)
        with mock.patch.dict(os.environ, {"MODELS": str(self.folder / "models")}):
            self.expect_in_key(
                scene,
                "models/my room.obj",
                "models/my room.mtl",
                "models/textures/red wall.jpg",
                "models/b.png",
                "matt.mtl",
                "sky.exr",
            )
            before = scene_key(scene)
            self.write("picture.png", "beside the scene")
            self.assertEqual(scene_key(scene), before)

    def test_literal_strings(self) -> None:
        scene = self.write("scene.toml", "[[mesh]]\nfile = '.\\room.obj'\n")
        self.write("room.obj", "v 0 0 0\n")
        self.expect_in_key(scene, "room.obj")

    def test_what_a_pbrt_file_includes(self) -> None:
        scene = self.write("scene.pbrt", 'Include "geometry/all.pbrt.gz"\n')
        self.write(
            "geometry/all.pbrt.gz", 'Shape "plymesh" "string filename" "geometry/mesh.ply"\n'
        )
        self.write("geometry/mesh.ply", "ply\n")
        self.expect_in_key(scene, "geometry/mesh.ply")

    def test_what_a_gltf_names(self) -> None:
        scene = self.write("room.gltf", '{"buffers": [{"uri": "my%20room.bin"}]}')
        self.write("my room.bin", "bytes")
        self.expect_in_key(scene, "my room.bin")

    def test_what_a_binary_gltf_names(self) -> None:
        scene = self.write("room.glb", 'glTF\2\0\0\0{"images": [{"uri": "wall.png"}]}')
        self.write("wall.png", "bytes")
        self.expect_in_key(scene, "wall.png")

    def test_files_that_name_each_other_end(self) -> None:
        scene = self.write("a.pbrt", 'Include "b.pbrt"\n')
        self.write("b.pbrt", 'Include "a.pbrt"\n')
        self.expect_in_key(scene, "b.pbrt")

    def test_data_in_quotation_marks_is_no_name(self) -> None:
        data = "data:application/octet-stream;base64," + "A" * 100_000
        self.assertTrue(scene_key(self.write("room.gltf", f'{{"uri": "{data}"}}')))


if __name__ == "__main__":
    unittest.main()
