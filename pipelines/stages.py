"""Lists the commands that render a scene, for generate_ninja.py, slurm/submit.py and farm.py.

A stage in N shards becomes N tasks and one task of vpl-merge. Every task names its files, so its
runner may skip a task that is up to date. Paths are relative to the folder in which the tasks run.
"""

import argparse
import dataclasses
import pathlib
import re
import shlex
import sys
from collections.abc import Iterable, Sequence
from typing import Any, NoReturn

HERE = pathlib.Path(__file__).resolve().parent
DEFAULT_BIN = HERE.parent / "build" / "release" / "bin"
DIVIDED = ("place", "estimate", "render")  # stages that can be divided into shards
MOST_SHARDS = 1500  # the command of vpl-merge names all shards, and Linux limits its length
# Placeholders in the words of a stage for its -o FILE and --png FILE.
OUTPUT, PREVIEW = object(), object()


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


def presets() -> dict[str, dict[str, str]]:
    """Presets of quality.mk, such as {"draft": {"VPLS": "1500", ...}, ...}."""
    found: dict[str, dict[str, str]] = {}
    for line in (HERE / "quality.mk").read_text().splitlines():
        if assignment := re.fullmatch(r"(\w+)\.(\w+)\s*:=\s*(.*)", line):
            name, quality, value = assignment.groups()
            found.setdefault(quality, {})[name] = value
    return found


class PerStage(argparse.Action):
    """Parses VALUE for all stages or STAGE=VALUE for one. Commas join several; later ones win."""

    def __init__(
        self,
        option_strings: Sequence[str],
        dest: str,
        stages: Sequence[str],
        pattern: str,
        what: str,
        **more: Any,
    ) -> None:
        self.stages, self.pattern, self.what = stages, re.compile(pattern), what
        super().__init__(option_strings, dest, metavar="[STAGE=]VALUE,...", **more)

    def __call__(
        self,
        parser: argparse.ArgumentParser,
        namespace: argparse.Namespace,
        text: Any,
        option_string: str | None = None,
    ) -> None:
        chosen = dict(getattr(namespace, self.dest))
        for word in text.split(","):
            stage, equals, value = word.rpartition("=")
            if equals and stage not in self.stages:
                parser.error(
                    f"{option_string} {text}: '{stage}' is none of {', '.join(self.stages)}"
                )
            if not self.pattern.fullmatch(value):
                parser.error(f"{option_string} {text}: '{value}' is not {self.what}")
            chosen |= {stage: value} if equals else dict.fromkeys(self.stages, value)
        setattr(namespace, self.dest, chosen)


def add_arguments(parser: argparse.ArgumentParser, shards: str = "1") -> None:
    """Adds the options that determine the graph and the images. `shards`: default of --shards."""
    parser.add_argument(
        "--out", default="out", help="folder; each scene gets one below it (default out)"
    )
    parser.add_argument(
        "--bin",
        default=relative(DEFAULT_BIN),
        help="folder of the executables (default %(default)s)",
    )
    parser.add_argument(
        "--quality",
        default="default",
        choices=sorted(presets()),
        help="counts and options of quality.mk (default %(default)s)",
    )
    parser.add_argument("--candidates", help="default: the quality's")
    parser.add_argument("--vpls", help="default: the quality's")
    parser.add_argument("--photons", help="default: the quality's")
    parser.add_argument(
        "--spp",
        help="samples per pixel; default: the quality's; "
        "'' for none, as with --render-flags='--time 2m'",
    )
    parser.add_argument("--seed", help="for place, estimate and render")
    parser.add_argument(
        "--processor",
        default="this",
        choices=("this", "any"),
        help="any: the same bytes on processors of all kinds, slower (default %(default)s)",
    )
    parser.add_argument(
        "--views",
        type=view_list,
        default=[],
        metavar="FILE,...",
        help="a .toml of [film] and [camera] for each image, in place of the scene's own: "
        "one set of VPLs serves all of them; images go to OUT/SCENE/views",
    )
    parser.add_argument(
        "--place-views",
        type=view_list,
        default=[],
        metavar="FILE,...",
        help="the views that VPLs are placed for (default all of --views): more images may be "
        "added "
        "later without other VPLs",
    )
    parser.add_argument(
        "--define", action="append", default=[], metavar="NAME=VALUE", help="for ${NAME} in a scene"
    )
    parser.add_argument(
        "--shards",
        action=PerStage,
        stages=DIVIDED,
        pattern=r"[1-9]\d*",
        what="a count from 1",
        default=dict.fromkeys(DIVIDED, shards),
        help=f"parts of {', '.join(DIVIDED)}, each a task: one count for all, or 4,render=64 "
        f"(default {shards})",
    )
    for stage in ("place", "eliminate", "estimate", "render"):
        parser.add_argument(
            f"--{stage}-flags",
            default="",
            metavar="FLAGS",
            help=f"more options of vpl-{stage}; write --{stage}-flags='--x y'",
        )


