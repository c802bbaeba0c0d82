# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports a scene, in a Blender of its own: blender --background ... --python child.py -- REQUEST

REQUEST is a JSON file: blend, scene, view_layer, frame, glb, and world, an image or null. The
exporter does not work within a render, so this one runs beside it.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import addon_utils
import bpy

DEFAULT_MATERIAL = "bnvpl default"  # as in materials.py
WORLD_SIZE = (2048, 1024)
WORLD_SAMPLES = 4
EXPORT = {
    "export_format": "GLB",
    "use_renderable": True,
    "use_active_scene": True,
    "export_apply": True,
    "export_yup": True,
    "export_lights": False,
    "export_cameras": False,
    "export_animations": False,
    "export_current_frame": True,
    "export_skins": False,
    "export_morph": False,
    "export_extras": False,
    "export_gn_mesh": True,
}


def load(request) -> bpy.types.Scene:
    """Loads the scene into an empty file, so that no name is taken."""
    kinds = ("objects", "meshes", "materials", "lights", "cameras", "worlds", "collections")
    bpy.data.batch_remove([data for kind in kinds for data in getattr(bpy.data, kind)])
    bpy.context.scene.name = "bnvpl unused"
    with bpy.data.libraries.load(request["blend"]) as (_, target):
        target.scenes = [request["scene"]]
    scene = target.scenes[0]
    bpy.context.window.scene = scene
    if request["view_layer"] in scene.view_layers:
        bpy.context.window.view_layer = scene.view_layers[request["view_layer"]]
    scene.frame_set(request["frame"])
    return scene


def exclude_hidden(layer_collection) -> None:
    for child in layer_collection.children:
        child.exclude = child.exclude or child.collection.hide_render
        child.hide_viewport = False
        child.collection.hide_viewport = False
        exclude_hidden(child)


def show_as_rendered(scene) -> None:
    """Makes the viewport's visibility and details, which the exporter reads, those of renders."""
    exclude_hidden(bpy.context.view_layer.layer_collection)
    for thing in scene.objects:
        thing.hide_viewport = thing.hide_render
        if thing.name in bpy.context.view_layer.objects:
            thing.hide_set(False)
        for modifier in thing.modifiers:
            modifier.show_viewport = modifier.show_render
            if hasattr(modifier, "render_levels"):
                modifier.levels = modifier.render_levels
        for axis in ("u", "v"):
            detail = getattr(thing.data, f"render_resolution_{axis}", 0)
            if detail:
                setattr(thing.data, f"resolution_{axis}", detail)


def give_default_material() -> None:
    """glTF takes what has no material for metal, Blender for grey."""
    grey = bpy.data.materials.new(DEFAULT_MATERIAL)
    for data in (*bpy.data.meshes, *bpy.data.curves):
        if not data.materials:
            data.materials.append(grey)
        for slot, material in enumerate(data.materials):
            data.materials[slot] = material or grey
    for thing in bpy.data.objects:
        for slot in thing.material_slots:
            if slot.material is None:
                slot.material = grey


def export_glb(path: str) -> None:
    addon_utils.enable("io_scene_gltf2")
    known = bpy.ops.export_scene.gltf.get_rna_type().properties.keys()
    options = {key: value for key, value in EXPORT.items() if key in known}
    bpy.ops.export_scene.gltf(filepath=path, **options)


def render_world(scene, path: str) -> None:
    """Renders the world alone, all around; the image's centre is +y, which is our -z."""
    addon_utils.enable("cycles")
    alone = bpy.data.scenes.new("bnvpl world")
    alone.world = scene.world
    data = bpy.data.cameras.new("bnvpl world")
    data.type = "PANO"
    panorama = data if hasattr(data, "panorama_type") else data.cycles
    panorama.panorama_type = "EQUIRECTANGULAR"
    camera = bpy.data.objects.new("bnvpl world", data)
    camera.rotation_euler = (math.pi / 2, 0, 0)
    alone.collection.objects.link(camera)
    alone.camera = camera
    render = alone.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = WORLD_SIZE
    render.resolution_percentage = 100
    render.filepath = path
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode = "RGB"
    render.image_settings.color_depth = "32"
    alone.cycles.device = "CPU"
    alone.cycles.samples = WORLD_SAMPLES
    alone.cycles.use_denoising = False
    alone.cycles.use_adaptive_sampling = False
    alone.cycles.pixel_filter_type = "BOX"
    bpy.ops.render.render(write_still=True, scene=alone.name)


def main() -> None:
    request = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text())
    scene = load(request)
    show_as_rendered(scene)
    give_default_material()
    if request["world"]:
        render_world(scene, request["world"])
    export_glb(request["glb"])


main()
