#!/usr/bin/env python3
"""Writes the manual pages: one for each tool from its --help-json, and the hand-written ones.

    install/make_man.py --bin build/release/bin --out share/man

Tools that are not built get no page. The words that no option tells stand in man/tools.toml; in
man/*.in, @VERSION@ and @PREFIX@ are replaced.
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
TOOLS = ("vpl-place", "vpl-eliminate", "vpl-estimate", "vpl-render", "vpl-merge", "vpl-inspect")

Json = dict[str, Any]


def built_tools(folder: Path) -> dict[str, Json]:
    """The description of each tool in the folder of the executables."""
    described = {}
    for tool in TOOLS:
        if (folder / tool).is_file():
            done = subprocess.run([folder / tool, "--help-json"], capture_output=True, check=True)
            described[tool] = json.loads(done.stdout)
    return described


def roff(text: str) -> str:
    """Text with what roff would read as requests or hyphens escaped."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("~", "\\(ti").replace("^", "\\(ha")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def signature(option: Json) -> str:
    """Bold names, and the placeholder of the value in italics."""
    if "letter" not in option:
        return f"\\fI{roff(option['name'])}\\fR"
    names = [option["letter"]] if option["letter"] else []
    names.append(f"--{option['name']}")
    text = ", ".join(f"\\fB{roff(name)}\\fR" for name in names)
    choices = roff(option["type"]).replace("|", "|\\:")  # lines may break after a bar
    return f"{text} \\fI{choices}\\fR" if choices else text


def facts(option: Json) -> str:
    """Default, unit, range and conditions, as sentences."""
    sentences = []
    if option["default"]:
        sentences.append(f"Default: {option['default']}.")
    sentences += [f"{what}: {option[key]}." for key, what in (("unit", "Unit"), ("range", "Range"))
                  if option.get(key)]
    if option.get("needs"):
        sentences.append(f"Needs {option['needs']}.")
    if option.get("excludes"):
        sentences.append(f"Not with {option['excludes']}.")
    for slot, methods in option.get("methods", {}).items():
        sentences.append(f"Only with --{slot} {' or '.join(methods)}.")
    return " ".join(sentences)


def entry(option: Json, slots: dict[str, Json]) -> Iterator[str]:
    yield ".TP"
    yield signature(option)
    first, *more = option["help"].split("\n")
    if not re.match(r"\S+:", first):  # not the name of a choice
        first = first[0].upper() + first[1:]
    yield roff(f"{first}. {facts(option)}".strip())
    listed = [line.strip().partition(": ")[::2] for line in more]
    if "letter" in option and option["name"] in slots:
        listed += [(m["name"], m["summary"]) for m in slots[option["name"]]["methods"]]
    if listed:
        yield ".RS"
        for name, meaning in listed:
            yield from (".TP", f"\\fB{roff(name)}\\fR", roff(meaning))
        yield ".RE"


def options_of(command: Json) -> Iterator[str]:
    slots = {slot["name"]: slot for slot in command.get("slots", [])}
    groups: dict[str, list[Json]] = {}
    for option in [*command["arguments"], *command["options"]]:
        groups.setdefault(option["group"], []).append(option)
    for name in sorted(groups, key=lambda g: (g == "Expert") + 2 * g.startswith("With --")):
        yield f".SS {roff(name)}"
        for option in groups[name]:
            yield from entry(option, slots)


def synopsis(command: Json) -> str:
    words = [f"\\fB{roff(command['tool'])}\\fR"]
    if "commands" in command:
        words.append("\\fICOMMAND\\fR")
    for argument in command["arguments"]:
        word = f"\\fI{roff(argument['name'])}\\fR" + (" ..." if argument["repeat"] else "")
        words.append(word if argument["required"] else f"[{word}]")
    words += [signature(o).rpartition(", ")[2] for o in command["options"] if o["required"]]
    return " ".join([*words, "[\\fIoption\\fR ...]"])


def examples_of(command: Json) -> Iterator[str]:
    for example in command["examples"]:
        purpose = example["purpose"]
        yield from (".PP", roff(f"{purpose[0].upper()}{purpose[1:]}:"))
        yield from (".PP", ".RS 4", ".nf", roff(example["command"]), ".fi", ".RE")


def page(spec: Json, words: Json) -> str:
    tool, version = spec["tool"], spec["version"]
    lines = [f'.TH {tool.upper()} 1 "" "bnvpl {version}" "User Commands"']
    lines += [".SH NAME", roff(f"{tool} - {words['name']}")]
    lines += [".SH SYNOPSIS", synopsis(spec)]
    for command in spec.get("commands", []):
        lines += [".br", synopsis(command)]
    lines += [".SH DESCRIPTION"]
    lines += [roff(line) if line else ".PP" for line in words["description"].strip().split("\n")]
    lines += [".SH OPTIONS", *options_of(spec)]
    if "commands" in spec:
        lines += [".SH COMMANDS"]
        for command in spec["commands"]:
            lines += [f".SS {roff(command['tool'])}"]
            lines += [roff(line) for line in command["summary"].split("\n")]
            for option in [*command["arguments"], *command["options"]]:
                if option["name"] not in ("help", "help-all"):
                    lines += entry(option, {})
            lines += examples_of(command)
    lines += [".SH EXAMPLES", *examples_of(spec)]
    shared = (HERE / "man" / "shared.inc").read_text().rstrip("\n")
    others = [name for name in TOOLS if name != tool]
    links = [f"\\fB{roff(name)}\\fR(1)," for name in others]
    lines += [shared, ".SH SEE ALSO", *links, "\\fBbnvpl\\fR(7),", "\\fBvpl\\fR(5)"]
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the executables")
    parser.add_argument("--out", type=Path, required=True, help="folder that gets man1, man5, man7")
    parser.add_argument("--version", required=True, help="for the hand-written pages")
    parser.add_argument("--prefix", default="/usr/local", help="where bnvpl is installed")
    arguments = parser.parse_args()
    words = tomllib.loads((HERE / "man" / "tools.toml").read_text())
    pages = {f"{tool}.1": page(spec, words[tool])
             for tool, spec in built_tools(arguments.bin).items()}
    for source in sorted((HERE / "man").glob("*.in")):
        pages[source.stem] = (
            source.read_text()
            .replace("@VERSION@", arguments.version)
            .replace("@PREFIX@", arguments.prefix)
        )
    for name, text in pages.items():
        folder = arguments.out / f"man{name[-1]}"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
