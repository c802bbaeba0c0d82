"""Writes a model_scenes.Sketch as .glb, for our reader and for Blender's own importer."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import model_scenes as scenes
import scene_source as source
from outputs import GLB, MAKER, output_guard

FLOAT = 5126


class Bytes:
    """The binary chunk, with views and accessors into it."""

    def __init__(self) -> None:
        self.data = b""
        self.views: list[dict[str, int]] = []
        self.accessors: list[dict[str, Any]] = []

    def view(self, data: bytes) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.views) - 1

    def accessor(self, values: npt.NDArray[Any]) -> int:
        rows = np.ascontiguousarray(values.reshape(-1, values.shape[-1]), "<f4")
        self.accessors.append(
            {
                "bufferView": self.view(rows.tobytes()),
                "componentType": FLOAT,
                "count": len(rows),
                "type": f"VEC{rows.shape[1]}",
                "min": rows.min(0).tolist(),
                "max": rows.max(0).tolist(),
            }
        )
        return len(self.accessors) - 1


def png(pixels: npt.NDArray[Any]) -> bytes:
    """Bytes of a PNG file of 8-bit RGB, with rows from the top."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    height, width = pixels.shape[:2]
    rows = b"".join(b"\0" + row.astype(np.uint8).tobytes() for row in pixels)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )


def material(name: str, data: dict[str, Any]) -> dict[str, Any]:
    """A material of glTF. Diffuse ones are Lambert, as KHR_materials_specular removes the gloss."""
    if data["type"] == "metallicroughness":
        pbr = {
            "baseColorFactor": [*data["reflectance"], 1.0],
            "metallicFactor": data["metallic"],
            "roughnessFactor": data["roughness"],
        }
        return {"name": name, "pbrMetallicRoughness": pbr}
    made: dict[str, Any] = {
        "name": name,
        "extensions": {"KHR_materials_specular": {"specularFactor": 0.0}},
        "pbrMetallicRoughness": {
            "baseColorFactor": [*data["reflectance"], 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
    }
    if "radiance" in data:  # both sides emit, as Blender's importer supports no one-sided lamps
        peak = max(data["radiance"])
        made["emissiveFactor"] = [c / peak for c in data["radiance"]]
        made["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": peak}
        made["doubleSided"] = True
    if "normal" in data:
        made["normalTexture"] = {"index": 0}
    return made


def camera_node() -> dict[str, Any]:
    camera = source.read_camera(scenes.CAMERA)
    matrix = np.eye(4)
    matrix[:3] = np.stack([camera.right, camera.up, -camera.forward, camera.position], 1)
    return {"camera": 0, "matrix": matrix.T.ravel().tolist()}  # in column-major order


def write(path: Path, sketch: scenes.Sketch) -> None:
    chunk, names = Bytes(), list(sketch.materials)
    meshes = []
    for part in sketch.parts:
        attributes = {"POSITION": chunk.accessor(part.position)}
        for key, values in (("NORMAL", part.normal), ("TEXCOORD_0", part.uv)):
            if values is not None:
                attributes[key] = chunk.accessor(values)
        meshes.append(
            {"primitives": [{"attributes": attributes, "material": names.index(part.material)}]}
        )
    nodes = [camera_node()] + [{"mesh": n} for n in range(len(meshes) - bool(sketch.nodes))]
    # All nodes of the sketch are instances of the last part.
    nodes += [node | {"mesh": len(meshes) - 1} for node in sketch.nodes]
    fov = np.radians(scenes.CAMERA["vertical_fov_deg"])
    whole: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": MAKER},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"],
        "cameras": [
            {
                "type": "perspective",
                "perspective": {"aspectRatio": 1.0, "yfov": float(fov), "znear": 1e-4},
            }
        ],
        "nodes": nodes,
        "meshes": meshes,
        "materials": [material(name, data) for name, data in sketch.materials.items()],
    }
    images = [data["normal"] for data in sketch.materials.values() if "normal" in data]
    if images:
        whole |= {
            "images": [{"bufferView": chunk.view(png(images[0])), "mimeType": "image/png"}],
            "textures": [{"source": 0}],
        }
    whole |= {
        "bufferViews": chunk.views,
        "accessors": chunk.accessors,
        "buffers": [{"byteLength": len(chunk.data)}],
    }
    text = json.dumps(whole).encode()
    text += b" " * (-len(text) % 4)
    data = chunk.data + b"\0" * (-len(chunk.data) % 4)
    output_guard.write(
        path,
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data))
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(data), b"BIN\0")
        + data,
        GLB,
    )
