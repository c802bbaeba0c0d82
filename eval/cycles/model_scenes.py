"""Describes the test scene of material models, a box with a lamp and a sphere, as plain data.

One description becomes pbrt text for our reader, arrays for Cycles, and the scene of walk.py.
Colours are linear; lengths have no unit.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

import scene_source as source

GREY, RED, GREEN = (0.7, 0.7, 0.7), (0.7, 0.15, 0.1), (0.15, 0.6, 0.2)
RADIANCE = (6.0, 5.0, 4.0)
LAMP_Y, LAMP_HALF, LAMP_CELLS = 0.999, 0.5, 10  # small cells: see EMITTER_EDGE in render_cycles.py
CENTRE, RADIUS = (0.1, -0.25, -0.2), 0.55
CAMERA: dict[str, Any] = {
    "position": [0.0, 0.0, 0.98],
    "look_at": [0.1, -0.2, -0.2],
    "vertical_fov_deg": 75.0,
}
SIZE = (96, 96)


Point = Sequence[float]


@dataclass
class Part:
    """Triangles of one material, anti-clockwise seen from outside."""

    material: str
    position: npt.NDArray[Any]  # shape (n, 3, 3): triangle, corner, xyz
    normal: npt.NDArray[Any] | None = None  # same shape, or None for flat shading
    uv: npt.NDArray[Any] | None = None  # shape (n, 3, 2)


@dataclass
class Sketch:
    """A scene. `materials` maps names to {"type": a type of pbrt, and its parameters}."""

    materials: dict[str, dict[str, Any]]
    parts: list[Part] = field(default_factory=list)
    # Nodes of glTF, which are instances of the last part.
    nodes: list[dict[str, Any]] = field(default_factory=list)


def quad(
    a: Point, b: Point, c: Point, d: Point, cells: int = 1
) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Positions and uv of the parallelogram a b c d, divided into cells x cells pieces."""
    origin, ab, ad = np.array(a, float), np.subtract(b, a), np.subtract(d, a)
    assert np.allclose(origin + ab + ad, c)
    i, j = (g.ravel() / cells for g in np.mgrid[0:cells, 0:cells])
    step = 1.0 / cells
    corner = [
        np.stack([i + x * step, j + y * step], 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))
    ]
    uv = np.concatenate([np.stack([corner[k] for k in t], 1) for t in ((0, 1, 2), (0, 2, 3))])
    return origin + uv[..., :1] * ab + uv[..., 1:] * ad, uv


