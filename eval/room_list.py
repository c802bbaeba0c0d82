"""Lists the rooms that rooms.py and run_means.py measure; says what of their files is missing."""

import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import gallery

OURS = tuple(
    gallery.Scene(name, title, f"scenes/{file}.toml", aspect)
    for name, title, file, aspect in (
        ("cornell", "Cornell box", "cornell/scene", (1, 1)),
        ("u-shape", "U-shape", "u-shape/scene", (4, 3)),
        ("u-shape-back", "U-shape, from the far wall", "u-shape/back", (4, 3)),
        ("veach-door", "Veach door", "veach-door/scene", (16, 9)),
        ("veach-door-table", "Veach door, across the table", "veach-door/table", (16, 9)),
        ("sponza", "Sponza", "sponza/scene", (16, 9)),
        ("sponza-gallery", "Sponza, from the gallery", "sponza/gallery", (16, 9)),
        ("veach-ajar", "Veach, Ajar, diffuse", "veach-ajar/scene", (16, 9)),
        ("veach-ajar-table", "Veach, Ajar, diffuse, across the table", "veach-ajar/table", (16, 9)),
    )
)


@dataclass(frozen=True)
class ElsewhereScene(gallery.Scene):
    folder: str = ""  # environment variable that names the folder of `file`

    @property
    def path(self) -> Path:
        return Path(os.environ.get(self.folder, "/nowhere")) / self.file


SCENES = (
    *OURS,
    ElsewhereScene(
        "living-room-diffuse", "Living room, diffuse", "scene.toml", folder="LIVING_ROOM_DIR"
    ),
    ElsewhereScene(
        "sun-room", "Class room in the sun, diffuse", "room.toml", folder="SUN_ROOM_DIR"
    ),
    ElsewhereScene(
        "sun-room-sky", "Class room, sky image with the sun", "room-sky.toml", folder="SUN_ROOM_DIR"
    ),
    *gallery.SCENES,
)


def missing(scene: gallery.Scene) -> str:
    """What the scene lacks, or nothing."""
    if not scene.path.is_file():
        return f"{scene.path} is not there"
    if scene.path.suffix != ".toml":
        return ""
    unset = [
        name
        for name in re.findall(r"\$\{(\w+)\}", scene.path.read_text())
        if name not in os.environ
    ]
    return f"{', '.join(unset)} is not set" if unset else ""


def chosen(names: list[str], program: str) -> list[gallery.Scene]:
    """The rooms of these names, or all without names. Says which of them lack files."""
    if unknown := set(names) - {scene.id for scene in SCENES}:
        sys.exit(f"{program}: no room is named {', '.join(sorted(unknown))}; --help lists them")
    rooms = []
    for scene in SCENES:
        if names and scene.id not in names:
            continue
        if lacks := missing(scene):
            print(f"{program}: {scene.title} is left out: {lacks}", file=sys.stderr)
        else:
            rooms.append(scene)
    return rooms
