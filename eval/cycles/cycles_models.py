"""Turns materials of model_scenes.py into shader nodes of Cycles. Runs inside Blender."""

from __future__ import annotations

import math
from typing import Any

import bpy

from scene_source import SceneError

WHITE = (1.0, 1.0, 1.0)


def _bsdf(tree: bpy.types.NodeTree, kind: str, colour, alpha: float | None = None):
    """A BSDF node. The alpha of Cycles is the square of its roughness. GGX is single-scattering."""
    node = tree.nodes.new("ShaderNodeBsdf" + kind)
    node.inputs["Color"].default_value = (*colour, 1.0)
    node.inputs["Roughness"].default_value = math.sqrt(alpha or 0.0)
    if alpha is not None:
        node.distribution = "GGX"
    return node


def _mix(tree: bpy.types.NodeTree, amount, first, second):
    node = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(amount, node.inputs[0])
    tree.links.new(first, node.inputs[1])
    tree.links.new(second, node.inputs[2])
    return node.outputs[0]


def _coat(tree: bpy.types.NodeTree, data: dict[str, Any]):
    """A coated diffuse surface.

    Over black it is the gloss of the Principled BSDF, with Fresnel's term of the facets. Over a
    colour it is what users of Cycles build: the Fresnel node mixes Glossy and Diffuse.
    """
    if not any(data["reflectance"]):
        node = tree.nodes.new("ShaderNodeBsdfPrincipled")
        node.distribution = "GGX"
        node.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
        node.inputs["Roughness"].default_value = math.sqrt(data["roughness"])
        node.inputs["Specular"].default_value = ((data["eta"] - 1) / (data["eta"] + 1)) ** 2 / 0.08
        return node.outputs[0]
    fresnel = tree.nodes.new("ShaderNodeFresnel")
    fresnel.inputs["IOR"].default_value = data["eta"]
    base = _bsdf(tree, "Diffuse", data["reflectance"])
    gloss = _bsdf(tree, "Glossy", WHITE, data["roughness"])
    return _mix(tree, fresnel.outputs[0], base.outputs[0], gloss.outputs[0])


def model_shader(tree: bpy.types.NodeTree, data: dict[str, Any]):
    kind = data["type"]
    if kind == "diffuse":
        return _bsdf(tree, "Diffuse", data["reflectance"]).outputs[0]
    if kind == "conductor":
        return _bsdf(tree, "Glossy", data["reflectance"], data["roughness"]).outputs[0]
    if kind == "dielectric":
        glass = _bsdf(tree, "Glass", WHITE, data["roughness"])
        glass.inputs["IOR"].default_value = data["eta"]
        return glass.outputs[0]
    if kind == "coateddiffuse":
        return _coat(tree, data)
    raise SceneError(f"material '{kind}' has no counterpart in cycles_models.py; add one")