def sphere(
    centre: Point, radius: float, around: int = 96
) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Positions and normals of a sphere."""
    phi, theta = np.meshgrid(
        np.linspace(0, 2 * np.pi, around + 1), np.linspace(0, np.pi, around // 2 + 1)
    )
    n = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), -np.sin(theta) * np.sin(phi)], -1)
    a, b, c, d = n[1:, :-1], n[1:, 1:], n[:-1, 1:], n[:-1, :-1]
    upper = np.stack([a, c, d], 2)[1:].reshape(-1, 3, 3)  # none at the north pole
    lower = np.stack([a, b, c], 2)[:-1].reshape(-1, 3, 3)
    normal = np.concatenate([upper, lower])
    return np.array(centre) + radius * normal, normal


def box_parts() -> list[Part]:
    """Walls and lamp of the box, with the fronts inside."""
    p, m = 1.0, -1.0
    h, y = LAMP_HALF, LAMP_Y
    walls = {
        "floor": ((m, m, p), (p, m, p), (p, m, m), (m, m, m)),
        "ceiling": ((m, p, m), (p, p, m), (p, p, p), (m, p, p)),
        "back": ((m, m, m), (p, m, m), (p, p, m), (m, p, m)),
        "front": ((p, m, p), (m, m, p), (m, p, p), (p, p, p)),
        "left": ((m, m, p), (m, m, m), (m, p, m), (m, p, p)),
        "right": ((p, m, m), (p, m, p), (p, p, p), (p, p, m)),
    }
    parts = []
    for name, corners in walls.items():
        position, uv = quad(*corners)
        parts.append(Part(name, position, None, uv))
    position, uv = quad((-h, y, -h), (h, y, -h), (h, y, h), (-h, y, h), LAMP_CELLS)
    return parts + [Part("lamp", position, None, uv)]


def box_materials() -> dict[str, dict[str, Any]]:
    colours = {
        "floor": GREY,
        "ceiling": GREY,
        "back": GREY,
        "front": GREY,
        "left": RED,
        "right": GREEN,
    }
    materials = {name: {"type": "diffuse", "reflectance": c} for name, c in colours.items()}
    black = (0.0, 0.0, 0.0)
    return materials | {"lamp": {"type": "diffuse", "reflectance": black, "radiance": RADIANCE}}


def sphere_in_box(material: dict[str, Any]) -> Sketch:
    position, normal = sphere(CENTRE, RADIUS)
    return Sketch(
        box_materials() | {"sphere": material}, [*box_parts(), Part("sphere", position, normal)]
    )


def mapped_normal(u: npt.NDArray[Any], v: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Normals of waves without symmetry, which tilt by up to 24 degrees. v points down."""
    x, y = 2 * np.pi * u, 2 * np.pi * v
    normal = np.stack(
        [0.3 * np.sin(x) + 0.1 * np.sin(3 * y), 0.2 * np.cos(2 * y + x), np.ones_like(x)], -1
    )
    result: npt.NDArray[Any] = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return result


def mapped_box() -> Sketch:
    """The box with a normal map on floor and back wall."""
    v, u = (np.mgrid[0:64, 0:64] + 0.5) / 64
    pixels = np.rint((mapped_normal(u, v) + 1) / 2 * 255)
    materials = box_materials()
    for name in ("floor", "back"):
        materials[name] = {"type": "diffuse", "reflectance": GREY, "normal": pixels}
    return Sketch(materials, box_parts())


def instances_in_box(count: int = 24) -> Sketch:
    """The box with instances of a wedge, rotated and scaled; every other one is mirrored."""
    random = np.random.default_rng(5)
    a, b, c = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.6, 0.0)
    tip = (0.2, 0.1, 0.8)
    wedge = np.array([(a, c, b), (a, b, tip), (b, c, tip), (c, a, tip)])
    nodes = []
    for number in range(count):
        turn = random.normal(size=4)
        size = random.uniform(0.2, 0.6, 3) * ((-1.0 if number % 2 else 1.0), 1.0, 1.0)
        nodes.append(
            {
                "translation": random.uniform((-0.7, -0.9, -0.8), (0.4, 0.3, 0.1)).tolist(),
                "rotation": (turn / np.linalg.norm(turn)).tolist(),
                "scale": size.tolist(),
            }
        )
    materials = box_materials() | {"wedge": {"type": "diffuse", "reflectance": (0.8, 0.7, 0.3)}}
    return Sketch(materials, [*box_parts(), Part("wedge", wedge)], nodes)


def room_with_windows() -> Sketch:
    """The box without a lamp, with two windows on the left and one behind the camera."""
    p, m = 1.0, -1.0
    parts = [part for part in box_parts() if part.material not in ("lamp", "left", "front")]

    def wall(
        material: str,
        plane: Callable[[float, float], Point],
        cuts_u: Sequence[float],
        cuts_v: Sequence[float],
        holes: Collection[tuple[int, int]],
    ) -> None:
        for i in range(len(cuts_u) - 1):
            for j in range(len(cuts_v) - 1):
                if (i, j) not in holes:
                    (a, b), (c, d) = cuts_u[i : i + 2], cuts_v[j : j + 2]
                    corners = (plane(a, c), plane(b, c), plane(b, d), plane(a, d))
                    parts.append(Part(material, *quad(*corners)[:1]))

    wall(
        "left",
        lambda u, v: (m, v, -u),
        (m, -0.6, -0.3, 0.1, 0.7, p),
        (m, -0.3, 0.0, 0.6, p),
        {(1, 2), (3, 1), (3, 2)},
    )
    wall("front", lambda u, v: (-u, v, p), (m, 0.2, 0.8, p), (m, 0.1, 0.7, p), {(1, 1)})
    materials = {k: v for k, v in box_materials().items() if k != "lamp"}
    return Sketch(materials, parts)


