"""settings.toml as objects."""

import os
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]  # of the project
EVAL = ROOT / "eval"


@dataclass(frozen=True)
class View:
    scene: "Scene"
    id: str
    title: str
    file: str  # scene.toml, relative to the project
    reference_spp: int  # of each half, at the film that numbers are taken from
    reference_integrator: str = "path"  # vpl-render's --integrator

    @property
    def name(self) -> str:
        return f"{self.scene.id}-{self.id}"


@dataclass(frozen=True)
class Scene:
    id: str
    title: str
    vpls: int  # the thesis' count
    aspect: tuple[int, int]
    define: str  # environment variable with the model's folder; '' when the project holds the model
    views: list[View]

    def film(self, width: int) -> str:
        """'80x60' for a width of 80."""
        return f"{width}x{width * self.aspect[1] // self.aspect[0]}"

    @property
    def available(self) -> bool:
        return not self.define or bool(os.environ.get(self.define))


def load(path: Path = EVAL / "settings.toml") -> tuple[list[Scene], dict]:
    """The scenes, and the tables of settings.toml as they stand."""
    with path.open("rb") as file:
        table = tomllib.load(file)
    scenes = []
    for entry in table["scene"]:
        scene = Scene(
            entry["id"],
            entry["title"],
            entry["vpls"],
            tuple(entry["aspect"]),
            entry.get("define", ""),
            [],
        )
        scene.views.extend(View(scene, **view) for view in entry["views"])
        scenes.append(scene)
    return scenes, table
