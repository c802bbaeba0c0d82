# SPDX-License-Identifier: GPL-3.0-or-later
"""What scene.toml says of a scene in Blender: film, camera, lamps, world, plain materials."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from .lamps import (
    Lamp,
    Lens,
    area_share,
    camera_section,
    light_section,
    pixel_at,
    pixels_of,
    viewport_projection,
)
from .materials import DEFAULT_MATERIAL, DEFAULT_SECTION, material_sections, surface_node
from .toml_text import Section, scene_text


class SceneError(RuntimeError):
    """The scene has something that cannot be rendered."""


@dataclass
class SceneData:
    """Sections of the file, whether the world needs an image, and what was left out."""

    sections: list[tuple[str, Section]] = field(default_factory=list)
    bakes_world: bool = False
    warnings: list[str] = field(default_factory=list)

    def add_materials(self, names: set[str]) -> None:
        """Adds the sections of those materials that were exported."""
        exported = [material for material in bpy.data.materials if material.name in names]
        self.sections += material_sections(exported, self.warnings)
        if DEFAULT_MATERIAL in names:
            self.sections.append(("[[material]]", DEFAULT_SECTION))

    def text(self) -> str:
        return scene_text(self.sections)


def film_size(scene) -> tuple[int, int]:
    render = scene.render
    percentage = render.resolution_percentage
    return pixels_of(render.resolution_x, percentage), pixels_of(render.resolution_y, percentage)


def render_region(scene) -> tuple[int, int, int, int]:
    """Left, right, bottom and top of the pixels that Blender takes; all without a region."""
    width, height = film_size(scene)
    render = scene.render
    if not render.use_border:
        return 0, width, 0, height
    columns = [pixel_at(share, width) for share in (render.border_min_x, render.border_max_x)]
    rows = [pixel_at(share, height) for share in (render.border_min_y, render.border_max_y)]
    return (*columns, *rows)


def _matrix(matrix) -> list[list[float]]:
    return [list(row) for row in matrix]


def _viewport_section(width: int, height: int) -> Section | None:
    """The first 3D viewport of the windows; None where it looks through the camera."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type != "VIEW_3D":
                continue
            space = area.spaces.active
            view = space.region_3d
            if view.view_perspective == "CAMERA":
                return None
            if view.view_perspective == "ORTHO":
                raise SceneError("the viewport is orthographic; choose a perspective view")
            projection = viewport_projection(space.lens, width, height)
            placed = _matrix(view.view_matrix.inverted())
            return camera_section(placed, projection, width / height, Lens())
    raise SceneError("no window shows a 3D viewport")


def _focus_distance(camera, depsgraph) -> float:
    """Distance along the camera's axis to the object in focus, or the number of the settings."""
    target = camera.data.dof.focus_object
    if target is None:
        return camera.data.dof.focus_distance
    placed = target.evaluated_get(depsgraph).matrix_world.translation
    return abs((camera.matrix_world.normalized().inverted() @ placed).z)


def _camera_section(depsgraph, width: int, height: int) -> Section:
    scene = depsgraph.scene
    if scene.camera is None:
        raise SceneError("the scene has no camera")
    camera = scene.camera.evaluated_get(depsgraph)
    data = camera.data
    if data.type != "PERSP":
        raise SceneError(f"camera '{camera.name}' is not perspective; change its type")
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        raise SceneError("pixels are not square; set both aspects of the format to 1")
    projection = camera.calc_matrix_camera(depsgraph, x=width, y=height)
    lens = Lens()
    if data.dof.use_dof:
        radius = data.lens * 1e-3 / (2 * data.dof.aperture_fstop)
        lens = Lens(radius, max(_focus_distance(camera, depsgraph), 1e-5))
    placed = _matrix(camera.matrix_world.normalized())
    return camera_section(placed, _matrix(projection), width / height, lens)


def _emission(light, told: SceneData) -> tuple[list[float], float]:
    """Colour and strength that a lamp's nodes multiply its own by."""
    node = surface_node(light.node_tree, "OUTPUT_LIGHT") if light.use_nodes else None
    if node is None:
        return [1.0, 1.0, 1.0], 1.0
    if node.type != "EMISSION" or any(node.inputs[i].is_linked for i in (0, 1)):
        told.warnings.append(f"lamp '{light.name}': its nodes are ignored")
        return [1.0, 1.0, 1.0], 1.0
    return list(node.inputs[0].default_value)[:3], node.inputs[1].default_value


def lamp_of(instance, told: SceneData) -> Lamp:
    light = instance.object.data
    tint, strength = _emission(light, told)
    strength *= light.energy * 2.0 ** getattr(light, "exposure", 0.0)
    if getattr(light, "use_temperature", False):
        tint = [a * b for a, b in zip(tint, light.temperature_color, strict=True)]
    area = light.type == "AREA"
    if area and getattr(light, "spread", 3.2) < 3.14:
        told.warnings.append(f"lamp '{light.name}': its spread is ignored")
    if area and light.shape == "ELLIPSE":
        told.warnings.append(f"lamp '{light.name}': the ellipse becomes a rectangle")
    if area:
        strength *= area_share(bpy.app.version)
    return Lamp(
        name=instance.object.name,
        type=light.type,
        matrix=_matrix(instance.matrix_world),
        power=[c * t * strength for c, t in zip(light.color, tint, strict=True)],
        radius=light.shadow_soft_size if light.type == "POINT" else 0.0,
        angle=light.angle if light.type == "SUN" else 0.0,
        spot_size=light.spot_size if light.type == "SPOT" else 0.0,
        spot_blend=light.spot_blend if light.type == "SPOT" else 0.0,
        shape=light.shape if area else "SQUARE",
        size=light.size if area else 0.0,
        size_y=light.size_y if area else 0.0,
    )


def _world_sections(world, told: SceneData) -> None:
    """A world of one colour is a constant; any other is rendered to an image by the child."""
    if world is None:
        return
    section: Section = {"name": world.name, "type": "environment"}
    node = surface_node(world.node_tree, "OUTPUT_WORLD") if world.use_nodes else None
    if not world.use_nodes:
        section["radiance"] = list(world.color)
    elif node is None:
        return
    elif node.type == "BACKGROUND" and not any(node.inputs[i].is_linked for i in (0, 1)):
        strength = node.inputs[1].default_value
        section["radiance"] = [c * strength for c in list(node.inputs[0].default_value)[:3]]
    else:
        told.bakes_world = True
        section["image"] = "world.exr"
        if any(n.type == "LIGHT_PATH" for n in world.node_tree.nodes):
            told.warnings.append(f"world '{world.name}': the camera sees what lights the scene")
    if section.get("radiance") != [0.0, 0.0, 0.0]:
        told.sections.append(("[[light]]", section))


def scene_data(depsgraph) -> SceneData:
    scene = depsgraph.scene
    width, height = film_size(scene)
    told = SceneData()
    camera = _viewport_section(width, height) if scene.bnvpl.view == "VIEWPORT" else None
    told.sections = [
        ("[film]", {"width": width, "height": height}),
        ("[camera]", camera or _camera_section(depsgraph, width, height)),
        ("[[mesh]]", {"file": "scene.glb"}),
    ]
    for instance in depsgraph.object_instances:
        if instance.object.type == "LIGHT":
            told.sections.append(("[[light]]", light_section(lamp_of(instance, told))))
    _world_sections(scene.world, told)
    return told
