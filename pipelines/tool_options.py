"""Checks what the pipelines pass on to the tools, so that a mistake ends them before the work.

Each tool tells its options by --help-json. What depends on files or on other options is left to the
tool itself.
"""

import argparse
import difflib
import json
import pathlib
import re
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import stage_options
import stages

STAGES = ("place", "eliminate", "estimate", "render")
# Options of the pipelines, and the tools' options that get their values.
PASSED_ON = (
    ("candidates", "place", "--count"),
    ("vpls", "eliminate", "--count"),
    ("photons", "estimate", "--photons"),
    ("spp", "render", "--spp"),
    ("seed", "place", "--seed"),
    ("seed", "estimate", "--seed"),
    ("seed", "render", "--seed"),
)
SUFFIXES = {"": 1, "k": 1e3, "m": 1e6, "g": 1e9}
NUMBER = r"-?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
FORMS = {
    "count": (rf"({NUMBER})([kKmMgG]?)", "a whole number such as 3000, 3k or 10M"),
    "whole": (r"(\d+)()", "a whole number"),
    "real": (rf"({NUMBER})()", "a number"),
    "duration": (rf"{NUMBER}[smh]", "a duration such as 90s, 2m or 1.5h"),
    "switch": (r"on|off", "on or off"),
}
TEXTS = {
    "WIDTHxHEIGHT": (r"\d+x\d+", "WIDTHxHEIGHT such as 640x480"),
    "NAME=VALUE": (r"[^=]+=.*", "NAME=VALUE"),
}
Option = Mapping[str, Any]  # an entry of --help-json

# What is known of an option of the pipelines where its tool does not run.
COUNT: Option = {"kind": "count", "min": 1, "max": 2**53}
SEED: Option = {"kind": "whole", "min": 0, "max": 2**64 - 1}
DEFINE: Option = {"kind": "text", "type": "NAME=VALUE"}


def _number_problem(option: Option, match: re.Match[str]) -> str:
    value = float(match[1]) * SUFFIXES[match[2].lower()]
    if not option["min"] <= value <= option["max"]:
        of_range = option.get("range") or f"{option['min']} or more"
        return f"is out of range: {of_range}"
    whole = option["kind"] != "count" or abs(value - round(value)) <= 1e-15 * value
    return "" if whole else f"is not {FORMS['count'][1]}"


def problem_of(option: Option, text: str) -> str:
    """Why a text is no value of the option, such as "is not a number"; empty if it may be one."""
    kind, shown = option["kind"], option.get("type", "")
    if kind == "choice":
        choices = shown.split("|")
        near = difflib.get_close_matches(text, choices, 1)
        cure = f"did you mean {near[0]}?" if near else f"use one of {', '.join(choices)}"
        return "" if text in choices else f"is none of its choices; {cure}"
    pattern, what = FORMS.get(kind) or TEXTS.get(shown) or (r"(?s:.*)", "")
    match = re.fullmatch(pattern, text)
    if not match:
        return f"is not {what}"
    return _number_problem(option, match) if kind in ("count", "whole", "real") else ""


class Tool:
    """The options of a tool, by --name and -letter."""

    def __init__(self, stage: str, described: Mapping[str, Any]) -> None:
        self.name = f"vpl-{stage}"
        self.options: dict[str, Option] = {}
        for option in described["options"]:
            names = [f"--{option['name']}", *([option["letter"]] if option["letter"] else [])]
            self.options |= dict.fromkeys(names, option)

    def unknown(self, name: str) -> str:
        near = difflib.get_close_matches(name, self.options, 1)
        cure = f"did you mean {near[0]}?" if near else f"see {self.name} --help"
        return f"{name} is no option of {self.name}; {cure}"

    def parsed(self, words: Sequence[str]) -> Iterator[tuple[str, str, Option | None, str | None]]:
        """Gives each word of a command line that is no value, and what it may be.

        That is the name of an option, the option if there is one of that name, and its value, which
        is None if it is missing.
        """
        left = list(words)
        while left:
            word = left.pop(0)
            short = not word.startswith("--")
            name, equals, own = (word[:2], word[2:], word[2:]) if short else word.partition("=")
            option, value = self.options.get(name), own if equals else None
            takes = option is not None and option["kind"] != "flag"
            if takes and value is None and left and left[0] not in self.options:
                value = left.pop(0)
            yield word, name, option, value

    def given(self, words: Sequence[str]) -> list[str]:
        """Names of the options in the words of a command line, each as often as it occurs."""
        return [option["name"] for _, _, option, _ in self.parsed(words) if option]

    def problem_of_words(self, words: Sequence[str]) -> str:
        """What is wrong with the words of a command line; empty if nothing is."""
        for word, name, option, value in self.parsed(words):
            if not re.match("-.", word):
                return f"'{word}' is neither an option of {self.name} nor the value of one"
            if option is None:
                return self.unknown(name)
            if option["kind"] == "flag":
                continue
            if value is None:
                return f"{name} needs a value: {option['type']}"
            if problem := problem_of(option, value):
                return f"{name} '{value}' {problem}"
        return ""


def _tool(stage: str, options: argparse.Namespace) -> Tool | None:
    """What a tool tells of itself; nothing where it does not run."""
    command = [f"{options.bin}/vpl-{stage}", "--help-json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        return Tool(stage, json.loads(done.stdout))
    except (OSError, subprocess.CalledProcessError, ValueError, KeyError):
        return None


def _refuse_missing(tools: Mapping[str, Tool | None], options: argparse.Namespace) -> None:
    for stage, tool in tools.items():
        if not tool:
            executable = f"{options.bin}/vpl-{stage}"
            problem = "does not run here" if pathlib.Path(executable).exists() else "is missing"
            stage_options.refuse(
                f"{executable}: {problem}; build the project first, or pass --bin FOLDER of the "
                "executables"
            )


def _repeated(tool: Tool, flags: Sequence[str], command: Sequence[str]) -> str:
    """What is wrong with flags whose options the command, which they are part of, has already."""
    names = tool.given(command)
    for name in tool.given(flags):
        if names.count(name) > 1 and not tool.options[f"--{name}"]["repeat"]:
            return (
                f"--{name} is given to {tool.name} twice; leave it out, and use this program's own "
                "option or another --quality"
            )
    return ""


def check(
    options: argparse.Namespace, must_run: bool = True, runner_gives: Sequence[str] = ()
) -> None:
    """Refuses counts, seeds, defines and flags that the tools do not take.

    Without `must_run`, tools that do not run here are not asked, as where only nodes have them.
    `runner_gives` are options that whoever runs the commands adds to each.
    """
    tools = {stage: _tool(stage, options) for stage in STAGES}
    if must_run:
        _refuse_missing(tools, options)
    asked = [("define", pair, DEFINE) for pair in options.define]
    for name, stage, passed in PASSED_ON:
        tool = tools[stage]
        known = tool.options.get(passed) if tool else None
        asked.append((name, getattr(options, name), known or (SEED if name == "seed" else COUNT)))
    for name, text, option in asked:
        if text and (problem := problem_of(option, text)):
            stage_options.refuse(f"--{name} '{text}' {problem}")
    commands = {task.stage: task.command for task in stages.tasks_of("scene/scene.toml", options)}
    for stage, tool in tools.items():
        words = stage_options.words_of(getattr(options, f"{stage}_flags"), f"--{stage}-flags")
        if tool and (
            problem := tool.problem_of_words(words)
            or _repeated(tool, words, [*commands[stage][1:], *runner_gives])
        ):
            stage_options.refuse(f"--{stage}-flags: {problem}")
