"""Lists the cases of model_scenes.py by name: materials of the sphere, and whole scenes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import gltf_file
import model_scenes
from outputs import write_scene

WHITE, BLACK, BROWN = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (0.7, 0.4, 0.2)


def _gltf(
    metallic: float, roughness: float, colour: tuple[float, float, float] = BROWN
) -> dict[str, Any]:
    return {
        "type": "metallicroughness",
        "reflectance": colour,
        "metallic": metallic,
        "roughness": roughness,
    }


# pbrt's `roughness` is alpha, with remaproughness false. That of glTF is its square root.
PBRT_SPHERES: dict[str, dict[str, Any]] = (
    {
        f"conductor-{alpha}": {"type": "conductor", "reflectance": WHITE, "roughness": alpha}
        for alpha in (0.1, 0.3, 0.6)
    }
    | {
        f"glass-{alpha}": {"type": "dielectric", "eta": 1.5, "roughness": alpha}
        for alpha in (0.1, 0.3)
    }
    | {
        "coat-alone": {"type": "coateddiffuse", "eta": 1.5, "roughness": 0.3, "reflectance": BLACK},
        "coated": {"type": "coateddiffuse", "eta": 1.5, "roughness": 0.3, "reflectance": BROWN},
    }
)
GLTF_SPHERES: dict[str, dict[str, Any]] = {
    "gltf-metal": _gltf(1.0, 0.4),
    "gltf-rough-metal": _gltf(1.0, 0.8),
    "gltf-gloss-alone": _gltf(0.0, 0.4, BLACK),
    "gltf-plastic": _gltf(0.0, 0.4),
    "gltf-rough-plastic": _gltf(0.0, 0.8),
    "gltf-half-metal": _gltf(0.5, 0.6),
}
SPHERES = PBRT_SPHERES | GLTF_SPHERES
SKETCHES: dict[str, Callable[[], model_scenes.Sketch]] = {
    name: partial(model_scenes.sphere_in_box, model) for name, model in SPHERES.items()
} | {
    "gltf-normal-map": model_scenes.mapped_box,
    "gltf-instances": model_scenes.instances_in_box,
    "windows": model_scenes.room_with_windows,
}
GLTF = (*GLTF_SPHERES, "gltf-normal-map", "gltf-instances")


def write(name: str, path: Path) -> None:
    """Writes the file that our reader reads. For Cycles a .pbrt is built again by its name."""
    sketch = SKETCHES[name]()
    if path.suffix == ".glb":
        gltf_file.write(path, sketch)
    elif path.suffix == ".obj":
        write_scene(path, model_scenes.obj_text(sketch))
        write_scene(path.with_suffix(".mtl"), model_scenes.mtl_text(sketch))
    else:
        write_scene(path, model_scenes.pbrt_text(sketch))
