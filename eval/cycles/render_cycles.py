"""Renders a scene.toml with Blender's Cycles. Runs inside Blender, on the CPU, without a window:

  blender -b --factory-startup --python-exit-code 3 --python render_cycles.py -- SCENE.toml
      --output image.{bounces}.{seed}.exr --bounces 0,32 --seeds 1,2 --spp 256 [--threads 2]

Geometry goes in as it is (our y is not turned to Blender's z), with one Blender vertex for each
pair of position and normal, so that shading normals arrive unchanged. README.md lists every
convention that is matched here.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parent))
import scene_source as source  # noqa: E402
from scene_source import SceneError  # noqa: E402


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="render_cycles.py", description=__doc__.split("\n")[0])
    parser.add_argument("scene", type=Path)
    parser.add_argument("--output", required=True, help="with {bounces} and {seed} in its name")
    parser.add_argument("--bounces", default="32", help="limits as our --max-bounces: 0,32")
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--encoded-textures", action="store_true",
                        help="let Cycles filter the sRGB values, as it does by itself")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1:])


def linear_image(path: Path) -> bpy.types.Image:
    """The texture as linear floats. Cycles filters 8-bit sRGB images before it decodes them; ours
    decodes first, as light adds up."""
    encoded = bpy.data.images.load(str(path))
    encoded.alpha_mode = "NONE"
    width, height = encoded.size
    pixels = np.empty(width * height * 4, np.float32)
    encoded.pixels.foreach_get(pixels)
    low = pixels <= 0.04045
    pixels = np.where(low, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4).astype(np.float32)
    pixels[3::4] = 1.0
    image = bpy.data.images.new(path.name, width, height, float_buffer=True, is_data=True)
    image.pixels.foreach_set(pixels)
    image.update()
    return image


def albedo_socket(tree: bpy.types.NodeTree, material: source.Material, encoded: bool):
    """The node output that has Kd times map_Kd, or None for a plain colour."""
    if material.map_kd is None:
        return None
    if not material.map_kd.is_file():
        raise SceneError(f"{material.map_kd}: no such texture; supply it")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = (bpy.data.images.load(str(material.map_kd)) if encoded
                     else linear_image(material.map_kd))
    texture.interpolation = "Linear"
    texture.extension = "REPEAT"
    scale = tree.nodes.new("ShaderNodeVectorMath")
    scale.operation = "MULTIPLY"
    scale.inputs[1].default_value = material.kd
    tree.links.new(texture.outputs["Color"], scale.inputs[0])
    return scale.outputs[0]


def reflection_shader(tree: bpy.types.NodeTree, material: source.Material, encoded: bool):
    if material.glass:
        glass = tree.nodes.new("ShaderNodeBsdfGlass")
        glass.distribution = "SHARP"
        glass.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        glass.inputs["IOR"].default_value = material.ior
        return glass.outputs[0]
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")  # roughness 0: Lambert
    diffuse.inputs["Roughness"].default_value = 0.0
    diffuse.inputs["Color"].default_value = (*material.kd, 1.0)
    socket = albedo_socket(tree, material, encoded)
    if socket is not None:
        tree.links.new(socket, diffuse.inputs["Color"])
    if not material.mirror:
        return diffuse.outputs[0]
    mirror = tree.nodes.new("ShaderNodeBsdfGlossy")
    mirror.distribution = "SHARP"
    mirror.inputs["Color"].default_value = (*material.ks, 1.0)
    return add_shaders(tree, diffuse.outputs[0], mirror.outputs[0])


def add_shaders(tree: bpy.types.NodeTree, a, b):
    node = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(a, node.inputs[0])
    tree.links.new(b, node.inputs[1])
    return node.outputs[0]


def emission_shader(tree: bpy.types.NodeTree, material: source.Material):
    """Radiance Ke; on the side of the winding only, unless the material says otherwise."""
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*material.ke, 1.0)
    emission.inputs["Strength"].default_value = 1.0
    if not material.two_sided:
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        front = tree.nodes.new("ShaderNodeMath")
        front.operation = "SUBTRACT"
        front.inputs[0].default_value = 1.0
        tree.links.new(geometry.outputs["Backfacing"], front.inputs[1])
        tree.links.new(front.outputs[0], emission.inputs["Strength"])
    return emission.outputs[0]


def make_material(material: source.Material, encoded: bool) -> bpy.types.Material:
    made = bpy.data.materials.new(material.name)
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    shader = reflection_shader(tree, material, encoded)
    if any(material.ke):
        shader = add_shaders(tree, shader, emission_shader(tree, material))
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader, output.inputs["Surface"])
    return made


def make_mesh(mesh: source.Mesh, name: str, encoded: bool) -> None:
    count = len(mesh.position)
    smooth = ~np.isnan(mesh.normal).any(axis=(1, 2))
    corners = np.concatenate([mesh.position, np.nan_to_num(mesh.normal)], axis=2)
    vertices, index = np.unique(corners.reshape(-1, 6), axis=0, return_inverse=True)

    made = bpy.data.meshes.new(name)
    made.vertices.add(len(vertices))
    made.vertices.foreach_set("co", vertices[:, :3].astype(np.float32).ravel())
    made.loops.add(3 * count)
    made.loops.foreach_set("vertex_index", index.astype(np.int32))
    made.polygons.add(count)
    made.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
    made.polygons.foreach_set("loop_total", np.full(count, 3, np.int32))
    made.polygons.foreach_set("material_index", mesh.material.astype(np.int32))
    made.polygons.foreach_set("use_smooth", smooth)
    uv = made.uv_layers.new(name="uv")
    uv.data.foreach_set("uv", np.nan_to_num(mesh.uv).astype(np.float32).ravel())
    for material in mesh.materials:
        made.materials.append(make_material(material, encoded))
    made.update(calc_edges=True)
    if len(made.polygons) != count:
        raise SceneError(f"{name}: Blender dropped triangles; report this")
    if smooth.any():
        made.use_auto_smooth = True  # without it Blender ignores custom normals
        made.auto_smooth_angle = math.pi
        made.normals_split_custom_set_from_vertices(vertices[:, 3:].tolist())

    thing = bpy.data.objects.new(name, made)
    # Both default to hiding the terminator of coarse meshes, by moving light.
    thing.cycles.shadow_terminator_offset = 0.0
    thing.cycles.shadow_terminator_geometry_offset = 0.0
    bpy.context.scene.collection.objects.link(thing)


def make_lamp(light: dict, name: str) -> None:
    kinds = {"point": "POINT", "spot": "SPOT", "directional": "SUN"}
    lamp = bpy.data.lights.new(name, kinds[light["type"]])
    colour = light["irradiance" if light["type"] == "directional" else "intensity"]
    peak = max(colour) or 1.0
    lamp.color = [c / peak for c in colour]
    thing = bpy.data.objects.new(name, lamp)
    if light["type"] == "directional":
        lamp.energy = peak  # W/m2 on a facing surface
        lamp.angle = math.radians(light.get("angular_diameter_deg", 0.0))
    else:
        lamp.energy = peak * 4.0 * math.pi  # W over the sphere, cone or not; ours is W/sr
        lamp.shadow_soft_size = 0.0
    if light["type"] == "spot":
        if light.get("falloff_deg", 0.0) > 0.0:
            raise SceneError("spot light: Cycles' soft rim has another shape; use falloff_deg 0")
        lamp.spot_size = 2.0 * math.radians(light["cone_deg"])
        lamp.spot_blend = 0.0
        undo_cosine(lamp)
    if "direction" in light:
        forward = np.array(light["direction"], float)
        forward /= np.linalg.norm(forward)
        side = np.cross(forward, np.eye(3)[np.argmin(np.abs(forward))])
        side /= np.linalg.norm(side)
        place(thing, side, np.cross(side, forward), forward, light.get("position", (0, 0, 0)))
    else:
        thing.location = light["position"]
    bpy.context.scene.collection.objects.link(thing)


def undo_cosine(lamp: bpy.types.Light) -> None:
    """Cycles' spot dims by the cosine to its axis; ours is even inside the cone."""
    lamp.use_nodes = True
    tree = lamp.node_tree
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    parts = tree.nodes.new("ShaderNodeSeparateXYZ")
    inverse = tree.nodes.new("ShaderNodeMath")
    inverse.operation = "DIVIDE"
    inverse.inputs[0].default_value = 1.0
    size = tree.nodes.new("ShaderNodeMath")
    size.operation = "ABSOLUTE"
    tree.links.new(coordinates.outputs["Normal"], parts.inputs[0])
    tree.links.new(parts.outputs["Z"], size.inputs[0])
    tree.links.new(size.outputs[0], inverse.inputs[1])
    tree.links.new(inverse.outputs[0], tree.nodes["Emission"].inputs["Strength"])


