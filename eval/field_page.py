#!/usr/bin/env python3
"""Adds results of `make -C eval field` to docs/field.csv, and makes the tables of docs/field.md.

    eval/field_page.py build/eval/field

The rows of each scene replace those of an earlier run with as wide a film, so that scenes can be
run one by one. The page shows the widest films. A row for each gather: relMSE of the indirect light of each scene at equal time, without
compensation and with the default one, and shadow rays at as many VPLs.
The least error of a scene is bold, and with it those that lie within the standard errors of both.
A second table has the gathers that are too slow for that, at the least number of VPLs, a third one
the default gather with every compensation and kind of light.
"""

import argparse
import csv
import io
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from bnvpl_eval import output, settings
from bnvpl_eval.field_methods import PAGES
from bnvpl_eval.parts.field import DEFAULT
from rooms_page import put

PAGE = settings.ROOT / "docs/field.md"
COMPENSATIONS = ("none", "near-field")  # the second is the default of vpl-render
Row = dict[str, Any]

# What docs/field.csv keeps of a row.
COLUMNS = (
    *("scene", "gather", "compensate", "at", "vpls", "spp", "film", "seeds"),
    *("mean_ratio", "relmse", "relmse_error", "rmse_over_mean", "smape", "flip"),
    *("bias_over_mean", "std_over_mean", "render_cpu_s", "shadow_rays", "render_peak_mib"),
)
TEXTS = ("scene", "gather", "compensate", "at", "film", "tools", "date")
ROWS = settings.ROOT / "docs/field.csv"


def width_of(row: Row) -> int:
    return int(str(row["film"]).split("x")[0])


def rounded(entry: Any) -> Any:
    return float(f"{entry:.6g}") if isinstance(entry, float) else entry


def kept(found: dict[str, Any]) -> list[Row]:
    """The rows of a results.json as docs/field.csv has them."""
    made = {"tools": found["provenance"]["commit"], "date": found["provenance"]["date"]}
    rows = [r for r in found["results"] if r["part"] == "field"]
    return [{key: rounded(r.get(key, "")) for key in COLUMNS} | made for r in rows]


def read() -> list[Row]:
    if not ROWS.is_file():
        return []
    rows = csv.DictReader(io.StringIO(ROWS.read_text()))
    return [{k: v if k in TEXTS or not v else float(v) for k, v in row.items()} for row in rows]


def merged(before: list[Row], rows: list[Row]) -> list[Row]:
    """All rows; the new ones stand for all of their scenes and films."""
    anew = {(r["scene"], r["film"]) for r in rows}
    return [r for r in before if (r["scene"], r["film"]) not in anew] + rows


def value(row: Row) -> str:
    return f"{row['relmse']:.3g}"


def within_the_best(rows: list[Row]) -> list[Row]:
    """The row of least relMSE, and those that are not above it by more than both errors."""
    if not rows:
        return []
    best = min(rows, key=lambda r: float(r["relmse"]))
    limit = best["relmse"] + (best["relmse_error"] or 0.0)
    return [r for r in rows if r["relmse"] - (r["relmse_error"] or 0.0) <= limit]


