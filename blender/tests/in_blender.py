# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests of the add-on inside Blender, which test_blender.py starts."""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "blender"))
import bnvpl_blender  # noqa: E402
from bnvpl_blender import engine, exr_file, tools  # noqa: E402

WIDTH, HEIGHT = 64, 48


def empty_scene() -> bpy.types.Scene:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    set_up(scene)
    return scene


def set_up(scene) -> None:
    scene.render.engine = "BNVPL"
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.bnvpl.preset = "DRAFT"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = 64, False, False
    cycles.sample_clamp_indirect, cycles.pixel_filter_type = 0.0, "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = 16


def material(name: str, colour) -> bpy.types.Material:
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes = made.node_tree.nodes
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*colour, 1)
    output = next(node for node in nodes if node.type == "OUTPUT_MATERIAL")
    made.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return made


def add_plane(name: str, location, rotation, colour) -> None:
    bpy.ops.mesh.primitive_plane_add(size=4, location=location, rotation=rotation)
    bpy.context.object.name = name
    if colour:
        bpy.context.object.data.materials.append(material(name, colour))


def corner() -> bpy.types.Scene:
    """A floor without a material and two walls, seen by a shifted camera."""
    scene = empty_scene()
    add_plane("floor", (0, 0, 0), (0, 0, 0), None)
    add_plane("wall", (0, 2, 2), (math.pi / 2, 0, 0), (0.7, 0.6, 0.5))
    add_plane("Wand links", (-2, 0, 2), (0, math.pi / 2, 0), (0.6, 0.2, 0.1))
    bpy.ops.object.camera_add(location=(3, -6, 3), rotation=(1.25, 0, 0.45))
    scene.camera = bpy.context.object
    scene.camera.data.shift_x = 0.05
    return scene


def add_lamp(kind: str, power: float, location=(0.3, -0.5, 2.5), rotation=(0.2, -0.4, 0.1)):
    bpy.ops.object.light_add(type=kind, location=location, rotation=rotation)
    bpy.context.object.name = "Lämpchen"
    light = bpy.context.object.data
    light.energy, light.color = power, (1.0, 0.8, 0.5)
    return light


class RenderTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def render(self, scene, renderer: str = "BNVPL") -> np.ndarray:
        scene.render.engine = renderer
        path = self.folder / f"{renderer}.exr"
        scene.render.filepath = str(path)
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(path))
        pixels = np.empty(len(image.pixels), np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        height, width = scene.render.resolution_y, scene.render.resolution_x
        return pixels.reshape(height, width, -1)[::-1, :, :3]

    def expect_like_cycles(self, scene, tolerance: float = 0.03) -> None:
        """Means of channels and of the image's quarters agree."""
        ours, cycles = self.render(scene), self.render(scene, "CYCLES")
        ratio = ours.mean(axis=(0, 1)) / cycles.mean(axis=(0, 1))
        quarters = [
            ours[y : y + 24, x : x + 32].mean() / cycles[y : y + 24, x : x + 32].mean()
            for y in (0, 24)
            for x in (0, 32)
        ]
        print(f"  {self.id().rpartition('.')[2]}: ours / Cycles {ratio} quarters {quarters}")
        np.testing.assert_allclose(ratio, 1, atol=tolerance)
        np.testing.assert_allclose(quarters, 1, atol=2 * tolerance)


class BrightnessTest(RenderTest):
    def test_point(self) -> None:
        scene = corner()
        add_lamp("POINT", 200).shadow_soft_size = 0
        self.expect_like_cycles(scene)

    def test_point_with_a_radius(self) -> None:
        scene = corner()
        add_lamp("POINT", 200, (0.3, -1, 5)).shadow_soft_size = 0.3
        self.expect_like_cycles(scene)

    def test_sun(self) -> None:
        scene = corner()
        add_lamp("SUN", 3).angle = 0.05
        self.expect_like_cycles(scene)

    def test_spot(self) -> None:
        """Cycles 3.4 dims a spot by the cosine to its axis, and no other renderer does."""
        scene = corner()
        light = add_lamp("SPOT", 500)
        light.spot_size, light.spot_blend, light.shadow_soft_size = 0.8, 0.3, 0
        self.expect_like_cycles(scene, 0.05)

    def test_areas(self) -> None:
        for shape in ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE"):
            with self.subTest(shape):
                scene = corner()
                light = add_lamp("AREA", 200, (0.3, -1, 5))
                light.shape, light.size, light.size_y = shape, 1.0, 0.4
                bpy.context.object.scale = (0.8, 1.5, 1)
                self.expect_like_cycles(scene)

    def test_world_of_one_colour(self) -> None:
        scene = corner()
        scene.world = bpy.data.worlds.new("Himmel")
        scene.world.use_nodes = True
        background = scene.world.node_tree.nodes["Background"]
        background.inputs[0].default_value = (0.2, 0.4, 0.8, 1)
        background.inputs[1].default_value = 1.5
        self.expect_like_cycles(scene)

    def test_world_of_nodes(self) -> None:
        """A gradient that differs in all directions shows how the image is turned."""
        scene = corner()
        scene.world = bpy.data.worlds.new("Himmel")
        scene.world.use_nodes = True
        tree = scene.world.node_tree
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        positive = tree.nodes.new("ShaderNodeVectorMath")
        positive.operation = "MULTIPLY_ADD"
        positive.inputs[1].default_value = positive.inputs[2].default_value = (0.5, 0.5, 0.5)
        tree.links.new(coordinates.outputs["Generated"], positive.inputs[0])
        tree.links.new(positive.outputs[0], tree.nodes["Background"].inputs["Color"])
        self.expect_like_cycles(scene)


    def test_world_that_the_camera_sees_otherwise(self) -> None:
        """A plain backdrop for the camera does not light the scene."""
        scene = corner()
        scene.camera.location = (0, -0.5, 1.5)  # only surfaces are in view
        scene.camera.rotation_euler = (1.1, 0, 0.675)
        scene.world = bpy.data.worlds.new("Himmel")
        scene.world.use_nodes = True
        tree = scene.world.node_tree
        path = tree.nodes.new("ShaderNodeLightPath")
        mix = tree.nodes.new("ShaderNodeMixRGB")
        mix.inputs[1].default_value, mix.inputs[2].default_value = (1, 1, 1, 1), (0, 0, 9, 1)
        tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
        tree.links.new(mix.outputs[0], tree.nodes["Background"].inputs["Color"])
        self.expect_like_cycles(scene)


class FilesTest(RenderTest):
    def kept(self, scene) -> Path:
        scene.bnvpl.keep_files = True
        scene.bnvpl.folder = str(self.folder / "kept")
        return self.folder / "kept"

    def test_default_scene_with_area_light(self) -> None:
        """Blender's own first scene: a cube alone, where no surface lights another.

        The model of glTF, with which Principled BSDF is exported, reflects 5 % less than in 3.4.
        """
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        scene = bpy.context.scene
        set_up(scene)
        bpy.data.lights["Light"].type = "AREA"
        folder = self.kept(scene)
        self.expect_like_cycles(scene, 0.08)
        self.assertIn('name = "World"', (folder / "scene.toml").read_text())
        self.assertNotIn("lit.vpl", (folder / "render.sh").read_text())

    def test_image_is_that_of_the_command_line(self) -> None:
        scene = corner()
        add_lamp("AREA", 200)
        folder = self.kept(scene)
        pixels = self.render(scene)
        first = (folder / "image.exr").read_bytes()
        self.assertIn('name = "Lämpchen"', (folder / "scene.toml").read_text())
        image = exr_file.read_exr(folder / "image.exr")
        np.testing.assert_array_equal(pixels, exr_file.layer(image, "", "RGB"))
        for name in ("candidates.vpl", "vpls.vpl", "lit.vpl", "image.exr"):
            (folder / name).unlink()
        subprocess.run([folder / "render.sh"], check=True, capture_output=True)
        self.assertEqual((folder / "image.exr").read_bytes(), first)
        told = subprocess.run(
            ["vpl-inspect", "scene", "scene.toml"], cwd=folder, check=True, capture_output=True
        ).stdout.decode()
        for name in ("floor", "wall", "Wand links", "Lämpchen"):
            self.assertIn(name, told)

    def test_gltf_room(self) -> None:
        """The room that came as glTF looks as it does without Blender."""
        scene = empty_scene()
        room = ROOT / "scenes/gltf-room/room.glb"
        if not hasattr(np, "bool"):
            np.bool = bool  # the importer of 3.4 uses this name, which NumPy lacked
        bpy.ops.import_scene.gltf(filepath=str(room))
        scene.camera = next(o for o in scene.objects if o.type == "CAMERA")
        scene.bnvpl.preset = "DEFAULT"
        pixels = self.render(scene)
        size = f"{WIDTH}x{HEIGHT}"
        command = ["vpl-render", room, "-o", self.folder / "path.exr", "--integrator", "path"]
        command += ["--spp", "256", "--size", size]
        subprocess.run(command, check=True, capture_output=True)
        image = exr_file.read_exr(self.folder / "path.exr")
        reference = exr_file.layer(image, "", "RGB")
        ratio = pixels.mean(axis=(0, 1)) / reference.mean(axis=(0, 1))
        print(f"  gltf-room: through Blender / by itself {ratio}")
        np.testing.assert_allclose(ratio, 1, atol=0.05)

    def test_errors_are_those_of_the_tools(self) -> None:
        scene = corner()
        folder = self.kept(scene)
        with self.assertRaisesRegex(RuntimeError, "vpl-estimate: .*light"):
            self.render(scene)
        self.assertFalse((folder / "image.exr").exists())

    def test_stopped_render_leaves_no_image(self) -> None:
        scene = corner()
        add_lamp("POINT", 200)
        folder = self.kept(scene)
        with mock.patch.object(engine, "run_tool", side_effect=tools.Cancelled):
            bpy.ops.render.render()  # no error
        self.assertFalse((folder / "image.exr").exists())

    def test_instances_and_details_of_renders(self) -> None:
        """Lamps of a collection's instances count; hidden objects do not; modifiers apply."""
        scene = corner()
        group = bpy.data.collections.new("lamps")
        group.objects.link(bpy.data.objects.new("inner", bpy.data.lights.new("inner", "POINT")))
        for x in (0, 1):
            bpy.ops.object.collection_instance_add(collection="lamps", location=(x, 0, 3))
        bpy.data.objects["Wand links"].hide_render = True
        bpy.data.objects["wall"].hide_viewport = True
        subdivision = bpy.data.objects["floor"].modifiers.new("fine", "SUBSURF")
        subdivision.levels, subdivision.render_levels = 0, 2
        told = self.told(scene)
        self.assertEqual(told.count("'inner': ("), 2, told)
        self.assertIn("'floor': 32 triangles", told)
        self.assertIn("'wall': 2 triangles", told)
        self.assertNotIn("Wand links", told)

    def told(self, scene) -> str:
        """What vpl-inspect tells of the exported scene."""
        folder = self.kept(scene)
        self.render(scene)
        return subprocess.run(
            ["vpl-inspect", "scene", "scene.toml"], cwd=folder, check=True, capture_output=True
        ).stdout.decode()

    def test_collections_that_are_only_instanced(self) -> None:
        """Their modifiers are those of renders; what they hide in renders is not exported."""
        scene = corner()
        add_lamp("POINT", 200)
        group, inner = (bpy.data.collections.new(name) for name in ("things", "inner"))
        group.children.link(inner)
        for name, owner in (("seen", group), ("hidden", group), ("deep", inner)):
            bpy.ops.mesh.primitive_plane_add(location=(0, 0, 1))
            thing = bpy.context.object
            thing.name = name
            owner.objects.link(thing)
            scene.collection.objects.unlink(thing)
        bpy.data.objects["hidden"].hide_render = True
        inner.hide_render = True
        fine = bpy.data.objects["seen"].modifiers.new("fine", "SUBSURF")
        fine.levels, fine.render_levels = 0, 2
        bpy.ops.object.collection_instance_add(collection="things", location=(1, 0, 0))
        told = self.told(scene)
        self.assertIn("'seen': 32 triangles", told)
        self.assertNotIn("'hidden'", told)
        self.assertNotIn("'deep'", told)
        scene.collection.children.link(group)  # most people keep such collections, excluded
        layer = bpy.context.view_layer.layer_collection.children["things"]
        layer.exclude = True
        told = self.told(scene)
        self.assertIn("'seen': 32 triangles", told)
        self.assertNotIn("'hidden'", told)
        self.assertNotIn("'deep'", told)
        group.hide_render = True
        self.assertNotIn("'seen'", self.told(scene))

    def test_simplified_details(self) -> None:
        scene = corner()
        add_lamp("POINT", 200)
        fine = bpy.data.objects["floor"].modifiers.new("fine", "SUBSURF")
        fine.levels, fine.render_levels = 0, 3
        scene.render.use_simplify = True
        scene.render.simplify_subdivision, scene.render.simplify_subdivision_render = 0, 1
        self.assertIn("'floor': 8 triangles", self.told(scene))

    def test_shape_keys(self) -> None:
        scene = corner()
        add_lamp("POINT", 200)
        floor = bpy.data.objects["floor"]
        floor.shape_key_add(name="Basis")
        raised = floor.shape_key_add(name="raised")
        for point in raised.data:
            point.co.z = 0.5
        raised.value = 1.0
        self.expect_floor_at(0.5, scene)

    def expect_floor_at(self, expected: float, scene) -> None:
        folder = self.kept(scene)
        layer = bpy.context.view_layer
        layer.use_pass_position = layer.use_pass_normal = True
        self.render(scene)
        image = exr_file.read_exr(folder / "image.exr")
        on_floor = exr_file.layer(image, "N", "XYZ")[..., 1] > 0.999
        height = exr_file.layer(image, "P", "XYZ")[..., 1][on_floor]
        self.assertGreater(on_floor.mean(), 0.1)
        np.testing.assert_allclose(height, expected, atol=0.01)

    def test_children_of_what_is_hidden(self) -> None:
        """A visible object keeps its place below a parent that is not rendered."""
        for how in ("object", "collection", "excluded"):
            with self.subTest(how):
                scene = corner()
                add_lamp("POINT", 200)
                rig = bpy.data.collections.new("rig")
                scene.collection.children.link(rig)
                bpy.ops.mesh.primitive_plane_add(location=(0, 0, 0.5))
                parent = bpy.context.object
                parent.name = "parent"
                rig.objects.link(parent)
                scene.collection.objects.unlink(parent)
                bpy.data.objects["floor"].parent = parent
                parent.hide_render = how == "object"
                rig.hide_render = how == "collection"
                layer = bpy.context.view_layer.layer_collection.children["rig"]
                layer.exclude = how == "excluded"
                self.expect_floor_at(0.5, scene)
                self.assertNotIn("'parent'", self.told(scene))

    def test_render_region(self) -> None:
        scene = corner()
        add_lamp("POINT", 200)
        whole = self.render(scene)
        render = scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x = 0.3, 0.8
        render.border_min_y, render.border_max_y = 0.1, 0.55
        left, right = int(0.3 * WIDTH), int(0.8 * WIDTH)
        rows = slice(HEIGHT - int(0.55 * HEIGHT), HEIGHT - int(0.1 * HEIGHT))
        part = self.render(scene)
        np.testing.assert_array_equal(part[rows, left:right], whole[rows, left:right])
        self.assertEqual(part[: rows.start].max(), 0.0)
        render.use_crop_to_border = True
        render.filepath = str(self.folder / "crop.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(str(self.folder / "crop.exr"))
        self.assertEqual(tuple(image.size), (right - left, rows.stop - rows.start))
        pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], -1)
        np.testing.assert_array_equal(pixels[::-1, :, :3], whole[rows, left:right])

    def test_passes_and_depth_of_field(self) -> None:
        scene = corner()
        add_lamp("POINT", 200)
        scene.bnvpl.light_passes = scene.bnvpl.for_denoiser = True
        layer = bpy.context.view_layer
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = True
        scene.camera.data.dof.use_dof = True
        scene.camera.data.dof.focus_object = bpy.data.objects["wall"]
        folder = self.kept(scene)
        scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
        scene.render.filepath = str(self.folder / "layers.exr")
        bpy.ops.render.render(write_still=True)
        image = exr_file.read_exr(self.folder / "layers.exr")
        of = {name.partition(".")[2]: values for name, values in image.items()}
        total = of["Direct.R"] + of["Indirect.R"]
        np.testing.assert_allclose(total, of["Combined.R"], rtol=1e-3, atol=1e-5)
        on_floor = of["Normal.Z"] > 0.999
        self.assertGreater(on_floor.mean(), 0.1)
        self.assertLess(np.abs(of["Position.Z"][on_floor]).max(), 0.01)
        np.testing.assert_allclose(of["Denoising Normal.Z"][on_floor], 1, atol=0.01)
        self.assertGreater(of["Denoising Albedo.R"][on_floor].min(), 0.5)
        self.assertIn("--for-denoiser on", (folder / "render.sh").read_text())
        self.assertIn("focus_distance", (folder / "scene.toml").read_text())

    def test_viewport(self) -> None:
        scene = corner()
        add_lamp("POINT", 200)
        scene.bnvpl.view = "VIEWPORT"
        folder = self.kept(scene)
        self.render(scene)
        camera = (folder / "scene.toml").read_text().partition("[camera]")[2]
        place = bpy.context.window.screen.areas
        view = next(a for a in place if a.type == "VIEW_3D").spaces.active.region_3d
        x, y, z = view.view_matrix.inverted().translation
        numbers = camera.partition("[")[2].partition("]")[0].split(",")
        np.testing.assert_allclose([float(n) for n in numbers], [x, z, -y], atol=1e-4)


if __name__ == "__main__":
    bnvpl_blender.register()
    unittest.main(argv=["in_blender", *sys.argv[sys.argv.index("--") + 1 :]], verbosity=2)