def make_world(lights: list[dict], scene_folder: Path) -> None:
    world = bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    background.inputs["Strength"].default_value = 1.0
    if len(lights) > 1:
        raise SceneError("more than one environment light; the cross-check maps one")
    for light in lights:
        background.inputs["Strength"].default_value = light.get("scale", 1.0)
        if "radiance" in light:
            background.inputs["Color"].default_value = (*light["radiance"], 1.0)
        else:
            tree.links.new(environment_image(tree, light, scene_folder), background.inputs["Color"])
        world.cycles.sampling_method = "AUTOMATIC"


def environment_image(tree: bpy.types.NodeTree, light: dict, folder: Path):
    """Our image has -z at its centre and goes round over +x, about +y; Cycles' has +x at its
    centre and goes round over -y, about +z. Ours is looked up texel by texel."""
    image = tree.nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(str(source.resolve(folder / "x", light["image"])))
    image.interpolation = "Closest"
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    turned = tree.nodes.new("ShaderNodeVectorRotate")
    turned.rotation_type = "Y_AXIS"
    turned.inputs["Angle"].default_value = -math.radians(light.get("rotate_deg", 0.0))
    parts = tree.nodes.new("ShaderNodeSeparateXYZ")
    joined = tree.nodes.new("ShaderNodeCombineXYZ")
    tree.links.new(coordinates.outputs["Generated"], turned.inputs["Vector"])
    tree.links.new(turned.outputs[0], parts.inputs[0])
    for ours, theirs in (("Z", "X"), ("X", "Y")):
        negated = tree.nodes.new("ShaderNodeMath")
        negated.operation = "MULTIPLY"
        negated.inputs[1].default_value = -1.0
        tree.links.new(parts.outputs[ours], negated.inputs[0])
        tree.links.new(negated.outputs[0], joined.inputs[theirs])
    tree.links.new(parts.outputs["Y"], joined.inputs["Z"])
    tree.links.new(joined.outputs[0], image.inputs["Vector"])
    return image.outputs["Color"]


