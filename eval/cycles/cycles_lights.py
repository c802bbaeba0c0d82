"""Turns lights of a scene.toml into lamps and world of Cycles. Runs inside Blender."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

import scene_source as source
from scene_source import SceneError


def place(thing: bpy.types.Object, right, up, forward, position) -> None:
    """Places a camera or lamp, which in Blender looks along its own -z."""
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = right, up, -np.asarray(forward)
    matrix[:3, 3] = position
    thing.matrix_world = Matrix(matrix.tolist())


def make_lamp(light: dict[str, Any], name: str) -> None:
    kinds = {"point": "POINT", "spot": "SPOT", "directional": "SUN"}
    lamp = bpy.data.lights.new(name, kinds[light["type"]])
    colour = light["irradiance" if light["type"] == "directional" else "intensity"]
    peak = max(colour) or 1.0
    lamp.color = [c / peak for c in colour]
    thing = bpy.data.objects.new(name, lamp)
    if light["type"] == "directional":
        lamp.energy = peak  # irradiance in W/m2 of a facing surface
        lamp.angle = math.radians(light.get("angular_diameter_deg", 0.0))
    else:
        # The unit is W over the whole sphere, even for a cone. scene.toml has W/sr.
        lamp.energy = peak * 4.0 * math.pi
        lamp.shadow_soft_size = 0.0
    if light["type"] == "spot":
        outer = math.radians(light["cone_deg"])
        inner = outer - math.radians(light.get("falloff_deg", 0.0))
        lamp.spot_size = 2.0 * outer
        lamp.spot_blend = (math.cos(inner) - math.cos(outer)) / (1.0 - math.cos(outer))
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
    """Divides by the cosine to the axis, by which Cycles dims spots. Ours are uniform."""
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


def make_world(lights: list[dict[str, Any]], scene_folder: Path) -> None:
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


def environment_image(tree: bpy.types.NodeTree, light: dict[str, Any], folder: Path):
    """Maps our image to that of Cycles, without interpolation.

    Ours has -z at its centre, +x to the right, and +y up. That of Cycles has +x at its centre, -y
    to the right, and +z up.
    """
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
