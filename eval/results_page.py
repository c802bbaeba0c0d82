#!/usr/bin/env python3
"""Writes the short tables of docs/results.md from the full ones of docs/lab/evaluation.md.

write_docs.py, rooms_page.py and gallery.py fill that page and then call write(). A short table
stands between '<!-- short NAME -->' and '<!-- end -->'.
"""

import re
import sys
from collections.abc import Callable
from pathlib import Path

from bnvpl_eval import output, settings

Rows = list[list[str]]  # cells of a table, its head first; empty first cells repeat the row above

DOCS = settings.ROOT / "docs"
METHODS = {
    "from the light (instant radiosity)": "from the light",
    "from the light, by rejection": "by rejection",
    "random, from the camera": "random",
    "blue noise, uniform (thesis)": "uniform (thesis)",
    "blue noise, local density (ours)": "**local (ours)**",
}


def full_tables(page: str) -> dict[str, Rows]:
    """The Markdown tables between comments, by name."""
    found = {}
    for name, text in re.findall(r"<!-- (?:table )?([\w-]+) -->\n(.*?)<!-- end", page, re.DOTALL):
        rows = [
            [cell.strip() for cell in line.strip().strip("|").split("|")]
            for line in text.splitlines()
            if line.startswith("|") and not line.startswith("|---")
        ]
        for above, row in zip(rows, rows[1:], strict=False):
            row[0] = row[0] or above[0]
        found[name] = rows
    return found


def markdown(rows: Rows) -> str:
    lines, above = [], ""
    for row in rows:
        lines.append("| " + " | ".join(["" if row[0] == above else row[0], *row[1:]]) + " |")
        above = row[0]
    return "\n".join([lines[0], "|---" * len(rows[0]) + "|", *lines[1:]])


def columns(rows: Rows, *names: str) -> Rows:
    """These columns of a table."""
    places = [rows[0].index(name) for name in names]
    return [[row[place] for place in places] for row in rows]


def without_error(value: str) -> str:
    return value.partition(" ± ")[0]


def errors(rows: Rows) -> Rows:
    """relMSE of each way to place VPLs, a row for each view; mean ratio and CPU time of ours."""
    head = rows[0]
    views: dict[str, dict[str, list[str]]] = {}
    for row in rows[1:]:
        views.setdefault(row[0], {})[row[head.index("VPLs")]] = row
    relmse, mean, time = (head.index(name) for name in ("relMSE", "mean ratio", "time, CPU s"))
    table = [["view", *METHODS.values(), "mean / reference, ours", "CPU s, ours"]]
    for view, by in views.items():
        found = [without_error(by[method][relmse]) for method in METHODS]
        best = min(found, key=float)
        ours = by[list(METHODS)[-1]]
        marked = (f"**{value}**" if value == best else value for value in found)
        table.append([view, *marked, ours[mean], ours[time]])
    return table


def scatters(rows: Rows) -> Rows:
    """Mean ratio and relMSE of the default, of thesis scatter, and with VPLs that shine from their sites."""
    head = ["scene"]
    for method in ("both (default)", "even", "thesis' scatter and sites"):
        head += [f"{method}: mean ratio", "relMSE"]
    table = [head]
    for scene, _, mean, relmse in columns(rows, "scene", "scatter", "mean ratio", "relMSE")[1:]:
        if not mean:
            continue  # a row of another table's columns
        if scene != table[-1][0]:
            table.append([scene])
        table[-1] += [without_error(mean), without_error(relmse)]
    return table


def rooms(rows: Rows) -> Rows:
    """The ratios that tell most: relMSE of each other method, and FLIP of the path tracer."""
    head = ["room", "indirect", "CPU s", "indirect mean, ours / others'"]
    others = next(name for name in rows[0] if name.startswith("relMSE: "))
    flip = next(name for name in rows[0] if name.startswith("path tracer: "))
    names = others.removeprefix("relMSE: ").removesuffix(" / ours").split(", ")
    shown = [i for i, name in enumerate(names) if "redistributed" not in name]
    table = [[*head, *(f"relMSE, {names[i]}" for i in shown), "FLIP, path tracer"]]
    parts = (columns(rows, *head), columns(rows, others), columns(rows, flip))
    for row, ratios, errors_of_path in list(zip(*parts, strict=True))[1:]:
        each = ratios[0].split(", ")
        last = errors_of_path[0].split(", ")[-1]
        table.append([*row, *(each[i] for i in shown), last])
    return table


EQUAL_TIME = (
    "scene",
    "VPLs",
    "samples a pixel",
    "pipeline, CPU s",
    "its relMSE",
    "path tracer in that time, spp",
    "path tracer / pipeline",
)
SHORT: dict[str, Callable[[dict[str, Rows]], Rows]] = {
    "errors": lambda full: errors(full["methods"]),
    "equal-time": lambda full: columns(full["equal-time"], *EQUAL_TIME),
    "rooms": lambda full: rooms(full["rooms"]),
    "gallery": lambda full: full["gallery"],
    "scatter": lambda full: scatters(full["scatter"]),
}


def write(docs: Path = DOCS) -> None:
    page = docs / "results.md"
    full = full_tables((docs / "lab/evaluation.md").read_text())

    def filled(match: re.Match[str]) -> str:
        return f"<!-- short {match[1]} -->\n{markdown(SHORT[match[1]](full))}\n<!-- end -->"

    pattern = r"<!-- short ([\w-]+) -->\n.*?<!-- end -->"
    output.write_page(page, re.sub(pattern, filled, page.read_text(), flags=re.DOTALL))


if __name__ == "__main__":
    write()
    sys.exit(0)
