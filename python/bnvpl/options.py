"""The options of the tools, and command lines made of Python's keyword arguments."""

from __future__ import annotations

import difflib
import functools
import json
import os
import re
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Option:
    """An option of a tool. A flag has no type."""

    flag: str  # "--max-cut"
    names: tuple[str, ...]  # keywords: "max_cut", and the letter if there is one
    type: str  # "COUNT", "on|off"


def _printed(*words: str) -> str:
    return subprocess.run(words, capture_output=True, text=True, check=False).stdout


def _option(name: str, letter: str, type_: str) -> Option:
    names = [name.replace("-", "_"), *letter.lstrip("-")]
    return Option(f"--{name}", tuple(names), type_)


def _of_help(text: str) -> list[Option]:
    """The options that --help shows, for tools whose --help-json has only a part of them."""
    pattern = r"^  (?:-(\w),)?--([\w-]+)(?: (?!Needs)([A-Z|\w]\S*))?"
    listed = re.findall(pattern, text, re.M)
    return [_option(name, letter, type_.partition("=")[0]) for letter, name, type_ in listed]


@functools.cache
def options_of(executable: str, command: str = "") -> dict[str, Option]:
    """The options of a tool, with those of a command of vpl-inspect, by keyword."""
    try:
        spec = json.loads(_printed(executable, "--help-json"))
    except ValueError:
        spec = {}
    if "arguments" in spec:
        specs = [spec, *(c for c in spec.get("commands", []) if c["tool"].endswith(f" {command}"))]
        found = [_option(o["name"], o["letter"], o["type"]) for s in specs for o in s["options"]]
    else:
        found = _of_help(_printed(executable, "--help"))
        found += _of_help(_printed(executable, command, "--help")) if command else []
    return {name: option for option in found for name in option.names}


def _text(value: Any) -> str:
    return str(os.fspath(value) if isinstance(value, os.PathLike) else value)


def _words(option: Option, value: Any) -> list[str]:
    if value is None:
        return []
    if not option.type:
        if not isinstance(value, bool):
            raise TypeError(f"{option.names[0]} is a flag: True or False, not {value!r}")
        return [option.flag] if value else []
    if isinstance(value, bool):
        value = "on" if value else "off"
    if isinstance(value, Mapping):
        value = [f"{name}={_text(of)}" for name, of in value.items()]
    if not isinstance(value, list | tuple):
        return [option.flag, _text(value)]
    texts = [_text(v) for v in value]
    if "," in option.type:
        return [option.flag, ",".join(texts)]
    if option.type == "WIDTHxHEIGHT":
        return [option.flag, "x".join(texts)]
    return [word for text in texts for word in (option.flag, text)]


def words_of(tool: str, known: Mapping[str, Option], given: Mapping[str, Any]) -> list[str]:
    """Words of a command line. Raises TypeError for a keyword that is no option of the tool."""
    words = []
    for name, value in given.items():
        if name not in known:
            near = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean {near[0]}?" if near else f"; see {tool} --help"
            raise TypeError(f"{tool} has no option {name}{hint}")
        words += _words(known[name], value)
    return words
