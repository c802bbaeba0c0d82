"""Reads a .glb by Blender's own importer. Runs inside Blender."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np


def _replace(tree: bpy.types.NodeTree, old: bpy.types.Node, kind: str) -> bpy.types.Node:
    """Replaces the Principled BSDF by a plain node with its colour and normal."""
    node = tree.nodes.new(kind)
    node.inputs["Color"].default_value = old.inputs["Base Color"].default_value
    for link in old.inputs["Normal"].links if "Normal" in node.inputs else ():
        tree.links.new(link.from_socket, node.inputs["Normal"])
    for link in list(old.outputs["BSDF"].links):
        tree.links.new(node.outputs[0], link.to_socket)
    tree.nodes.remove(old)
    return node


def _plain(tree: bpy.types.NodeTree) -> None:
    """Replaces the Principled BSDF by exact counterparts of Lambert and of lamps.

    Materials of gltf_file.py with roughness 1 and without metal are Lambert, as a specularFactor of
    0 in KHR_materials_specular says, which Blender's importer ignores.
    """
    for old in [n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"]:
        glow = [
            c * old.inputs["Emission Strength"].default_value
            for c in old.inputs["Emission"].default_value[:3]
        ]
        if any(glow):
            node = _replace(tree, old, "ShaderNodeEmission")
            node.inputs["Color"].default_value = (*glow, 1.0)
            node.inputs["Strength"].default_value = 1.0
        elif [old.inputs[key].default_value for key in ("Roughness", "Metallic")] == [1, 0]:
            _replace(tree, old, "ShaderNodeBsdfDiffuse").inputs["Roughness"].default_value = 0.0


def import_gltf(path: Path) -> None:
    setattr(np, "bool", bool)  # noqa: B010  # Debian's importer uses this alias, which NumPy lacks
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.import_scene.gltf(filepath=str(path), import_pack_images=True)
    for material in bpy.data.materials:
        _plain(material.node_tree)
    for thing in bpy.data.objects:
        if thing.type == "MESH":
            thing.cycles.shadow_terminator_offset = 0.0
            thing.cycles.shadow_terminator_geometry_offset = 0.0
        elif thing.type == "CAMERA":
            bpy.context.scene.camera = thing
