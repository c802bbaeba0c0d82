"""A .glb in Blender, by Blender's own importer. Runs inside Blender."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np


def _replace(tree: bpy.types.NodeTree, old: bpy.types.Node, kind: str) -> bpy.types.Node:
    """A plain node in place of the Principled BSDF, with its colour and normal."""
    node = tree.nodes.new(kind)
    node.inputs["Color"].default_value = old.inputs["Base Color"].default_value
    for link in old.inputs["Normal"].links if "Normal" in node.inputs else ():
        tree.links.new(link.from_socket, node.inputs["Normal"])
    for link in list(old.outputs["BSDF"].links):
        tree.links.new(node.outputs[0], link.to_socket)
    tree.nodes.remove(old)
    return node


def _plain(tree: bpy.types.NodeTree) -> None:
    """Lambert and lamps have exact counterparts; the Principled BSDF would be another model. In
    gltf_file.py, what is of roughness 1 and no metal is Lambert by KHR_materials_specular, whose
    factor of 0 Blender's importer keeps to itself."""
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
    np.bool = bool  # Debian's importer takes it from NumPy, which has dropped it
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
