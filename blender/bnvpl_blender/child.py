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


def excluded_in(layer_collection):
    """Excluded collections with their parents, and those of their children that are not."""
    for child in layer_collection.children:
        if child.exclude:
            kept = [inner.collection for inner in child.children if not inner.exclude]
            yield layer_collection.collection, child.collection, kept
        yield from excluded_in(child)


def unlink_excluded() -> None:
    """The exporter takes all objects of a scene, and loses the children of those that it lacks."""
    view_layer = bpy.context.view_layer
    view_layer.update()
    shown = set(view_layer.objects)
    for thing in shown:
        if thing.parent is None or thing.parent in shown:
            continue
        placed = thing.matrix_world.copy()
        thing.animation_data_clear()
        thing.constraints.clear()
        thing.parent = None
        thing.matrix_world = placed
    for parent, collection, kept in list(excluded_in(view_layer.layer_collection)):
        for inner in kept:
            if inner.name not in parent.children:
                parent.children.link(inner)
        if collection.name in parent.children:
            parent.children.unlink(collection)
    view_layer.update()


def show_as_rendered(scene) -> None:
    """Makes the viewport's visibility and details, which the exporter reads, those of renders."""
    exclude_hidden(bpy.context.view_layer.layer_collection)
    render = scene.render
    render.simplify_subdivision = render.simplify_subdivision_render
    for thing in bpy.data.objects:
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


def empty_hidden_instances() -> None:
    """The exporter takes all objects of an instanced collection, whatever hides them in renders."""
    scene, shown = bpy.context.scene, set(bpy.context.view_layer.objects)
    for collection in set(bpy.data.collections) - set(scene.collection.children_recursive):
        for child in list(collection.children):
            if child.hide_render:
                collection.children.unlink(child)
    for thing in bpy.data.objects:
        if thing.instance_collection and thing.instance_collection.hide_render:
            thing.instance_collection = None
        if not thing.hide_render or thing in shown:
            continue
        thing.modifiers.clear()  # an object without data keeps the place of its children
        if thing.type == "MESH":
            thing.data = bpy.data.meshes.new("hidden")
        elif thing.type in ("CURVE", "SURFACE", "FONT"):
            thing.data = bpy.data.curves.new("hidden", thing.type)


def apply_shape_keys() -> None:
    """The exporter takes a mesh without modifiers as it is, in the shape of its first key."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for thing in bpy.data.objects:
        if thing.type != "MESH" or thing.data.shape_keys is None:
            continue
        shaped = bpy.data.meshes.new_from_object(thing.evaluated_get(depsgraph))
        thing.modifiers.clear()
        thing.data = shaped


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


def see_as_surfaces_do(world) -> None:
    """Makes Light Path tell of light on surfaces, as the camera's rays find the image."""
    for node in list(world.node_tree.nodes):
        if node.type != "LIGHT_PATH":
            continue
        for output in node.outputs:
            told = 1.0 if output.name == "Is Diffuse Ray" else 0.0
            for socket in [link.to_socket for link in output.links]:
                constant = world.node_tree.nodes.new("ShaderNodeValue")
                constant.outputs[0].default_value = told
                world.node_tree.links.new(constant.outputs[0], socket)


def render_world(scene, path: str) -> None:
    """Renders the world alone, all around; the image's centre is +y, which is our -z."""
    addon_utils.enable("cycles")
    see_as_surfaces_do(scene.world)
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
    unlink_excluded()
    empty_hidden_instances()
    apply_shape_keys()
    give_default_material()
    if request["world"]:
        render_world(scene, request["world"])
    export_glb(request["glb"])


main()