def obj_text(sketch: Sketch) -> str:
    """OBJ text without normals and texture coordinates. usemtl names the material of each part."""
    lines: list[str] = []
    count = 0
    for part in sketch.parts:
        lines.append(f"usemtl {part.material}")
        lines += [
            "v " + " ".join(f"{x:.9g}" for x in corner) for corner in part.position.reshape(-1, 3)
        ]
        lines += [
            f"f {count + k + 1} {count + k + 2} {count + k + 3}"
            for k in range(0, 3 * len(part.position), 3)
        ]
        count += 3 * len(part.position)
    return "\n".join(lines) + "\n"


def mtl_text(sketch: Sketch) -> str:
    return "".join(
        f"newmtl {name}\nKd {' '.join(map(str, data['reflectance']))}\n"
        for name, data in sketch.materials.items()
    )


def source_scene(sketch: Sketch) -> source.Scene:
    """The scene in the form that render_cycles.py uses."""
    meshes = []
    for part in sketch.parts:
        data = sketch.materials[part.material]
        material = source.Material(
            part.material,
            kd=data.get("reflectance", (0, 0, 0)),
            ke=data.get("radiance", (0, 0, 0)),
            model=data,
        )
        n = len(part.position)
        normal = np.full((n, 3, 3), np.nan) if part.normal is None else part.normal
        uv = np.full((n, 3, 2), np.nan) if part.uv is None else part.uv
        meshes.append(source.Mesh(part.position, normal, uv, np.zeros(n, int), [material]))
    return source.Scene(*SIZE, source.read_camera(CAMERA), meshes, [])


def _numbers(values: npt.ArrayLike) -> str:
    return "[" + " ".join(f"{x:.9g}" for x in np.ravel(values)) + "]"


def _pbrt_material(data: dict[str, Any]) -> str:
    kinds = {"reflectance": "rgb", "roughness": "float", "eta": "float"}
    words = [f'Material "{data["type"]}"']
    words += [
        f'"{kinds[key]} {key}" {_numbers(value)}' for key, value in data.items() if key in kinds
    ]
    if "roughness" in data:
        words.append('"bool remaproughness" false')
    if data["type"].startswith("coated"):
        words.append('"float thickness" 0')  # coats of Cycles do not absorb
    return " ".join(words)


def pbrt_text(sketch: Sketch) -> str:
    """pbrt text. pbrt is left-handed; Scale -1 1 1 before LookAt keeps the picture unmirrored."""
    eye, at = CAMERA["position"], CAMERA["look_at"]
    lines = [
        "Scale -1 1 1",
        "LookAt " + " ".join(map(str, [*eye, *at, 0, 1, 0])),
        f'Camera "perspective" "float fov" {CAMERA["vertical_fov_deg"]}',
        f'Film "rgb" "integer xresolution" {SIZE[0]} "integer yresolution" {SIZE[1]}',
        "WorldBegin",
    ]
    for part in sketch.parts:
        data = sketch.materials[part.material]
        lines += ["AttributeBegin", _pbrt_material(data)]
        if "radiance" in data:
            lines.append(f'AreaLightSource "diffuse" "rgb L" {_numbers(data["radiance"])}')
        indices = np.arange(3 * len(part.position))
        shape = f'Shape "trianglemesh" "integer indices" {_numbers(indices)}'
        shape += f'\n  "point3 P" {_numbers(part.position)}'
        if part.normal is not None:
            shape += f'\n  "normal N" {_numbers(part.normal)}'
        lines += [shape, "AttributeEnd"]
    return "\n".join(lines) + "\n"
