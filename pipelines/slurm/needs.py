"""Chooses the memory and time to request from Slurm where the options give none.

cost.py predicts both from the triangles of the scene, the counts and the film. The factors add room
for scenes that take more work than the one to which the rates were fitted.
"""

import argparse
import dataclasses
import json
import math
import re
import subprocess
import tomllib
from typing import Any

import cost
import stage_options

ROOM_MEMORY, SPARE_MIB = 1.5, 256
ROOM_TIME, SPARE_MIN = 4, 10


def look(scene: str, options: argparse.Namespace, *more: str) -> Any:
    """The scene as vpl-inspect scene --json describes it."""
    defines = [word for pair in options.define for word in ("--define", pair)]
    command = [f"{options.bin}/vpl-inspect", "scene", scene, "--json", *defines, *more]
    try:
        done = subprocess.run(command, text=True, capture_output=True)
    except OSError:
        stage_options.refuse(
            f"there is no {command[0]} that runs, which looks at the scene; build the tools, or "
            "give --memory and --time"
        )
    if done.returncode:
        stage_options.refuse(done.stderr.strip() + "; or give --memory and --time")
    return json.loads(done.stdout)


def film_of(view: str, scene_film: str) -> str:
    """Film of a view file, such as 640x480; it lacks the keys that are as in the scene."""
    try:
        with open(view, "rb") as file:
            film = tomllib.load(file).get("film", {})
    except (OSError, tomllib.TOMLDecodeError) as problem:
        stage_options.refuse(f"{view}: {problem}; supply a TOML file with [film] and [camera]")
    width, height = scene_film.split("x")
    return f"{film.get('width', width)}x{film.get('height', height)}"


def camera_of(seen: dict[str, Any], wanted: str) -> Any:
    """The scene's camera of this name or number; the first unless there is one."""
    cameras = seen["cameras"]
    for number, camera in enumerate(cameras):
        if wanted in (camera["name"], str(number)):
            return camera
    return cameras[0]


def pixels_of(seen: dict[str, Any], options: argparse.Namespace) -> int:
    """Pixels of the largest film."""
    words = stage_options.words_of(options.render_flags, "--render-flags")
    if size := stage_options.value_in(words, "--size"):
        films = [size]
    elif options.views:
        films = [film_of(view, seen["cameras"][0]["film"]) for view in options.views]
    else:
        films = [camera_of(seen, stage_options.value_in(words, "--camera"))["film"]]
    sizes = [re.fullmatch(r"(\d+)x(\d+)", film) for film in films]
    return max((int(size[1]) * int(size[2]) for size in sizes if size), default=0)


def memory_MiB(predicted_MiB: float) -> int:
    """Memory to request, a multiple of 64."""
    return math.ceil((ROOM_MEMORY * predicted_MiB + SPARE_MIB) / 64) * 64


class Needs:
    """Memory and time of each stage. The scene is inspected at the first question."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.options, self.model = options, cost.load()
        self.whole: cost.Counts | None = None

    def predict(self, stage: str, figure: str, cores: int) -> float:
        if self.whole is None:
            o = self.options
            seen = look(o.scene, o)
            try:
                counts = [
                    cost.count(text) for text in (o.candidates, o.vpls, o.photons, o.spp or "256")
                ]
            except ValueError as problem:
                stage_options.refuse(str(problem))
            candidates, vpls, photons, spp = counts
            self.whole = cost.Counts(
                seen["triangles"], candidates, vpls, photons, pixels_of(seen, o), spp
            )
        shared = cost.with_shards(self.whole, stage, self.options.shards)
        return self.model.predict(stage, figure, dataclasses.replace(shared, threads=cores))

    def memory(self, stage: str, cores: int) -> str:
        """Memory in the notation of sbatch --mem."""
        mib = 0 if stage == "summary" else self.predict(stage, "memory_MiB", cores)
        return f"{memory_MiB(mib)}M"

    def time(self, stage: str, cores: int) -> str:
        """Time in minutes, in the notation of sbatch --time."""
        seconds = 0 if stage == "summary" else self.predict(stage, "cpu_s", cores) / cores
        return str(SPARE_MIN + math.ceil(ROOM_TIME * seconds / 60))
