"""Lists the cases that both programs render, and writes the scenes that both read."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio

import model_cases
import model_scenes
from outputs import output_guard, write_scene
from scene_source import SceneError, read_toml, resolve


@dataclass(frozen=True)
class View:
    """One picture of a case. `direct` has 0 bounces; `indirect` is everything else."""

    quantity: str  # all, direct or indirect
    bounces: int  # maximum number of diffuse vertices after the one that the camera sees

    @property
    def name(self) -> str:
        return f"{self.quantity}-{self.bounces}"


DIRECT, ONE_BOUNCE, INDIRECT = View("direct", 0), View("indirect", 1), View("indirect", 32)
ALL = View("all", 32)


@dataclass(frozen=True)
class Case:
    name: str
    scene: str  # path below scenes/
    size: tuple[int, int]
    spp: int  # samples a pixel of vpl-render, for each seed
    cycles_spp: int
    seeds: int
    views: tuple[View, ...]
    drop: tuple[str, ...] = ()  # MTL keys to remove from every material except mirrors
    lights: tuple[dict[str, Any], ...] = ()  # replace the scene's own
    tall_block: str = ""  # MTL lines for the Cornell box's tall block
    teapot: str = ""  # MTL lines for a teapot put on the short block
    note: str = ""
    model: dict[str, Any] = field(default_factory=dict)  # the sphere's material in model_cases.py


ROOM: dict[str, Any] = {
    "scene": "cornell/scene.toml",
    "size": (96, 96),
    "spp": 128,
    "cycles_spp": 128,
    "seeds": 12,
    "views": (DIRECT, INDIRECT),
    "drop": ("Ke",),
}
BOX: dict[str, Any] = {
    "scene": "cornell/scene.toml",
    "size": (96, 96),
    "spp": 256,
    "cycles_spp": 256,
    "seeds": 12,
    "views": (DIRECT, INDIRECT),
}
MODEL: dict[str, Any] = {
    "size": model_scenes.SIZE,
    "spp": 32,
    "cycles_spp": 32,
    "seeds": 4,
    "views": (ALL,),
}
MORE_SAMPLES: dict[str, Any] = {"spp": 128, "cycles_spp": 128}
TEAPOT = {"scale": 0.09, "rotate_deg": [0.0, 40.0, 0.0], "translate": [0.186, 0.165, 0.168]}
SUN = {"type": "directional", "direction": [-0.35, -0.3, 1.0], "irradiance": [3.0, 2.5, 2.0]}

CASES = (
    Case("cornell", "cornell/scene.toml", (160, 160), 128, 128, 12, (DIRECT, ONE_BOUNCE, INDIRECT)),
    Case("u-shape", "u-shape/scene.toml", (160, 120), 512, 512, 12, (DIRECT, INDIRECT)),
    Case(
        "veach-ajar",
        "veach-ajar/scene.toml",
        (160, 90),
        256,
        256,
        12,
        (DIRECT, INDIRECT),
        note="all diffuse, by the scene's own material library",
    ),
    Case(
        "veach-door",
        "veach-door/scene.toml",
        (160, 90),
        256,
        256,
        12,
        (DIRECT, INDIRECT),
        drop=("Ks",),
        note="Phong lobes left out of both renderers; the mirror teapot stays",
    ),
    Case(
        "room-point",
        lights=({"type": "point", "position": [0.3, 0.45, 0.15], "intensity": [0.2, 0.15, 0.1]},),
        **ROOM,
    ),
    Case(
        "room-spot",
        lights=(
            {
                "type": "spot",
                "position": [0.3, 0.5, 0.1],
                "cone_deg": 30.0,
                "direction": [-0.2, -1.0, 0.6],
                "intensity": [1.0, 0.8, 0.6],
            },
        ),
        **ROOM,
    ),
    Case("room-sun", lights=(SUN | {"angular_diameter_deg": 5.0},), **ROOM),
    Case("room-distant", lights=(SUN,), **ROOM, note="a sun of no size"),
    Case("room-sky", lights=({"type": "environment", "radiance": [0.5, 0.8, 1.0]},), **ROOM),
    Case(
        "room-sky-image",
        lights=({"type": "environment", "image": "sky.exr", "scale": 0.5, "rotate_deg": 130.0},),
        **ROOM,
    ),
    Case("box-mirror", tall_block="Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n", **BOX),
    Case(
        "box-polished",
        tall_block="Kd 0.3 0.4 0.2\nKs 0.5 0.4 0.3\nillum 3\n",
        **BOX,
        note="mirror beside diffuse",
    ),
    Case("teapot-mirror", teapot="Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\n", **BOX),
    Case("teapot-glass", teapot="Kd 0 0 0\nNi 1.5\nillum 7\n", **BOX),
    Case("box-glass", tall_block="Kd 0 0 0\nNi 1.5\nillum 7\n", **BOX),
    *(
        Case(
            name,
            f"{name}.{'glb' if name in model_cases.GLTF else 'pbrt'}",
            model=model_cases.SPHERES.get(name, {}),
            **MODEL,
        )
        for name in model_cases.SKETCHES
        if name != "windows"
    ),
    Case(
        "windows",
        "windows.obj",
        lights=({"type": "environment", "image": "sky.exr", "rotate_deg": 160.0},),
        **(MODEL | MORE_SAMPLES),
    ),
)


def edit_mtl(text: str, drop: tuple[str, ...]) -> str:
    """The library without the lines that begin with a key in `drop`. Mirrors stay unchanged."""
    out = []
    for block in text.split("newmtl "):
        mirror = any(line.split() in (["illum", n] for n in "358") for line in block.splitlines())
        lines = [
            line
            for line in block.split("\n")
            if mirror or not line.split() or line.split()[0] not in drop
        ]
        out.append("\n".join(lines))
    return "newmtl ".join(out)


def _library_of(obj: Path) -> Path:
    with open(obj) as file:
        for line in file:
            if line.startswith("mtllib "):
                return obj.parent / line.split()[1]
    raise SceneError(f"{obj}: names no material library; name one in 'materials'")


def with_tall_block(obj: Path, mtl: Path, lines: str, folder: Path) -> tuple[Path, Path]:
    """Copies both files and gives the tall block a material of its own."""
    before, name, after = obj.read_text().partition("o TallBlock\nusemtl ")
    if not name:
        raise SceneError(f"{obj}: has no 'o TallBlock' followed by usemtl; use the Cornell box")
    new_obj, new_mtl = folder / "block.obj", folder / "block.mtl"
    write_scene(new_obj, before + "o TallBlock\nusemtl Block" + after[after.index("\n") :])
    write_scene(new_mtl, mtl.read_text() + "\nnewmtl Block\n" + lines)
    return new_obj, new_mtl


def _toml_value(value: object) -> str:
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, list):
        return "[" + ", ".join(_toml_value(v) for v in value) + "]"
    return repr(value)


def _toml_table(header: str, table: dict[str, Any]) -> str:
    lines = [header] + [f"{key} = {_toml_value(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n\n"


def write_sky(path: Path) -> None:
    """Writes a latitude-longitude image whose asymmetry reveals wrong rotations and flips."""
    y, x = np.mgrid[0:16, 0:32]
    up = 1.0 - (y + 0.5) / 16
    sky = np.stack([0.2 + 0.3 * up, 0.2 + 0.6 * up, 0.2 + 1.2 * up], axis=-1)
    sky[4:7, 20:24] = (30.0, 20.0, 8.0)
    sky[9:12, 3:9] = (6.0, 0.5, 0.5)
    sky[x >= 28] *= 0.25
    image = oiio.ImageBuf(oiio.ImageSpec(32, 16, 3, oiio.FLOAT))
    image.set_pixels(oiio.ROI(), np.ascontiguousarray(sky, np.float32))

    def make(partial: Path) -> None:
        if not image.write(str(partial)):
            raise OSError(f"{path}: cannot write: {image.geterror()}")

    output_guard.replace(path, output_guard.EXR, make)


def prepare(case: Case, scenes: Path, folder: Path) -> Path:
    """Writes the scene and the libraries that both renderers read. Returns the scene's path."""
    folder.mkdir(parents=True, exist_ok=True)
    original = scenes / case.scene
    if case.name in model_cases.SKETCHES:
        original = folder / case.scene
        model_cases.write(case.name, original)
    if original.suffix in (".glb", ".pbrt"):
        return original
    table = (
        {
            "camera": model_scenes.CAMERA,
            "mesh": [{"file": str(original), "materials": str(original.with_suffix(".mtl"))}],
        }
        if original.suffix == ".obj"
        else read_toml(original)
    )
    width, height = case.size
    text = _toml_table("[film]", {"width": width, "height": height})
    text += _toml_table("[camera]", table["camera"])
    for number, mesh in enumerate(table["mesh"]):
        obj = resolve(original, mesh["file"])
        if not obj.is_file():
            raise SceneError(f"{obj}: no such OBJ file; see scenes/README.md for the downloads")
        mtl = resolve(original, mesh["materials"]) if "materials" in mesh else _library_of(obj)
        if case.drop:
            edited = folder / f"mesh{number}.mtl"
            write_scene(edited, edit_mtl(mtl.read_text(), case.drop))
            mtl = edited
        if case.tall_block:
            obj, mtl = with_tall_block(obj, mtl, case.tall_block, folder)
        text += _toml_table("[[mesh]]", mesh | {"file": str(obj), "materials": str(mtl)})
    if case.teapot:
        mtl = folder / "teapot.mtl"
        write_scene(mtl, "newmtl Teapot\n" + case.teapot)
        teapot = {"file": str(scenes / "teapot" / "teapot.obj"), "materials": str(mtl)}
        text += _toml_table("[[mesh]]", teapot | TEAPOT)
    for light in case.lights or table.get("light", []):
        if "image" in light:
            write_sky(folder / light["image"])
        text += _toml_table("[[light]]", light)
    path = folder / "scene.toml"
    write_scene(path, text)
    return path
