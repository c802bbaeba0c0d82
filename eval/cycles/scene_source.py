"""Reads scene.toml, OBJ and MTL into NumPy arrays, without any code of the renderer under test.

It reads the subset of docs/scene-format.md that the cross-check needs, and refuses the rest by
name. A feature that only one renderer supports would look like an error. cross_check.py uses it,
and render_cycles.py inside Blender.
"""

from __future__ import annotations

import os
import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt


class SceneError(Exception):
    """Bad input. The message is one line with file, problem and cure."""


@dataclass
class Material:
    name: str
    kd: tuple[float, float, float] = (0.6, 0.6, 0.6)
    ks: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ke: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tf: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ior: float = 1.5
    illum: int = 0
    opacity: float = 1.0
    map_kd: Path | None = None
    two_sided: bool = False
    # Other maps, which are refused if a face uses them.
    maps: list[str] = field(default_factory=list)
    physical: list[str] = field(default_factory=list)  # lines of the physical model, likewise
    # Parameters of model_scenes.py, which replace the MTL fields.
    model: dict[str, Any] = field(default_factory=dict)

    @property
    def mirror(self) -> bool:
        return self.illum in (3, 5, 8)

    @property
    def glass(self) -> bool:
        return self.illum in (4, 6, 7, 9)


@dataclass
class Mesh:
    """Triangles of an OBJ file. `normal` and `uv` are NaN where the file has none."""

    position: npt.NDArray[Any]  # float64 of shape (n, 3, 3): triangle, corner, xyz
    normal: npt.NDArray[Any]  # shape (n, 3, 3)
    uv: npt.NDArray[Any]  # shape (n, 3, 2)
    material: npt.NDArray[Any]  # int of shape (n): indices into `materials`
    materials: list[Material]


@dataclass
class Camera:
    position: npt.NDArray[Any]
    right: npt.NDArray[Any]
    up: npt.NDArray[Any]
    forward: npt.NDArray[Any]
    vertical_fov_deg: float


@dataclass
class Scene:
    width: int
    height: int
    camera: Camera
    meshes: list[Mesh]
    lights: list[dict[str, Any]]


def read_toml(path: Path) -> dict[str, Any]:
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except OSError as error:
        raise SceneError(f"{path}: {error.strerror}; name a scene.toml") from error
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{path}: {error}") from error


def resolve(scene: Path, name: str) -> Path:
    """Path of a file that a scene.toml names, with ${NAME} replaced from the environment."""

    def value(match: re.Match[str]) -> str:
        if match[1] not in os.environ:
            raise SceneError(f"{scene}: ${{{match[1]}}} is not set; set the environment variable")
        return os.environ[match[1]]

    return (scene.parent / re.sub(r"\$\{(\w+)\}", value, name)).resolve()


def _unit(v: npt.NDArray[Any]) -> npt.NDArray[Any]:
    result: npt.NDArray[Any] = v / np.linalg.norm(v)
    return result


def read_camera(table: dict[str, Any]) -> Camera:
    position = np.array(table["position"], float)
    if "forward" in table:
        forward = _unit(np.array(table["forward"], float))
    else:
        forward = _unit(np.array(table["look_at"], float) - position)
    right = _unit(np.cross(forward, np.array(table.get("up", [0, 1, 0]), float)))
    up = np.cross(right, forward)
    return Camera(position, right, up, forward, float(table["vertical_fov_deg"]))


def read_transform(table: dict[str, Any]) -> npt.NDArray[Any]:
    """4x4 matrix: `transform`, or scale, then rotations about x, y, z, then translation."""
    if "transform" in table:
        return np.array(table["transform"], float)
    turn = np.eye(3)
    for axis, degrees in enumerate(table.get("rotate_deg", [0, 0, 0])):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        one = np.eye(3)
        one[i, i] = one[j, j] = np.cos(np.radians(degrees))
        one[j, i] = np.sin(np.radians(degrees))
        one[i, j] = -one[j, i]
        turn = one @ turn
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ np.diag(np.broadcast_to(np.array(table.get("scale", 1.0), float), 3))
    matrix[:3, 3] = table.get("translate", [0, 0, 0])
    return matrix


