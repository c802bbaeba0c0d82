"""Lists the commands that render a scene, for generate_ninja.py, slurm/submit.py and farm.py.

A stage in N shards becomes N tasks and one task of vpl-merge. Every task names its files, so its
runner may skip a task that is up to date. Paths are relative to the folder in which the tasks run.
"""

import argparse
import dataclasses
import pathlib
from collections.abc import Callable
from typing import Any

import commands
from stage_options import check_path, views_of, words_of


@dataclasses.dataclass
class Task:
    name: str  # place, place-3-of-64, merge-place
    stage: str  # place, merge-place
    after: list[str]  # the stages whose files it reads
    command: list[str]
    inputs: list[str]  # the executable, and the input files that the command names
    outputs: list[str]
    depfile: str = ""  # where the command lists the other files that it has read
    checkpoint: str = ""  # the file from which an interrupted command resumes
    shard: bool = False


def name_of(scene: str) -> str:
    """Name of a scene: u-shape for u-shape/scene.toml, sponza-gallery for sponza/gallery.toml."""
    path = pathlib.Path(scene).resolve()
    return path.parent.name + ("" if path.stem == "scene" else f"-{path.stem}")


def folder_of(scene: str, options: argparse.Namespace) -> str:
    return check_path(f"{options.out}/{name_of(scene)}")


def shard_name(stage: str, part: int | str, of: int) -> str:
    return f"{stage}-{part}-of-{of}"


def images_of(view: str, out: str) -> list[str]:
    return (
        [f"{out}/views/{view}.exr", f"{out}/views/{view}.png"]
        if view
        else [f"{out}/image.exr", f"{out}/image.png"]
    )


def task(
    name: str,
    stage: str,
    after: list[str],
    outputs: list[str],
    inputs: list[str],
    words: list[str],
    beside: str,
    scene_read: bool = True,
    saves: bool = False,
    shard: bool = False,
) -> Task:
    """A task of the command `words`, whose tool is the executable `inputs[0]`.

    `beside` is the stem of the names of its statistics, depfile and checkpoint.
    """
    command = [inputs[0], *words[1:], "--stats", f"{beside}.json"]
    depfile = f"{beside}.d" if scene_read else ""
    checkpoint = f"{beside}.checkpoint" if saves else ""
    command += ["--depfile", depfile] if depfile else []
    command += ["--checkpoint", checkpoint, "--checkpoint-replace"] if checkpoint else []
    return Task(name, stage, after, command, inputs, outputs, depfile, checkpoint, shard)


class Tasks:
    """Makes the tasks of one scene."""

    def __init__(self, scene: str, options: argparse.Namespace) -> None:
        self.scene, self.options = scene, options
        self.out = folder_of(scene, options)
        self.candidates, self.vpls, self.lit = (
            f"{self.out}/{name}.vpl" for name in ("candidates", "vpls", "lit")
        )
        self.seed = ["--seed", options.seed] if options.seed else []
        self.defines = [word for define in options.define for word in ("--define", define)]

    def tool(self, stage: str) -> str:
        return f"{self.options.bin}/vpl-{stage}"

    def flags(self, stage: str) -> list[str]:
        """Options of a stage that the user or the quality adds."""
        chosen = self.options
        processor = ["--processor", chosen.processor] if chosen.processor != "this" else []
        own = words_of(getattr(chosen, f"{stage}_flags"), f"--{stage}-flags")
        return [*chosen.presets.get(stage, []), *processor, *own]

    def last(self, stage: str) -> list[str]:
        """The stage whose end means that all of `stage` is done."""
        return [stage if self.options.shards.get(stage, 1) == 1 else f"merge-{stage}"]

    def in_parts(
        self,
        stage: str,
        after: list[str],
        inputs: list[str],
        outputs: list[str],
        command: Callable[[str], list[Any]],
        view: str = "",
    ) -> list[Task]:
        """Tasks of a stage that reads the scene, or of one view of it.

        They are one task, or one for each shard and one that merges them. `command` is told the
        main output. The second output is a preview, which shards do not have.
        """
        whole = f"{stage}-{view}" if view else stage
        preview = [word for name in outputs[1:] for word in ("--png", name)]
        folder, of = outputs[0].rsplit("/", 1)[0], self.options.shards[stage]
        beside = f"{folder}/{view or stage}"
        if of == 1:
            words = [*command(outputs[0]), *preview]
            return [task(whole, stage, after, outputs, inputs, words, beside, saves=True)]
        tasks, parts = [], []
        for part in range(1, of + 1):
            stem = f"{folder}/shards/{shard_name(whole, part, of)}"
            parts.append(f"{stem}.shard")
            words = [*command(parts[-1]), "--shard", f"{part}/{of}"]
            name = shard_name(whole, part, of)
            tasks.append(
                task(name, stage, after, parts[-1:], inputs, words, stem, saves=True, shard=True)
            )
        words = commands.merge(parts, outputs[0], *preview)
        inputs = [self.tool("merge"), *parts]
        merge = f"merge-{stage}"
        return [*tasks, task(f"merge-{whole}", merge, [stage], outputs, inputs, words, beside)]

    def place(self) -> list[Task]:
        views = self.options.place_views or self.options.views
        more = [word for view in views for word in ("--view", view)]
        more += ["-n", self.options.candidates, *self.seed, *self.defines, *self.flags("place")]
        inputs = [self.tool("place"), self.scene, *views]
        return self.in_parts(
            "place",
            [],
            inputs,
            [self.candidates],
            lambda output: commands.place(self.scene, output, *more),
        )

    def eliminate(self) -> list[Task]:
        more = ["-n", self.options.vpls, *self.flags("eliminate")]
        return [
            task(
                "eliminate",
                "eliminate",
                self.last("place"),
                [self.vpls],
                [self.tool("eliminate"), self.candidates],
                commands.eliminate(self.candidates, self.vpls, *more),
                f"{self.out}/eliminate",
                scene_read=False,
            )
        ]

    def estimate(self) -> list[Task]:
        more = ["--photons", self.options.photons, *self.seed, *self.defines]
        more += self.flags("estimate")
        return self.in_parts(
            "estimate",
            ["eliminate"],
            [self.tool("estimate"), self.scene, self.vpls],
            [self.lit],
            lambda output: commands.estimate(self.scene, self.vpls, output, *more),
        )

    def render(self, name: str, view: str) -> list[Task]:
        more = ["--view", view] if view else []
        more += ["--spp", self.options.spp] if self.options.spp else []
        more += [*self.seed, *self.defines, *self.flags("render")]
        return self.in_parts(
            "render",
            self.last("estimate"),
            [self.tool("render"), self.scene, self.lit, *([view] if view else [])],
            images_of(name, self.out),
            lambda output: commands.render(self.scene, self.lit, output, *more),
            name,
        )


def tasks_of(scene: str, options: argparse.Namespace) -> list[Task]:
    """All tasks of a scene, each after those whose files it reads."""
    tasks = Tasks(scene, options)
    images = [task for view in views_of(options) for task in tasks.render(*view)]
    return [*tasks.place(), *tasks.eliminate(), *tasks.estimate(), *images]


def images_in(scene: str, options: argparse.Namespace) -> list[list[str]]:
    """Files of the images of a scene: a list [image, preview] for each view."""
    return [images_of(name, folder_of(scene, options)) for name, _ in views_of(options)]
