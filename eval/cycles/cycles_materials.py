"""Turns MTL materials into shader nodes of Cycles. Runs inside Blender."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np

import scene_source as source
from cycles_models import model_shader
from scene_source import SceneError


def linear_image(path: Path) -> bpy.types.Image:
    """The texture as linear floats.

    Cycles filters 8-bit sRGB images before it decodes them. vpl-render decodes first, as only
    linear values average like light.
    """
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
    """The output of a node with Kd times map_Kd, or None for a plain colour."""
    if material.map_kd is None:
        return None
    if not material.map_kd.is_file():
        raise SceneError(f"{material.map_kd}: no such texture; supply it")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = (
        bpy.data.images.load(str(material.map_kd)) if encoded else linear_image(material.map_kd)
    )
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
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")  # Lambert where the roughness is 0
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
    """Emits radiance Ke, from the front by the winding only, unless the material is two-sided."""
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
    shader = (
        model_shader(tree, material.model)
        if material.model
        else reflection_shader(tree, material, encoded)
    )
    if any(material.ke):
        shader = add_shaders(tree, shader, emission_shader(tree, material))
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader, output.inputs["Surface"])
    return made
