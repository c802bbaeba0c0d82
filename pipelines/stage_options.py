"""Options of the programs that list the commands of a scene: scenes, counts, views, shards."""

import argparse
import itertools
import os
import pathlib
import re
import shlex
import shutil
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

HERE = pathlib.Path(__file__).resolve().parent
BUILT = HERE.parent / "build" / "release" / "bin"
DIVIDED = ("place", "estimate", "render")  # stages that can be divided into shards
MAX_SHARDS = 1500  # the command of vpl-merge names all shards, and Linux limits its length
# Linux limits an argument to 128 KiB, and `sh -c` takes a whole command as one.
MAX_SHELL_COMMAND = 130_000


def default_bin() -> pathlib.Path:
    """The build of this tree, or else the folder of what is installed."""
    installed = shutil.which("vpl-render")
    built = (BUILT / "vpl-render").exists() or not installed
    return BUILT if built else pathlib.Path(str(installed)).parent


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
        default=relative(default_bin()),
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
    add_division(parser, shards)


def add_division(parser: argparse.ArgumentParser, shards: str) -> None:
    """Adds --shards and the options that are passed on to the stages."""
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
        if count > MAX_SHARDS:
            refuse(f"--shards {stage}={count} is more than {MAX_SHARDS}")
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
    views = [check_path(view) for view in text.split(",") if view]
    if not views:  # mostly an unset variable of a script
        raise argparse.ArgumentTypeError(
            f"{text!r} names no view; name .toml files, or leave the option out"
        )
    return views


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


def value_in(words: list[str], name: str) -> str:
    """The value of an option in the words of a command line; empty if it is not there."""
    for word, after in itertools.pairwise([*words, ""]):
        if word == name:
            return after
        if word.startswith(f"{name}="):
            return word.partition("=")[2]
    return ""


def shell_command(words: list[str]) -> str:
    """The words as one command for `sh -c`. Refuses what Linux would not start."""
    command = shlex.join(words)
    if len(os.fsencode(command)) > MAX_SHELL_COMMAND:
        refuse(
            f"the command that merges the shards has {len(command)} characters, and a shell takes "
            f"{MAX_SHELL_COMMAND}; give fewer --shards, or a shorter --out"
        )
    return command


def chooses(words: list[str], method: str) -> bool:
    """Whether the words of a stage choose a method."""
    return f"--method={method}" in words or ("--method", method) in zip(words, words[1:])


def refuse_lit_placement(options: argparse.Namespace) -> None:
    """Refuses methods that need other files or stages.

    VPLs that --method light places carry flux already, and --method rejection reads the scene.
    """
    place = words_of(options.place_flags, "--place-flags")
    eliminate = words_of(options.eliminate_flags, "--eliminate-flags")
    if chooses(place, "light") or chooses(eliminate, "rejection"):
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
    """Refuses characters that are special to the shell, Make or ninja. Returns the path.

    The tools would take a path that begins with - for an option.
    """
    if path.startswith("-"):
        refuse(f"{path!r} begins with -, as options do; write ./{path}")
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
