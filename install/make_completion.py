#!/usr/bin/env python3
"""Writes the completion of bash, zsh and fish for each tool from its --help-json.

    install/make_completion.py --bin build/release/bin --out share

The files are OUT/bash-completion/completions/TOOL, OUT/zsh/site-functions/_TOOL and
OUT/fish/vendor_completions.d/TOOL.fish. Tools that are not built get none.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

from make_man import Json, built_tools


def spellings(option: Json) -> list[str]:
    return [*([option["letter"]] if option["letter"] else []), f"--{option['name']}"]


def takes_file(option: Json) -> bool:
    return bool(option["kind"] == "file" or option["type"] == "FOLDER")


def choices(option: Json) -> str:
    return " ".join(option.get("choices", []))


def brief(option: Json) -> str:
    """The help in one short line."""
    text = str(option["help"]).split("\n")[0]
    return text if len(text) <= 100 else text.partition(";")[0]


def bash_values(options: list[Json]) -> Iterator[str]:
    """Branches for the word behind an option."""
    for option in options:
        if option["kind"] == "flag":
            continue
        if takes_file(option):
            action = "compopt -o default; return"
        elif choices(option):
            action = f'COMPREPLY=($(compgen -W "{choices(option)}" -- "$cur")); return'
        else:
            action = "return"
        yield f"    {'|'.join(spellings(option))}) {action} ;;"


def bash(spec: Json) -> str:
    tool = spec["tool"]
    name = "_" + tool.replace("-", "_")
    commands = {c["tool"].split()[1]: c for c in spec.get("commands", [])}
    words = " ".join(w for o in spec["options"] for w in spellings(o))
    lines = [
        f"# Completion of {tool} for bash.",
        f"{name}() {{",
        '  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} word command=""',
        "  COMPREPLY=()",
    ]
    if commands:
        lines += [
            '  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do',
            f"    case $word in {'|'.join(commands)}) command=$word; break ;; esac",
            "  done",
        ]
    lines += ['  case "$command $prev" in' if commands else "  case $prev in"]
    if commands:
        for command, described in commands.items():
            for line in bash_values(described["options"]):
                names, _, action = line.strip().partition(") ")
                patterns = "|".join(f'"{command} {n}"' for n in names.split("|"))
                lines.append(f"    {patterns}) {action}")
        for line in bash_values(spec["options"]):
            names, _, action = line.strip().partition(") ")
            patterns = "|".join(f'*" {n}"' for n in names.split("|"))
            lines.append(f"    {patterns}) {action}")
    else:
        lines += bash_values(spec["options"])
    lines += ["  esac", f'  local words="{words}"']
    if commands:
        every = " ".join(commands)
        lines += ["  case $command in", f'    "") words="{every} $words" ;;']
        for command, described in commands.items():
            own = " ".join(w for o in described["options"] for w in spellings(o))
            lines.append(f'    {command}) words="{own} $words" ;;')
        lines += ["  esac"]
        lines += ['  if [[ $cur == -* || $command == "" ]]; then']
    else:
        lines += ["  if [[ $cur == -* ]]; then"]
    lines += [
        '    COMPREPLY=($(compgen -W "$words" -- "$cur"))',
        "  else",
        "    compopt -o default",
        "  fi",
        "}",
        f"complete -F {name} {tool}",
    ]
    return "\n".join(lines) + "\n"


def zsh_quoted(text: str) -> str:
    for c in "\\[]:":
        text = text.replace(c, "\\" + c)
    return text.replace("'", "'\\''")


def zsh_argument(option: Json) -> str:
    help_text = zsh_quoted(brief(option))
    value = ""
    if option["kind"] != "flag":
        listed = f"({choices(option)})" if choices(option) else ""
        action = "_files" if takes_file(option) else listed or " "
        value = f":{zsh_quoted(option['type'])}:{action}"
    many = "*" if option["repeat"] else ""
    names = spellings(option)
    if len(names) == 1:
        return f"'{many}{names[0]}[{help_text}]{value}'"
    return f"'({' '.join(names)})'{{{','.join(names)}}}'[{help_text}]{value}'"


def zsh_arguments(command: Json) -> list[str]:
    lines = [zsh_argument(option) for option in command["options"]]
    for number, argument in enumerate(command["arguments"], 1):
        place = "*" if argument["repeat"] else str(number)
        lines.append(f"'{place}:{argument['name']}:_files'")
    return lines


def zsh(spec: Json) -> str:
    lines = [f"#compdef {spec['tool']}", ""]
    commands = spec.get("commands", [])
    if not commands:
        return "\n".join([*lines, " \\\n  ".join(["_arguments -s", *zsh_arguments(spec)])]) + "\n"
    own = [zsh_argument(option) for option in spec["options"]]
    lines += ["local -a commands", "commands=("]
    for command in commands:
        summary = zsh_quoted(command["summary"].split("\n")[0])
        lines.append(f"  '{command['tool'].split()[1]}:{summary}'")
    lines += [")", "local curcontext=$curcontext state line", ""]
    ends = ["'1:command:->command'", "'*::argument:->argument'"]
    lines += [" \\\n  ".join(["_arguments -C -s", *own, *ends]), "case $state in"]
    lines += ["  command) _describe command commands ;;", "  argument)", "    case $line[1] in"]
    for command in commands:
        arguments = " \\\n        ".join(["_arguments -s", *zsh_arguments(command), *own])
        lines += [f"      {command['tool'].split()[1]})", f"        {arguments} ;;"]
    return "\n".join([*lines, "    esac ;;", "esac"]) + "\n"


def fish_quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish_line(tool: str, option: Json, condition: str) -> str:
    words = ["complete", "-c", tool, *([condition] if condition else [])]
    if option["letter"]:
        words += ["-s", option["letter"].lstrip("-")]
    words += ["-l", option["name"], "-d", fish_quoted(brief(option))]
    if takes_file(option):
        words.append("-rF")
    elif choices(option):
        words += ["-x", "-a", fish_quoted(choices(option))]
    elif option["kind"] != "flag":
        words.append("-x")
    return " ".join(words)


def fish(spec: Json) -> str:
    tool = spec["tool"]
    lines = [f"# Completion of {tool} for fish."]
    lines += [fish_line(tool, option, "") for option in spec["options"]]
    for command in spec.get("commands", []):
        name = command["tool"].split()[1]
        summary = fish_quoted(command["summary"].split("\n")[0])
        lines.append(f"complete -c {tool} -n __fish_use_subcommand -f -a {name} -d {summary}")
        seen = f"-n '__fish_seen_subcommand_from {name}'"
        for option in command["options"]:
            if option["name"] not in ("help", "help-all"):
                lines.append(fish_line(tool, option, seen))
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the executables")
    parser.add_argument("--out", type=Path, required=True, help="folder, as PREFIX/share")
    arguments = parser.parse_args()
    for tool, spec in built_tools(arguments.bin).items():
        for name, text in (
            (f"bash-completion/completions/{tool}", bash(spec)),
            (f"zsh/site-functions/_{tool}", zsh(spec)),
            (f"fish/vendor_completions.d/{tool}.fish", fish(spec)),
        ):
            file = arguments.out / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
