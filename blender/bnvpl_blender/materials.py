# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials of one plain shader, which the glTF exporter does not know, as [[material]]."""

from __future__ import annotations

import json
import struct
from pathlib import Path

from .toml_text import Section

# The child gives this name to surfaces without a material; Blender shows them in the same grey.
DEFAULT_MATERIAL = "bnvpl default"
DEFAULT_SECTION: Section = {
    "name": DEFAULT_MATERIAL,
    "model": "diffuse",
    "reflectance": [0.8, 0.8, 0.8],
}
EXPORTED = ("BSDF_PRINCIPLED",)


def active_output(tree, kind: str):
    """The node that counts of a tree's outputs of this kind."""
    outputs = [node for node in tree.nodes if node.type == kind]
    return next((node for node in outputs if node.is_active_output), None)


def surface_node(tree, kind: str = "OUTPUT_MATERIAL"):
    """The node at the active output's Surface, behind reroutes; None where there is none."""
    output = active_output(tree, kind) if tree else None
    socket = output.inputs.get("Surface") if output else None
    while socket is not None and socket.is_linked:
        node = socket.links[0].from_node
        if node.type != "REROUTE":
            return node
        socket = node.inputs[0]
    return None


def _colour(node, socket: str = "Color") -> list[float]:
    return list(node.inputs[socket].default_value)[:3]


def _diffuse(node) -> Section:
    return {"model": "diffuse", "reflectance": _colour(node)}


def _roughness(node) -> Section:
    rough = node.inputs["Roughness"].default_value
    return {"roughness_along": rough, "roughness_across": rough, "roughness_to_alpha": "square"}


def _glossy(node) -> Section:
    colour = {"model": "conductor", "by_reflectance": True, "reflectance": _colour(node)}
    return colour | _roughness(node)


def _glass(node) -> Section:
    tint = _colour(node)
    ior = node.inputs["IOR"].default_value
    section: Section = {"model": "dielectric", "ior": ior, "reflection": tint}
    return section | {"transmission": tint} | _roughness(node)


def _emission(node) -> Section:
    strength = node.inputs["Strength"].default_value
    emission = [c * strength for c in _colour(node)]
    black = {"model": "diffuse", "reflectance": [0.0, 0.0, 0.0]}
    return black | {"emission": emission, "emission_sides": 2}


SHADERS = {
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLOSSY": _glossy,
    "BSDF_GLASS": _glass,
    "EMISSION": _emission,
}


def material_sections(materials, warnings: list[str]) -> list[tuple[str, Section]]:
    """Sections of the materials that consist of one shader without textures.

    What the exporter does not know, and no section states, is told in the warnings.
    """
    sections: list[tuple[str, Section]] = []
    for material in materials:
        if not material.use_nodes:
            continue
        node = surface_node(material.node_tree)
        if node is None or node.type in EXPORTED:
            continue
        linked = any(socket.is_linked for socket in node.inputs if socket.name != "Normal")
        if node.type in SHADERS and not linked:
            section = {"name": material.name} | SHADERS[node.type](node)
            sections.append(("[[material]]", section))
        else:
            warnings.append(
                f"material '{material.name}': '{node.name}' is exported approximately; "
                "use Principled BSDF"
            )
    return sections


def exported_names(glb: Path) -> set[str]:
    """Names of the materials in a .glb, whose first chunk is JSON."""
    with glb.open("rb") as file:
        size, _ = struct.unpack("<4x4x4xI4s", file.read(20))
        document = json.loads(file.read(size))
    return {material.get("name", "") for material in document.get("materials", [])}
