"""The options of the tools, and command lines made of Python's arguments."""

from __future__ import annotations

import difflib
import functools
import json
import os
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Option:
    """An option or an argument of a tool."""

    name: str  # "max-cut"
    kind: str  # "flag", "switch" (on or off), "count", "file" ...
    type: str  # as --help shows it: "COUNT"
    repeat: bool  # whether it may have several values


@dataclass(frozen=True)
class Spec:
    """What a tool takes, or a command of vpl-inspect; by keyword."""

    arguments: dict[str, Option]  # in order
    options: dict[str, Option]  # also by letter


def _option(o: Mapping[str, Any]) -> Option:
    return Option(o["name"], o["kind"], o["type"], o["repeat"])


def spec_of(executable: str, command: str = "") -> Spec:
    """What the tool's --help-json tells; with a command of vpl-inspect, what both take.

    Raises CalledProcessError, with what the tool says, where it does not start.
    """
    return _spec_of(executable, command, os.stat(executable).st_mtime_ns)


@functools.cache
def _spec_of(executable: str, command: str, built_ns: int) -> Spec:
    done = subprocess.run([executable, "--help-json"], capture_output=True, text=True, check=True)
    tool = json.loads(done.stdout)
    commands = [c for c in tool.get("commands", []) if c["tool"].endswith(f" {command}")]
    arguments, options = {}, {}
    for spec in (tool, *commands):
        arguments.update({o["name"].replace("-", "_"): _option(o) for o in spec["arguments"]})
        for o in spec["options"]:
            names = [o["name"].replace("-", "_"), *o["letter"].lstrip("-")]
            options.update({name: _option(o) for name in names})
    return Spec(arguments, options)


def _text(value: Any) -> str:
    return str(os.fspath(value) if isinstance(value, os.PathLike) else value)


def _texts(name: str, option: Option, value: Any) -> list[str]:
    """The values of an option as on a command line, mostly one."""
    if isinstance(value, bool | np.bool_) and option.kind == "switch":
        return ["on" if value else "off"]
    if isinstance(value, Mapping):
        value = [f"{key}={_text(of)}" for key, of in value.items()]
    if isinstance(value, np.ndarray):
        if value.ndim > 1:
            raise TypeError(f"{name} is an array of {value.ndim} dimensions, not of one")
        value = value.tolist() if value.ndim == 0 else list(value)
    if not isinstance(value, list | tuple):
        return [_text(value)]
    texts = [_text(v) for v in value]
    if "," in option.type:
        return [",".join(texts)]
    if option.type == "WIDTHxHEIGHT":
        return ["x".join(texts)]
    if not option.repeat:
        raise TypeError(f"{name} has one value, not {value!r}")
    return texts


def _words(name: str, option: Option, value: Any) -> list[str]:
    if option.kind != "flag":
        return [w for text in _texts(name, option, value) for w in (f"--{option.name}", text)]
    if not isinstance(value, bool | np.bool_):
        raise TypeError(f"{name} is a flag: True or False, not {value!r}")
    return [f"--{option.name}"] if value else []


def words_of(
    tool: str, spec: Spec, positional: Sequence[Any], given: Mapping[str, Any]
) -> list[str]:
    """Words of a command line. Raises TypeError for a keyword that the tool does not take."""
    given = {name: value for name, value in given.items() if value is not None}
    words = [_text(argument) for argument in positional]
    for name, option in spec.arguments.items():
        if name in given:
            words += _texts(name, option, given[name])
    known = [*spec.arguments, *spec.options]
    for name, value in given.items():
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean {near[0]}?" if near else f"; see {tool} --help"
            raise TypeError(f"{tool} has no option {name}{hint}")
        if name not in spec.arguments:
            words += _words(name, spec.options[name], value)
    return words