def read_mtl(path: Path, obj: Path) -> dict[str, Material]:
    materials: dict[str, Material] = {}
    current = Material("")
    try:
        text = path.read_text()
    except OSError as error:
        raise SceneError(f"{path}: {error.strerror}; name an MTL file") from error
    for line in text.splitlines():
        key, *rest = line.split() or ["#"]
        if key == "newmtl":
            current = materials[rest[0]] = Material(rest[0])
        elif key in ("Kd", "Ks", "Ke", "Tf"):
            setattr(current, key.lower(), tuple(float(x) for x in rest[:3]))
        elif key == "illum":
            current.illum = int(rest[0])
        elif key == "Ni":
            current.ior = float(rest[0])
        elif key == "d":
            current.opacity = float(rest[0])
        elif key == "emission_sides":
            current.two_sided = rest[0] == "2"
        elif key == "map_Kd" and len(rest) == 1:
            beside = path.parent / rest[0]
            current.map_kd = beside if beside.is_file() else obj.parent / rest[0]
        elif key.lower().startswith("map_") or key in ("bump", "norm", "disp", "refl"):
            current.maps.append(line.strip())
        elif key in ("Pr", "Pm", "Pc", "aniso"):
            current.physical.append(line.strip())
    return materials


def check_supported(material: Material, path: Path) -> None:
    """Refuses a material that has no exact counterpart in Cycles."""
    problem = ""
    if material.glass:  # black means white in both fields
        if any(c not in ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0)) for c in (material.ks, material.tf)):
            problem = "is coloured glass"
        elif material.ior < 1.0:  # vpl-render warns and uses 1.5
            problem = "has a refractive index below 1 (Ni)"
    elif any(material.ks) and not material.mirror:
        problem = "has a Phong lobe (Ks)"
    elif material.physical:
        problem = f"is of MTL's physical model ({material.physical[0]})"
    elif material.opacity < 0.5 or material.maps:
        problem = "has a mask or a map other than a plain map_Kd"
    elif max(np.add(material.kd, material.ks)) > 1.0:
        problem = "reflects more than it receives (Kd + Ks > 1)"
    if problem:
        raise SceneError(
            f"{path}: material '{material.name}' {problem}, which the cross-check does"
            " not map; name a diffuse variant in 'materials'"
        )


Corner = tuple[int, int, int]


def _parse_obj(path: Path) -> tuple[dict[str, list[Any]], list[Any], list[Any], list[str]]:
    """Columns v, vt, vn; index triples of corners (-1: none); materials of triangles; libraries."""
    columns: dict[str, list[Any]] = {"v": [], "vt": [], "vn": []}
    corners: list[tuple[Corner, Corner, Corner]] = []
    names: list[str] = []
    libraries: list[str] = []
    name = ""
    with open(path) as file:
        for line in file:
            parts = line.split()
            if not parts:
                continue
            key = parts[0]
            if key in columns:
                columns[key].append([float(x) for x in parts[1 : 3 if key == "vt" else 4]])
            elif key == "usemtl":
                name = parts[1]
            elif key == "mtllib":
                libraries.append(parts[1])
            elif key == "f":
                face = [_corner(text, columns) for text in parts[1:]]
                for k in range(2, len(face)):
                    corners.append((face[0], face[k - 1], face[k]))
                    names.append(name)
    return columns, corners, names, libraries


def _corner(text: str, columns: dict[str, list[Any]]) -> tuple[int, int, int]:
    ids = (text.split("/") + ["", ""])[:3]
    sizes = (len(columns["v"]), len(columns["vt"]), len(columns["vn"]))
    v, vt, vn = (
        -1 if not i else int(i) - 1 if int(i) > 0 else size + int(i)
        for i, size in zip(ids, sizes, strict=True)
    )
    return v, vt, vn


