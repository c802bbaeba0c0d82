"""Renders a scene.toml with Blender's Cycles. Runs inside Blender, on the CPU, without a window.

    blender -b --factory-startup --python-exit-code 3 --python render_cycles.py -- SCENE.toml
        --output image.{bounces}.{seed}.exr --bounces 0,32 --seeds 1,2 --spp 256 [--threads 2]

The geometry keeps its axes: y is not turned to Blender's z. Each pair of position and normal is one
vertex of Blender, so that shading normals stay unchanged. README.md lists all conventions that are
matched here.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

sys.path.insert(0, str(Path(__file__).resolve().parent))
import model_cases  # noqa: E402
import model_scenes  # noqa: E402
import scene_source as source  # noqa: E402
from cycles_gltf import import_gltf  # noqa: E402
from cycles_lights import make_lamp, make_world, place  # noqa: E402
from cycles_materials import make_material  # noqa: E402
from outputs import output_guard  # noqa: E402
from scene_source import SceneError  # noqa: E402

# Emitting triangles are split to this size, at which Cycles 3.4 samples them by area. It samples a
# triangle by solid angle where its longest edge exceeds the distance of its plane divided by twice
# its area. That angle comes from arc cosines with errors of 5e-5 rad, which can lose 1.4 % of the
# light of a distant lamp of 3 m.
EMITTER_EDGE = 0.1  # scene units
STATS = output_guard.json_object("statistics of this program", "render_cpu_s")


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="render_cycles.py", description=__doc__.split("\n")[0])
    parser.add_argument("scene", type=Path)
    parser.add_argument(
        "--output", required=True, help="{bounces} and {seed} in its name are replaced"
    )
    parser.add_argument("--size", help="WIDTHxHEIGHT in pixels; the scene's unless given")
    parser.add_argument("--bounces", default="32", help="limits as our --max-bounces: 0,32")
    parser.add_argument("--seeds", default="1")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--stats", type=Path, help="JSON: CPU seconds of rendering, without import")
    parser.add_argument(
        "--encoded-textures",
        action="store_true",
        help="let Cycles filter the sRGB values, as it does by itself",
    )
    parser.add_argument(
        "--whole-emitters",
        action="store_true",
        help="leave emitting triangles as large as they are: shows Cycles' bias",
    )
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def corner_normals(mesh: source.Mesh) -> tuple[npt.NDArray[Any], bool]:
    """Shading normals, and whether the file has any.

    One smooth face makes Cycles interpolate normals on all faces of a mesh, so flat faces get
    explicit normals.
    """
    missing = np.isnan(mesh.normal).any(axis=(1, 2))
    p = mesh.position
    flat = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    return np.where(missing[:, None, None], flat[:, None, :], mesh.normal), not missing.all()


def make_mesh(mesh: source.Mesh, name: str, encoded: bool) -> None:
    count = len(mesh.position)
    normal, smooth = corner_normals(mesh)
    corners = np.concatenate([mesh.position, normal], axis=2)
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
    made.polygons.foreach_set("use_smooth", np.full(count, smooth))
    uv = made.uv_layers.new(name="uv")
    uv.data.foreach_set("uv", np.nan_to_num(mesh.uv).astype(np.float32).ravel())
    for material in mesh.materials:
        made.materials.append(make_material(material, encoded))
    made.update(calc_edges=True)
    if len(made.polygons) != count:
        raise SceneError(f"{name}: Blender dropped triangles; report this")
    if smooth:
        made.use_auto_smooth = True  # Blender ignores custom normals without it
        made.auto_smooth_angle = math.pi
        made.normals_split_custom_set_from_vertices(vertices[:, 3:].tolist())

    thing = bpy.data.objects.new(name, made)
    # The defaults of both hide the terminator of coarse meshes, but bias the light.
    thing.cycles.shadow_terminator_offset = 0.0
    thing.cycles.shadow_terminator_geometry_offset = 0.0
    bpy.context.scene.collection.objects.link(thing)


def make_camera(camera: source.Camera) -> None:
    made = bpy.data.cameras.new("camera")
    made.sensor_fit = "VERTICAL"
    made.angle_y = math.radians(camera.vertical_fov_deg)
    made.clip_start, made.clip_end = 1e-4, 1e5
    thing = bpy.data.objects.new("camera", made)
    place(thing, camera.right, camera.up, camera.forward, camera.position)
    bpy.context.scene.collection.objects.link(thing)
    bpy.context.scene.camera = thing


def set_film(width: int, height: int, threads: int) -> None:
    render = bpy.context.scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = width, height
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
    """Turns off all settings that reduce noise at the cost of bias."""
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
    # All pixels and seeds share the default tables. With 256 samples of a lamp of 2048 triangles
    # they are off by 0.3 % for any seed, where Sobol-Burley is right to 0.01 %.
    cycles.sampling_pattern = "SOBOL"


def set_bounces(bounces: int) -> None:
    """Limits diffuse vertices, but not mirrors and glass, as --max-bounces does."""
    cycles = bpy.context.scene.cycles
    cycles.diffuse_bounces = bounces
    cycles.max_bounces = cycles.glossy_bounces = cycles.transmission_bounces = 1024
    cycles.transparent_max_bounces = 8
    cycles.min_light_bounces = 0  # Russian roulette starts at once, as in vpl-render


def read(path: Path) -> source.Scene:
    """Reads a scene. A .pbrt is not parsed, but built again from its description."""
    if path.suffix == ".pbrt":
        return model_scenes.source_scene(model_scenes.sphere_in_box(model_cases.SPHERES[path.stem]))
    return source.read_scene(path)


def build(options: argparse.Namespace) -> tuple[int, int]:
    """Makes scene and camera. Returns the size of the film."""
    scene = read(options.scene)
    for number, mesh in enumerate(scene.meshes):
        if not options.whole_emitters:
            mesh = source.split_emitters(mesh, EMITTER_EDGE)
        make_mesh(mesh, f"mesh{number}", options.encoded_textures)
    for number, light in enumerate(scene.lights):
        if light["type"] != "environment":
            make_lamp(light, f"light{number}")
    make_world([x for x in scene.lights if x["type"] == "environment"], options.scene.parent)
    make_camera(scene.camera)
    return scene.width, scene.height


def render(path: Path) -> float:
    """Returns the CPU seconds of all threads."""
    bpy.context.scene.render.filepath = str(path.resolve())
    begin = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - begin


def run() -> None:
    options = parse_arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="cycles")
    if options.scene.suffix == ".glb":
        import_gltf(options.scene)
        make_world([], options.scene.parent)
        film = model_scenes.SIZE
    else:
        film = build(options)
    if options.size:
        width, height = options.size.split("x")
        film = int(width), int(height)
    set_film(*film, options.threads)
    set_unbiased(options.spp)
    cpu_s = 0.0
    for bounces in options.bounces.split(","):
        set_bounces(int(bounces))
        for seed in options.seeds.split(","):
            bpy.context.scene.cycles.seed = int(seed)
            name = options.output.replace("{bounces}", bounces).replace("{seed}", seed)
            cpu_s += output_guard.replace(
                name, output_guard.EXR, render, "--output", {"the scene": options.scene}
            )
    if options.stats:
        text = json.dumps({"render_cpu_s": round(cpu_s, 3)}) + "\n"
        output_guard.write(options.stats, text, STATS)


if __name__ == "__main__":
    try:
        run()
    except (SceneError, output_guard.Refused) as error:
        print(f"render_cycles.py: {error}", file=sys.stderr)
        sys.exit(3)
