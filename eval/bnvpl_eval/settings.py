"""Loads settings.toml into objects."""

import os
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]  # folder of the project
EVAL = ROOT / "eval"


@dataclass(frozen=True)
class View:
    scene: "Scene"
    id: str
    title: str
    file: str  # scene.toml, relative to the project
    reference_spp: int  # samples a pixel of each half, on the small film
    reference_integrator: str = "path"  # vpl-render's --integrator

    @property
    def name(self) -> str:
        return f"{self.scene.id}-{self.id}"


@dataclass(frozen=True)
class Scene:
    id: str
    title: str
    vpls: int  # number of VPLs in the thesis
    aspect: tuple[int, int]
    define: str  # environment variable with the model's folder; '' when the project holds the model
    views: list[View]

    def film(self, width: int) -> str:
        """Size of the film, such as '80x60' for a width of 80 and an aspect of 4:3."""
        return f"{width}x{width * self.aspect[1] // self.aspect[0]}"

    @property
    def available(self) -> bool:
        return not self.define or bool(os.environ.get(self.define))


def load(path: Path = EVAL / "settings.toml") -> tuple[list[Scene], dict[str, Any]]:
    """The scenes, and the tables of settings.toml as parsed."""
    with path.open("rb") as file:
        table = tomllib.load(file)
    scenes = []
    for entry in table["scene"]:
        scene = Scene(
            entry["id"],
            entry["title"],
            entry["vpls"],
            (entry["aspect"][0], entry["aspect"][1]),
            entry.get("define", ""),
            [],
        )
        scene.views.extend(View(scene, **view) for view in entry["views"])
        scenes.append(scene)
    return scenes, table