def complete(options: argparse.Namespace) -> None:
    """Fills in the values that --quality implies, and refuses what the pipelines cannot do."""
    options.shards = {stage: int(count) for stage, count in options.shards.items()}
    for stage, count in options.shards.items():
        if count > MOST_SHARDS:
            refuse(f"--shards {stage}={count} is more than {MOST_SHARDS}")
    preset = presets()[options.quality]
    for name in ("candidates", "vpls", "photons", "spp"):
        if getattr(options, name) is None:
            setattr(options, name, preset[name.upper()])
    options.presets = {
        stage: shlex.split(preset[stage.upper()]) for stage in ("estimate", "render")
    }
    refuse_lit_placement(options)
    for name in ("out", "bin", "candidates", "vpls", "photons"):
        if not getattr(options, name):  # mostly an unset variable of a script
            refuse(f"--{name} '' is empty; give it a value, or leave it out")
    for path in (options.out, options.bin):
        check_path(path)


def view_list(text: str) -> list[str]:
    return [check_path(view) for view in text.split(",") if view]


def views_of(options: argparse.Namespace) -> list[tuple[str, str]]:
    """Pairs (name, file) of the views. For the scene's own view both are empty."""
    for view in options.views + options.place_views:
        if not pathlib.Path(view).is_file():
            refuse(f"there is no view '{view}'")
    named = [(pathlib.Path(view).stem, view) for view in options.views]
    for name, _ in named:
        if [other for other, _ in named].count(name) > 1:
            refuse(
                f"two views would be images of one name, '{name}'; give their files different names"
            )
    return named or [("", "")]


def refuse(problem: str) -> NoReturn:
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {problem}")


def words_of(text: str, option: str) -> list[str]:
    """Splits the text of an option as a shell does."""
    try:
        return shlex.split(text)
    except ValueError as problem:
        refuse(f"{option} {text!r}: {problem}; check its quotes")


def refuse_lit_placement(options: argparse.Namespace) -> None:
    """Refuses methods that need other files or stages.

    VPLs that --method light places carry flux already, and --method rejection reads the scene.
    """
    words = {"light", "--method=light"} & set(words_of(options.place_flags, "--place-flags")) or {
        "rejection",
        "--method=rejection",
    } & set(words_of(options.eliminate_flags, "--eliminate-flags"))
    if words:
        refuse(
            "vpl-place --method light and vpl-eliminate --method rejection leave no work to "
            "vpl-estimate; "
            "run these stages by hand, as pipelines/README.md shows"
        )


def relative(path: pathlib.Path) -> str:
    """The path relative to the current folder if it lies below it, so that the project can move."""
    here = pathlib.Path.cwd()
    return (
        f"{'./' if path.parent == here else ''}{path.relative_to(here)}"
        if path.is_relative_to(here)
        else str(path)
    )


def check_path(path: str) -> str:
    """Refuses characters that are special to the shell, Make or ninja. Returns the path."""
    found = re.search(r"[^\w/.,+@!-]", path)
    if found:
        character = "a space" if found[0] == " " else repr(found[0])
        refuse(
            f"{path!r} contains {character}, which the pipelines cannot handle; choose another path"
        )
    return path


def check_scene(scene: str) -> None:
    check_path(scene)
    if not pathlib.Path(scene).is_file():
        refuse(f"there is no scene '{scene}'")


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
    """A task whose command is its first input, the executable, followed by `words`.

    `beside` is the stem of the names of its statistics, depfile and checkpoint.
    """
    command = [inputs[0], *words, "--stats", f"{beside}.json"]
    depfile, checkpoint = (
        f"{beside}.d" if scene_read else "",
        f"{beside}.checkpoint" if saves else "",
    )
    command += ["--depfile", depfile] if depfile else []
    command += ["--checkpoint", checkpoint, "--checkpoint-replace"] if checkpoint else []
    return Task(name, stage, after, command, inputs, outputs, depfile, checkpoint, shard)