def table(results: list[Row], gathers: Iterable[str] = ()) -> str:
    """A row for each gather that has one; those of `gathers` that have none are named below."""
    widest = max((width_of(r) for r in results), default=0)
    rows = [r for r in results if width_of(r) == widest]
    at_time = [r for r in rows if r["at"] == "equal time"]
    if not at_time:
        raise SystemExit("field_page: no row at equal time; docs/field.md has those of such a size")
    most = max(int(r["vpls"]) for r in at_time)
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    columns = [(scene, compensate) for compensate in COMPENSATIONS for scene in scenes]
    shown = {(r["gather"], r["scene"], r["compensate"]): r for r in at_time}
    best = [
        id(r)
        for column in columns
        for r in within_the_best([r for (_, *of), r in shown.items() if tuple(of) == column])
    ]
    heads = ["gather", *(f"{scene}, {compensate}" for scene, compensate in columns)]
    heads += ["shadow rays a sample"]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    too_slow: list[str] = []
    for gather in sorted({*gathers, *(r["gather"] for r in rows)}):
        cells = []
        for column in columns:
            here = shown.get((gather, *column))
            text = "-" if here is None else value(here)
            cells.append(f"**{text}**" if id(here) in best else text)
        equal = [r for r in rows if r["gather"] == gather and r["at"] == "equal VPLs"]
        rays = [r["shadow_rays"] for r in equal if int(r["vpls"]) == most]
        if all(cell == "-" for cell in cells):
            too_slow.append(gather)
            continue
        cells.append(f"{sum(rays) / len(rays):.0f}" if rays else "-")
        lines.append("| " + " | ".join([gather, *cells]) + " |")
    few = few_vpls(rows, scenes, too_slow) if too_slow else ""
    return "\n".join(lines) + few + near_light(at_time, scenes)


def near_light(at_time: list[Row], scenes: list[str]) -> str:
    """relMSE and mean of the default gather with every compensation and kind of light."""
    shown = {(r["compensate"], r["scene"]): r for r in at_time if r["gather"] == DEFAULT}
    names = dict.fromkeys(name for name, _ in shown)
    if set(names) <= set(COMPENSATIONS):
        return ""

    def cell(name: str, scene: str) -> str:
        row = shown.get((name, scene))
        return f"{value(row)} ({row['mean_ratio']:.3f})" if row else "-"

    lines = [
        f"`{DEFAULT}` with every compensation and kind of light, as above (in brackets: mean over",
        "that of the reference):",
        "",
        "| | " + " | ".join(scenes) + " |",
        "|---" * (1 + len(scenes)) + "|",
        *("| " + " | ".join([n, *(cell(n, s) for s in scenes)]) + " |" for n in names),
    ]
    return "\n\n" + "\n".join(lines)


def few_vpls(rows: list[Row], scenes: list[str], gathers: list[str]) -> str:
    """relMSE and CPU seconds of these gathers, and of the default, at the least number of VPLs."""
    equal = [r for r in rows if r["at"] == "equal VPLs"]
    if not equal:
        return f"\n\nToo slow for this time: {', '.join(gathers)}."
    count = min(int(r["vpls"]) for r in equal)
    shown = {(r["gather"], r["scene"]): r for r in equal if int(r["vpls"]) == count}
    spp = next(iter(shown.values()))["spp"]

    def cell(gather: str, scene: str) -> str:
        row = shown.get((gather, scene))
        return f"{value(row)} ({row['render_cpu_s']:.2g})" if row else "-"

    lines = [
        f"Too slow for this time: {', '.join(gathers)}. Beside the default, with {count:,} VPLs,",
        f"no compensation and spp {spp:.0f} (CPU seconds in brackets; -: beyond the limit):",
        "",
        "| gather | " + " | ".join(scenes) + " |",
        "|---" * (1 + len(scenes)) + "|",
    ]
    known = [g for g in gathers if any((g, s) in shown for s in scenes)]
    for gather in dict.fromkeys([DEFAULT, *known]):
        lines.append("| " + " | ".join([gather, *(cell(gather, s) for s in scenes)]) + " |")
    return "\n\n" + "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="of results.json")
    arguments = parser.parse_args()
    results = arguments.folder / "results.json"
    if not results.is_file():
        raise SystemExit(f"field_page: {results}: no such file; run 'make -C eval field' first")
    found = json.loads(results.read_text())
    folders = PAGES["gathers"].glob("*/theory.md")
    gathers = [theory.parent.name.replace("_", "-") for theory in folders]
    rows = merged(read(), kept(found))
    output.write_csv(ROWS, rows)
    put(PAGE, "field", table(rows, gathers))


if __name__ == "__main__":
    main()
