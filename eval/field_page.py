#!/usr/bin/env python3
"""Writes the table of docs/field.md from results of `make -C eval field`.

    eval/field_page.py build/eval/field

A row for each gather: relMSE of the indirect light of each scene at equal time, and what it spends.
The least error of a scene is bold, and with it those that lie within the standard errors of both.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from bnvpl_eval import settings
from rooms_page import put

PAGE = settings.ROOT / "docs/field.md"
COMPENSATION = "near-field"  # the default of vpl-render
Row = dict[str, Any]


def value(row: Row) -> str:
    return f"{row['relmse']:.3g}"


def within_the_best(rows: list[Row]) -> list[Row]:
    """The row of least relMSE, and those that are not above it by more than both errors."""
    best = min(rows, key=lambda r: float(r["relmse"]))
    limit = best["relmse"] + best.get("relmse_error", 0.0)
    return [r for r in rows if r["relmse"] - r.get("relmse_error", 0.0) <= limit]


def growth(rows: list[Row]) -> str:
    """How many times the CPU time is that of the fewest VPLs, at the most of them."""
    by = {
        scene: sorted((r for r in rows if r["scene"] == scene), key=lambda r: int(r["vpls"]))
        for scene in {r["scene"] for r in rows}
    }
    times = [of[-1]["render_cpu_s"] / of[0]["render_cpu_s"] for of in by.values() if len(of) > 1]
    return f"{sum(times) / len(times):.1f}" if times else ""


def table(results: list[Row]) -> str:
    rows = [r for r in results if r["part"] == "field"]
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    at_time = [r for r in rows if r["at"] == "equal time"]
    most = max(int(r["vpls"]) for r in at_time)
    shown: dict[tuple[str, str], Row] = {}
    for wanted in ("none", COMPENSATION):  # the second replaces the first
        for r in at_time:
            if r["compensate"] == wanted:
                shown[r["gather"], r["scene"]] = r
    best = [
        id(r)
        for scene in scenes
        for r in within_the_best([r for (_, of), r in shown.items() if of == scene])
    ]
    heads = ["gather", *scenes, "CPU time, most VPLs / fewest", "shadow rays a sample"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for gather in sorted({r["gather"] for r in rows}):
        cells = []
        for scene in scenes:
            here = shown.get((gather, scene))
            if here is None:
                cells.append("-")
                continue
            text = f"**{value(here)}**" if id(here) in best else value(here)
            cells.append(text if here["compensate"] == COMPENSATION else f"{text} *")
        equal = [r for r in rows if r["gather"] == gather and r["at"] == "equal VPLs"]
        rays = [r["shadow_rays"] for r in equal if int(r["vpls"]) == most]
        cells += [growth(equal), f"{sum(rays) / len(rays):.0f}" if rays else "-"]
        lines.append("| " + " | ".join([gather, *cells]) + " |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="of results.json")
    arguments = parser.parse_args()
    found = json.loads((arguments.folder / "results.json").read_text())
    made = f"<!-- tools of {found['provenance']['commit']}, {found['provenance']['date']} -->"
    put(PAGE, "field", f"{table(found['results'])}\n\n{made}")


if __name__ == "__main__":
    main()