def place(thing: bpy.types.Object, right, up, forward, position) -> None:
    """Cameras and lamps of Blender look along their own -z."""
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = right, up, -np.asarray(forward)
    matrix[:3, 3] = position
    thing.matrix_world = Matrix(matrix.tolist())


def make_camera(camera: source.Camera) -> None:
    made = bpy.data.cameras.new("camera")
    made.sensor_fit = "VERTICAL"
    made.angle_y = math.radians(camera.vertical_fov_deg)
    made.clip_start, made.clip_end = 1e-4, 1e5
    thing = bpy.data.objects.new("camera", made)
    place(thing, camera.right, camera.up, camera.forward, camera.position)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def set_film(scene: source.Scene, threads: int) -> None:
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = scene.width, scene.height
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.film_transparent = False
    render.threads_mode, render.threads = "FIXED", threads
    render.use_persistent_data = True
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode = "RGB"
    render.image_settings.color_depth = "32"
    render.image_settings.exr_codec = "ZIP"
    render.dither_intensity = 0.0


def set_unbiased(spp: int) -> None:
    """Off: whatever trades a right mean for less noise."""
    cycles = bpy.context.scene.cycles
    cycles.device = "CPU"
    cycles.samples = spp
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.time_limit = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.use_fast_gi = False
    cycles.use_guiding = False
    cycles.auto_scrambling_distance = False
    cycles.scrambling_distance = 1.0
    cycles.pixel_filter_type = "BOX"  # one pixel wide
    cycles.film_exposure = 1.0
    cycles.use_animated_seed = False


def set_bounces(bounces: int) -> None:
    cycles = bpy.context.scene.cycles
    cycles.max_bounces = bounces
    cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    cycles.transparent_max_bounces = 8
    cycles.min_light_bounces = 0  # Russian roulette from the start, as ours


def run() -> None:
    options = parse_arguments()
    scene = source.read_scene(options.scene)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    for number, mesh in enumerate(scene.meshes):
        make_mesh(mesh, f"mesh{number}", options.encoded_textures)
    for number, light in enumerate(scene.lights):
        if light["type"] != "environment":
            make_lamp(light, f"light{number}")
    make_world([x for x in scene.lights if x["type"] == "environment"], options.scene.parent)
    make_camera(scene.camera)
    set_film(scene, options.threads)
    set_unbiased(options.spp)
    for bounces in options.bounces.split(","):
        set_bounces(int(bounces))
        for seed in options.seeds.split(","):
            bpy.context.scene.cycles.seed = int(seed)
            name = options.output.replace("{bounces}", bounces).replace("{seed}", seed)
            partial = Path(name).with_suffix(".partial.exr")
            bpy.context.scene.render.filepath = str(partial.resolve())
            bpy.ops.render.render(write_still=True)
            partial.replace(name)


if __name__ == "__main__":
    try:
        run()
    except SceneError as error:
        print(f"render_cycles.py: {error}", file=sys.stderr)
        sys.exit(3)