def read_mesh(obj: Path, mtl: Path | None, matrix: npt.NDArray[Any]) -> Mesh:
    if not obj.is_file():
        raise SceneError(f"{obj}: no such OBJ file; check 'file' in the scene.toml")
    columns, corners, names, libraries = _parse_obj(obj)
    library = read_mtl(mtl or obj.parent / libraries[0], obj)
    index = np.array(corners, int).reshape(-1, 3, 3)

    def take(key: str, which: int, width: int) -> npt.NDArray[Any]:
        rows = np.array(columns[key] + [[np.nan] * width], float)
        result: npt.NDArray[Any] = rows[index[:, :, which]]  # index -1 selects the row of NaN
        return result

    position = take("v", 0, 3) @ matrix[:3, :3].T + matrix[:3, 3]
    normal: npt.NDArray[Any] = take("vn", 2, 3) @ np.linalg.inv(matrix[:3, :3])
    with np.errstate(invalid="ignore"):
        normal = normal / np.linalg.norm(normal, axis=2, keepdims=True)
    uv = take("vt", 1, 2)
    if np.linalg.det(matrix[:3, :3]) < 0:  # a reflection inverts the winding, which is restored
        position, normal, uv = position[:, ::-1], normal[:, ::-1], uv[:, ::-1]

    used = sorted(set(names))
    for name in used:
        if name not in library:
            raise SceneError(f"{obj}: material '{name}' is not in its library; add it")
        check_supported(library[name], obj)
    material = np.array([used.index(name) for name in names])
    doubled = np.cross(position[:, 1] - position[:, 0], position[:, 2] - position[:, 0])
    keep = np.linalg.norm(doubled, axis=1) > 0
    return Mesh(position[keep], normal[keep], uv[keep], material[keep], [library[n] for n in used])


def split_emitters(mesh: Mesh, longest: float) -> Mesh:
    """Splits every emitting triangle into quarters until no edge exceeds `longest`."""
    emits = np.array([any(m.ke) for m in mesh.materials])
    position, normal, uv = mesh.position, mesh.normal, mesh.uv
    material = mesh.material
    while True:
        p = position
        edge = np.linalg.norm(p - np.roll(p, 1, axis=1), axis=2).max(axis=1)
        split = emits[material] & (edge > longest)
        if not split.any():
            return Mesh(position, normal, uv, material, mesh.materials)
        position, normal, uv = (
            np.concatenate([c[~split], _quarters(c[split])]) for c in (position, normal, uv)
        )
        material = np.concatenate([material[~split], np.tile(material[split], 4)])


def _quarters(corners: npt.NDArray[Any]) -> npt.NDArray[Any]:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    return np.concatenate(
        [
            np.stack(triangle, axis=1)
            for triangle in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
        ]
    )


# What the reader takes from each table of a scene.toml. Anything else would make another scene.
KEYS = {
    "": {"film", "camera", "mesh", "light"},
    "film": {"width", "height"},
    "camera": {"name", "position", "look_at", "forward", "up", "vertical_fov_deg"},
    "mesh": {"name", "file", "materials", "transform", "scale", "rotate_deg", "translate"},
    "light": {"name", "type", "position", "direction", "intensity", "irradiance", "radiance"}
    | {"angular_diameter_deg", "cone_deg", "falloff_deg", "image", "scale", "rotate_deg"},
}
LIGHTS = ("point", "spot", "directional", "environment")


def refuse_other_keys(path: Path, table: dict[str, Any]) -> None:
    tables = [("", table)]
    for name in ("film", "camera", "mesh", "light"):
        found = table.get(name, [])
        tables += [(name, each) for each in (found if isinstance(found, list) else [found])]
    for name, each in tables:
        for key in each:
            if key not in KEYS[name]:
                where = f"[{name}] {key}" if name else f"[{key}]"
                raise SceneError(f"{path}: {where} is not mapped to Cycles; leave it out")
        if name == "light" and each["type"] not in LIGHTS:
            raise SceneError(f"{path}: light '{each['type']}' is none of {', '.join(LIGHTS)}")


def read_scene(path: Path) -> Scene:
    table = read_toml(path)
    refuse_other_keys(path, table)
    try:
        meshes = []
        for mesh in table.get("mesh", []):
            mtl = resolve(path, mesh["materials"]) if "materials" in mesh else None
            meshes.append(read_mesh(resolve(path, mesh["file"]), mtl, read_transform(mesh)))
        film = table["film"]
        camera = read_camera(table["camera"])
        return Scene(film["width"], film["height"], camera, meshes, table.get("light", []))
    except KeyError as error:
        raise SceneError(f"{path}: key {error} is missing; add it") from error
