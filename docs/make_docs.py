#!/usr/bin/env python3
"""Writes the tools' output that the docs show, from the tools themselves, and checks links.

    docs/make_docs.py            # rewrite the blocks that differ and docs/options.md
    docs/make_docs.py --check    # write nothing; exit 1 and name what differs

A block is a session in a shell. Each line with a $ is a command; its output follows.

    <!-- session -->
    ```
    $ vpl-inspect info lit.vpl
    lit.vpl: lit, 1000 rows, ...
    ```
    <!-- end of session -->

Each session begins in a fresh folder where SETUP has made small files, with the tools on the PATH.
A session that begins with <!-- session goes on --> runs in the folder that the previous session of
the same file has left. NORMAL replaces hashes and builds, which differ from run to run, and drops
lines of progress, times and memory. Both modes fail where a relative link in any page leads to no
file or no heading.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import make_guide_pictures
from page_links import broken_links, pages

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "eval/scaling"))
import cost_tables  # noqa: E402

STAGES = ("vpl-place", "vpl-eliminate", "vpl-estimate", "vpl-render")

# Makes the files that the commands of the blocks use. They are small, so that a test can run it.
SETUP = """
ln -s '{root}/scenes' scenes
ln -s '{root}/pipelines' pipelines
ln -s '{root}/eval' eval
mkdir -p build/release
ln -s '{bin}' build/release/bin
vpl-place scenes/cornell/scene.toml -o candidates.vpl -n 20k --quiet
vpl-eliminate candidates.vpl -o vpls.vpl -n 1k --quiet
vpl-estimate scenes/cornell/scene.toml vpls.vpl -o lit.vpl --photons 200k --quiet
vpl-render scenes/cornell/scene.toml lit.vpl -o image.exr --size 80x80 --layers all --quiet
vpl-render scenes/cornell/scene.toml -o reference.exr --integrator path --spp 64 \
--size 80x80 --layers all --quiet
"""

# Patterns and replacements for build identities and hashes; lines of progress, times and memory.
NORMAL = (
    (re.compile(r"\b(\d+\.\d+\.\d+)\+[0-9a-f]{12}\b"), r"\1"),
    (re.compile(r"\b[0-9a-f]{16}\b"), "0123456789abcdef"),
    (
        re.compile(
            r"^vpl-\w+: (.* of \S+ \(\d+ %\)(, .* left)?|\d+\.\d\d s, peak memory \d+ MiB)\n", re.M
        ),
        "",
    ),
)

SESSION = re.compile(
    r"(<!-- session(?P<on> goes on)? -->\n```[a-z]*\n)(?P<text>.*?)(```\n<!-- end of session -->)",
    re.S,
)
# Blocks that a function of BLOCKS fills: <!-- made: NAME --> ... <!-- end -->
MADE = re.compile(r"(<!-- made: (?P<name>\w+) -->\n)(?P<text>.*?)(<!-- end -->)", re.S)


def setup_block(_: object) -> str:
    return (
        "```sh\n"
        + "".join(
            f"{line.removesuffix(' --quiet')}\n"
            for line in SETUP.split("\n")
            if line.startswith("vpl-")
        )
        + "```\n"
    )


def recipes_block(_: object) -> str:
    return "".join(f"{row}\n" for row in make_guide_pictures.table())


def methods_block(bench: Bench) -> str:
    """Methods of all stages and kinds of light, with links to their theory, for pages in docs/."""
    rows = ["| option | methods |", "|---|---|"]
    for tool in STAGES:
        for slot in bench.spec(tool)["slots"]:
            folder = f"../tools/{tool.removeprefix('vpl-')}/" + (
                "" if slot["name"] == "method" else f"{slot['name']}/"
            )
            names = sorted(
                (m["name"] for m in slot["methods"]),
                key=lambda name: (name != slot["default"], name),
            )
            links = [f"[{name}]({folder}{name.replace('-', '_')}/theory.md)" for name in names]
            rows.append(methods_row(f"{tool} --{slot['name']}", links))
    kinds = {page.parent.name for page in ROOT.glob("transport/virtual_light/*/theory.md")}
    links = [f"[{k}](../transport/virtual_light/{k}/theory.md)" for k in sorted(kinds - {"point"})]
    point = "[point](../transport/virtual_light/point/theory.md)"
    rows.append(methods_row("vpl-render --light", [point, *links]))
    return "".join(f"{row}\n" for row in rows)


def methods_row(option: str, links: list[str]) -> str:
    """A row of methods_block; the first link is that of the default."""
    return f"| `{option}` | **{links[0]}**{''.join(f', {link}' for link in links[1:])} |"


def cost_block(part: Callable[[dict[str, Any]], list[str]]) -> str:
    """A table of pipelines/cost_model.json, which eval/scaling/cost_model.py measures."""
    return "".join(
        f"{row}\n" for row in part(json.loads((ROOT / "pipelines/cost_model.json").read_text()))
    )


BLOCKS: dict[str, Callable[[Bench], str]] = {
    "setup": setup_block,
    "recipes": recipes_block,
    "methods": methods_block,
    "cost_rates": lambda _: cost_block(cost_tables.rates),
    "cost_summary": lambda _: cost_block(cost_tables.summary),
}


def normal(text: str) -> str:
    for pattern, instead in NORMAL:
        text = pattern.sub(instead, text)
    return "\n".join(line.rstrip() for line in text.splitlines()) + "\n"


def same(a: str, b: str) -> bool:
    """Whether texts are equal but for numbers that differ by 2 % or a unit of the last digit.

    The last digits of numbers depend on the processor.
    """
    number = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
    if number.sub("#", a) != number.sub("#", b):
        return False

    def unit(x: str) -> float:
        digits, _, exponent = x.partition("e")
        return 10.0 ** (int(exponent or 0) - len(digits.partition(".")[2]))

    return all(
        abs(float(x) - float(y))
        <= max(0.02 * max(abs(float(x)), abs(float(y))), 1.001 * max(unit(x), unit(y)))
        for x, y in zip(number.findall(a), number.findall(b), strict=True)
    )


def make_portable_tools(bin_folder: Path, folder: Path) -> None:
    """Fills a folder with the tools, of which stages compute the same bytes on every processor.

    Otherwise numbers of noisy images would depend on the processor by more than same() allows.
    """
    folder.mkdir()
    for tool in bin_folder.glob("vpl-*"):
        if tool.name in STAGES:
            script = folder / tool.name
            script.write_text(f'#!/bin/sh\nexec {shlex.quote(str(tool))} --processor any "$@"\n')
            script.chmod(0o755)
        else:
            (folder / tool.name).symlink_to(tool)


class Bench:
    def __init__(self, bin_folder: Path, folder: Path) -> None:
        self.folder = folder / "files"
        self.folder.mkdir()
        make_portable_tools(bin_folder, folder / "bin")
        self.own_path = f"{bin_folder}:{os.environ['PATH']}"
        self.environment = dict(
            os.environ,
            PATH=f"{folder / 'bin'}:{os.environ['PATH']}",
            COLUMNS="100",
            LC_ALL="C.UTF-8",
        )
        for name in "MAKEFLAGS", "MAKELEVEL", "NINJA_STATUS":
            self.environment.pop(name, None)
        done = self.run(SETUP.format(root=ROOT, bin=folder / "bin"))
        if done.returncode:
            raise SystemExit(f"make_docs: the set-up failed: {done.stderr}")

    def run(self, command: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["bash", "-euc", command],
            cwd=self.folder,
            env=self.environment,
            text=True,
            capture_output=True,
        )

    def spec(self, tool: str) -> Any:
        """Options and methods of a tool."""
        return json.loads(self.run(f"{tool} --help-json").stdout)

    def copy(self, folder: Path) -> Path:
        shutil.copytree(self.folder, folder, symlinks=True)
        return folder

    def session(self, text: str, folder: Path) -> str:
        """Runs the commands of a session in one shell. Returns them with their outputs.

        A session that names --processor takes the tools as they are. Others print nothing of it.
        """
        commands = [line[2:] for line in text.splitlines() if line.startswith("$ ")]
        own = any("--processor" in command for command in commands)
        environment = dict(self.environment)
        if own:
            environment["PATH"] = self.own_path
        marker = "\x1e"
        script = "status=0\n" + "".join(
            f"printf '{marker}'; (exit $status); {{ {command}\n}} 2>&1; status=$?\n"
            for command in commands
        )
        done = subprocess.run(
            ["bash", "-c", script], cwd=folder, env=environment, text=True, capture_output=True
        )
        printed = done.stdout
        if not own:
            printed = printed.replace("; for any processor", "").replace(" --processor any", "")
        return "".join(
            f"$ {command}\n{normal(output) if output.strip() else ''}"
            for command, output in zip(commands, printed.split(marker)[1:], strict=False)
        )


TOOLS = (*STAGES, "vpl-merge", "vpl-inspect")
HEAD = ["| option | type | default | unit, range | |", "|---|---|---|---|---|"]


def option_rows(options: list[dict[str, Any]]) -> Iterator[str]:
    for o in options:
        facts = ", ".join(x for x in (o.get("unit"), o.get("range")) if x)
        needs = f" Needs `{o['needs']}`." if o.get("needs") else ""
        excludes = f" Not with `{o['excludes']}`." if o.get("excludes") else ""
        kind = o["type"].replace("|", "\\|")
        text = o["help"].replace("\n  ", "<br>")
        name = o["name"] if "letter" not in o and "methods" not in o else f"--{o['name']}"
        letter = f"`{o['letter']}`, " if o.get("letter") else ""
        yield (
            f"| {letter}`{name}` | {kind or '-'} | {o['default'] or '-'} | {facts or '-'} | "
            f"{text}.{needs}{excludes} |"
        )


def own_options(command: dict[str, Any]) -> list[dict[str, Any]]:
    """Arguments and options but for slots and the options of their methods."""
    slots = {slot["name"] for slot in command.get("slots", [])}
    options = [o for o in command["options"] if "methods" not in o and o["name"] not in slots]
    return [*command["arguments"], *options]


def shared_rows(commands: list[dict[str, Any]]) -> list[str]:
    """Rows that all commands have."""
    others = [set(option_rows(own_options(command))) for command in commands[1:]]
    rows = option_rows(own_options(commands[0]))
    return [row for row in rows if all(row in other for other in others)]


def command_lines(command: dict[str, Any], known: set[str], level: str) -> Iterator[str]:
    """What a command line takes itself, without the rows that are known."""
    yield f"{level} {command['tool']}"
    yield ""
    yield command["summary"].replace("\n", "  \n")
    rows = [row for row in option_rows(own_options(command)) if row not in known]
    yield from ("", *HEAD, *rows, "")


def slot_lines(tool: str, slot: dict[str, Any]) -> Iterator[str]:
    needs = f" Needs `{slot['needs']}`." if slot["needs"] else ""
    yield from (f"### {tool} --{slot['name']}", "")
    yield f"{slot['help'][0].upper()}{slot['help'][1:]}; default `{slot['default']}`.{needs}"
    yield ""
    yield from (f"- `{method['name']}`: {method['summary']}" for method in slot["methods"])
    yield ""
    for method in slot["methods"]:
        if method["options"]:
            yield from (f"With `--{slot['name']} {method['name']}`:", "", *HEAD)
            yield from option_rows([{**o, "methods": {}} for o in method["options"]])
            yield ""


def options_page(bench: Bench) -> str:
    lines = [
        "# Options",
        "",
        "Every option of the tools, as `--help-all` shows them; made by `docs/make_docs.py` from "
        "`--help-json`.",
        "An option of a method is refused while another method is chosen.",
        "",
    ]
    specs = {tool: bench.spec(tool) for tool in TOOLS}
    of_tools = shared_rows(list(specs.values()))
    of_stages = [
        row for row in shared_rows([specs[tool] for tool in STAGES]) if row not in of_tools
    ]
    for heading, rows in ("all tools", of_tools), ("all stages", of_stages):
        lines += [f"## Options of {heading}", "", *HEAD, *rows, ""]
    known = {*of_tools, *of_stages}
    for tool, spec in specs.items():
        lines += command_lines(spec, known, "##")
        for slot in spec.get("slots", []):
            lines += slot_lines(tool, slot)
        for command in spec.get("commands", []):
            lines += command_lines(command, known, "###")
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", action="store_true", help="write nothing")
    parser.add_argument(
        "--bin", default=ROOT / "build/release/bin", type=Path, help="folder of the executables"
    )
    arguments = parser.parse_args()
    # A session sends SIGINT, which background jobs of a shell ignore. A handler here undoes that:
    # an inherited SIG_IGN would persist in the session's processes.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    differing = 0
    with tempfile.TemporaryDirectory(prefix="bnvpl-docs.") as folder:
        bench = Bench(arguments.bin.resolve(), Path(folder))

        def renew(file: Path, old: str, new: str, what: str) -> None:
            nonlocal differing
            differing += 1
            print(f"{file.relative_to(ROOT)}: {what} differs")
            if not arguments.check:
                file.write_text(new)

        for file in pages():
            text = file.read_text()
            if "docs/lab" in str(file):
                continue
            sessions = 0

            def block(match: re.Match[str], file: Path = file) -> str:
                nonlocal sessions
                if not match["on"]:
                    sessions += 1
                page = "-".join(file.relative_to(ROOT).with_suffix("").parts)
                here = Path(folder) / f"{page}-{sessions}"
                now = bench.session(match["text"], here if here.exists() else bench.copy(here))
                if same(now, match["text"]):
                    return match[0]
                print(f"  {match['text'].splitlines()[0]}")
                if arguments.check:
                    print(now)
                return f"{match[1]}{now}{match[4]}"

            new = SESSION.sub(block, text)
            new = MADE.sub(lambda match: f"{match[1]}{BLOCKS[match['name']](bench)}{match[4]}", new)
            if new != text:
                renew(file, text, new, "output")
        table = ROOT / "docs/options.md"
        page = options_page(bench)
        if not table.exists() or table.read_text() != page:
            renew(table, "", page, "the table of options")
    if differing and arguments.check:
        print("run docs/make_docs.py")
    broken = [
        f"{file.relative_to(ROOT)}: {what}" for file in pages() for what in broken_links(file)
    ]
    if broken:
        print("\n".join(broken))
    return 1 if broken or (differing and arguments.check) else 0


if __name__ == "__main__":
    sys.exit(main())