def tasks_in_parts(
    stage: str,
    after: list[str],
    options: argparse.Namespace,
    outputs: list[str],
    inputs: list[str],
    words: Iterable[Any],
    view: str = "",
) -> list[Task]:
    """Tasks of a stage that reads the scene, or of one view of it.

    They are one task, or one for each shard and one that merges them.
    """
    whole = f"{stage}-{view}" if view else stage
    product, preview = ["-o", outputs[0]], ["--png", outputs[-1]] if PREVIEW in words else []

    def filled(output: list[str], png: list[str]) -> list[str]:
        return [
            w
            for word in words
            for w in (output if word is OUTPUT else png if word is PREVIEW else [word])
        ]

    folder, of = outputs[0].rsplit("/", 1)[0], options.shards[stage]
    beside = f"{folder}/{view or stage}"
    if of == 1:
        return [
            task(whole, stage, after, outputs, inputs, filled(product, preview), beside, saves=True)
        ]
    tasks, parts = [], []
    for part in range(1, of + 1):
        name = shard_name(whole, part, of)
        parts.append(f"{folder}/shards/{name}.shard")
        tasks.append(
            task(
                name,
                stage,
                after,
                [parts[-1]],
                inputs,
                [*filled(["-o", parts[-1]], []), "--shard", f"{part}/{of}"],
                f"{folder}/shards/{name}",
                saves=True,
                shard=True,
            )
        )
    return tasks + [
        task(
            f"merge-{whole}",
            f"merge-{stage}",
            [stage],
            outputs,
            [f"{options.bin}/vpl-merge", *parts],
            [*parts, *product, *preview],
            beside,
        )
    ]


def tasks_of(scene: str, options: argparse.Namespace) -> list[Task]:
    """All tasks of a scene, each after those whose files it reads."""
    out = folder_of(scene, options)
    seed = ["--seed", options.seed] if options.seed else []
    spp = ["--spp", options.spp] if options.spp else []
    defines = [word for define in options.define for word in ("--define", define)]
    processor = ["--processor", options.processor] if options.processor != "this" else []
    candidates, vpls, lit = f"{out}/candidates.vpl", f"{out}/vpls.vpl", f"{out}/lit.vpl"
    views = views_of(options)

    def tool(stage: str) -> str:
        return f"{options.bin}/vpl-{stage}"

    def flags(stage: str) -> list[str]:
        return [*processor, *words_of(getattr(options, f"{stage}_flags"), f"--{stage}-flags")]

    def done(stage: str) -> list[str]:
        return [stage if options.shards.get(stage, 1) == 1 else f"merge-{stage}"]

    def looking(view: str) -> list[str]:
        return ["--view", view] if view else []

    placed = options.place_views or options.views
    before = [
        *tasks_in_parts(
            "place",
            [],
            options,
            [candidates],
            [tool("place"), scene, *placed],
            [
                scene,
                *(word for view in placed for word in looking(view)),
                OUTPUT,
                "-n",
                options.candidates,
                *seed,
                *defines,
                *flags("place"),
            ],
        ),
        task(
            "eliminate",
            "eliminate",
            done("place"),
            [vpls],
            [tool("eliminate"), candidates],
            [candidates, "-o", vpls, "-n", options.vpls, *flags("eliminate")],
            f"{out}/eliminate",
            scene_read=False,
        ),
        *tasks_in_parts(
            "estimate",
            ["eliminate"],
            options,
            [lit],
            [tool("estimate"), scene, vpls],
            [
                scene,
                vpls,
                OUTPUT,
                "--photons",
                options.photons,
                *seed,
                *defines,
                *options.presets["estimate"],
                *flags("estimate"),
            ],
        ),
    ]
    images = [
        tasks_in_parts(
            "render",
            done("estimate"),
            options,
            images_of(name, out),
            [tool("render"), scene, lit, *([view] if view else [])],
            [
                scene,
                *looking(view),
                lit,
                OUTPUT,
                *spp,
                PREVIEW,
                *seed,
                *defines,
                *options.presets["render"],
                *flags("render"),
            ],
            name,
        )
        for name, view in views
    ]
    return before + [task for tasks in images for task in tasks]


def images_in(scene: str, options: argparse.Namespace) -> list[list[str]]:
    """Files of the images of a scene: a list [image, preview] for each view."""
    return [images_of(name, folder_of(scene, options)) for name, _ in views_of(options)]
