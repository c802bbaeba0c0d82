#!/usr/bin/env python3
"""Puts tables of a run into docs/lab/evaluation.md and the pages, pictures into docs/images.

    eval/write_docs.py build/eval/standard

--only limits it to some tables and pictures, for a run of some parts. A table stands between
'<!-- table ID -->' and '<!-- end -->', with the ID of report.json.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

import results_page
from bnvpl_eval import images, output, settings
from picture_label import label

DOCS = settings.ROOT / "docs"
GAP = 4  # pixels of white between two pictures
ENLARGED = 2  # factor by which crops are enlarged
FRAME = (255, 0, 200)  # colour of the frame around the enlarged crop
FULL = ["local", "reference"]  # images of each strip that are shown in full
STRIPS = {
    "methods": ["light", "random", "uniform", "local", "reference"],
    "scatter": ["reference", "local", "even", "literal"],
    "equal-time": ["path", "local", "reference"],
}
LABELS = {
    "reference": "reference",
    "light": "from the light",
    "random": "random",
    "uniform": "uniform (thesis)",
    "local": "local (ours)",
    "even": "the thesis' scatter",
    "literal": "the thesis' scatter and sites",
    "path": "path tracer",
}
LABEL_SIZE = 15  # pixels
OVERLAYS = {"dots-u-shape": ["dots-random", "dots-local"], "cuts-sponza": ["cut", "cut-lightcuts"]}
LEAST_WIDTH = 480  # minimum width of an overlay; smaller ones are enlarged by an integer
METHODS = ["light", "random", "uniform", "local"]


def number(value: Any, better: str | None) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):  # three digits of the value; the error has as many decimals
        size = abs(value["value"])
        decimals = 3 if better == "one" or size == 0 else max(0, 2 - math.floor(math.log10(size)))
        return f"{value['value']:.{decimals}f} ± {value['error']:.{decimals}f}"
    if better == "one":
        return f"{value:.3f}"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def markdown(table: dict[str, Any]) -> str:
    heads = [
        "scene",
        *(
            column["label"] + (f", {column['unit']}" if column.get("unit") else "")
            for column in table["columns"]
        ),
    ]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    group = None
    for row in table["rows"]:
        cells = [number(row.get(c["key"]), c.get("better")) for c in table["columns"]]
        lines.append(
            "| " + " | ".join([row["group"] if row["group"] != group else "", *cells]) + " |"
        )
        group = row["group"]
    return "\n".join(lines)


def table_places() -> list[str]:
    return re.findall(r"<!-- table ([\w-]+) -->", (DOCS / "lab/evaluation.md").read_text())


def write_tables(report: dict[str, Any], wanted: list[str]) -> None:
    """Writes tables, each with a comment that names the tools' commit."""
    path = DOCS / "lab/evaluation.md"
    tables = {table["id"]: table for table in report["tables"]}
    for name in wanted:
        if name not in tables:
            raise SystemExit(
                f"eval: {path}: wants table '{name}', but report.json has {', '.join(tables)}"
            )
    made = (
        f"<!-- tools of {report['provenance']['commits of the runs']}, "
        f"{report['provenance']['date']} -->"
    )

    def filled(match: re.Match[str]) -> str:
        if match[1] not in wanted:
            return match[0]
        return f"<!-- table {match[1]} -->\n{markdown(tables[match[1]])}\n\n{made}\n<!-- end -->"

    output.write_page(
        path,
        re.sub(r"<!-- table ([\w-]+) -->.*?<!-- end -->", filled, path.read_text(), flags=re.S),
    )


def write_plots(folder: Path, wanted: list[str]) -> None:
    for plot in wanted:
        subprocess.run(
            [
                sys.executable,
                settings.EVAL / "report/plots.py",
                folder / "report.json",
                plot,
                "-o",
                DOCS / "images" / f"{plot}.png",
            ],
            check=True,
        )


def srgb(pixels: npt.NDArray[Any], scale: float) -> npt.NDArray[Any]:
    x = np.clip(pixels * scale, 0, 1)
    result: npt.NDArray[Any] = np.rint(
        255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    ).astype(np.uint8)
    return result


def beside(parts: list[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    """Joins pictures in a row, with white between them."""
    gap = np.full((parts[0].shape[0], GAP, 3), 255, np.uint8)
    return np.concatenate([piece for part in parts for piece in (gap, part)][1:], axis=1)


def below(rows: list[npt.NDArray[Any]]) -> npt.NDArray[Any]:
    width = max(row.shape[1] for row in rows)
    padded = [
        np.pad(row, ((0, GAP), (0, width - row.shape[1]), (0, 0)), constant_values=255)
        for row in rows
    ]
    result: npt.NDArray[Any] = np.concatenate(padded)[:-GAP]
    return result


def telling_window(shown: list[npt.NDArray[Any]], height: int, width: int) -> tuple[int, int]:
    """Top and left of the window in which the pictures differ most from each other."""
    spread = np.stack([picture.astype(np.float32) for picture in shown]).std(axis=0).mean(axis=2)
    sums = np.pad(spread, ((1, 0), (1, 0))).cumsum(axis=0).cumsum(axis=1)
    inside = (
        sums[height:, width:]
        - sums[:-height, width:]
        - sums[height:, :-width]
        + sums[:-height, :-width]
    )
    top, left = np.unravel_index(inside.argmax(), inside.shape)
    return int(top), int(left)


def framed(
    picture: npt.NDArray[Any], top: int, left: int, height: int, width: int
) -> npt.NDArray[Any]:
    out = picture.copy()
    for edge in (top, top + height):
        out[max(0, edge - 1) : edge + 1, left : left + width] = FRAME
    for edge in (left, left + width):
        out[top : top + height, max(0, edge - 1) : edge + 1] = FRAME
    return out


def save_png(pixels: npt.NDArray[Any], target: Path, **how: Any) -> None:
    output.save(
        target,
        output.output_guard.PNG,
        lambda partial: Image.fromarray(pixels).save(partial, **how),
    )


def labelled(text: str, picture: npt.NDArray[Any]) -> npt.NDArray[Any]:
    image = Image.fromarray(picture)
    label(image, 0, image.height, text, LABEL_SIZE)
    return np.asarray(image)


def stops_down(radiance: npt.NDArray[Any], scale: float) -> int:
    """Stops by which a crop must be darkened for half of it not to be white; mostly 0."""
    median = float(np.median(radiance.max(axis=2))) * scale
    return max(0, math.ceil(math.log2(median))) if median > 0 else 0


def labelled_crop(name: str, radiance: npt.NDArray[Any], scale: float) -> npt.NDArray[Any]:
    stops = stops_down(radiance, scale)
    picture = srgb(radiance, scale / 2**stops)
    text = LABELS[name] + (f", −{stops} EV" if stops else "")
    return labelled(text, picture.repeat(ENLARGED, axis=0).repeat(ENLARGED, axis=1))


def write_strip(folder: Path, view: dict[str, Any], names: list[str], target: Path) -> None:
    """Writes ours and the reference in full at one exposure, above crops where `names` differ.

    Crops that would be white are darkened, and say so.
    """
    found = {image["id"]: folder / image["files"]["full"] for image in view["images"]}
    reference = images.read(found["reference"])
    # The scale maps the logarithmic mean to middle grey, as vpl-render --exposure auto does.
    luminance = reference @ np.array([0.2126, 0.7152, 0.0722])
    scale = 0.18 / np.exp(np.log(luminance[luminance > 0]).mean())
    radiance = {name: images.read(found[name]) for name in names}
    shown = {name: srgb(pixels, scale) for name, pixels in radiance.items()}
    full = [shown[name] for name in FULL]
    width = (2 * full[0].shape[1] + GAP - (len(names) - 1) * GAP) // len(names) // ENLARGED
    height = width * 3 // 4
    top, left = telling_window([shown[name] for name in names], height, width)
    window = np.s_[top : top + height, left : left + width]
    crops = [labelled_crop(name, radiance[name][window], scale) for name in names]
    full[0] = framed(full[0], top, left, height, width)
    whole = [labelled(LABELS[name], picture) for name, picture in zip(FULL, full, strict=True)]
    save_png(below([beside(whole), beside(crops)]), target, optimize=True)


def write_overlays(folder: Path, view: dict[str, Any], names: list[str], target: Path) -> None:
    found = {picture["id"]: folder / picture["file"] for picture in view["pictures"]}
    parts = [np.asarray(Image.open(found[name]).convert("RGB")) for name in names]
    times = -(-LEAST_WIDTH // parts[0].shape[1])
    save_png(beside([part.repeat(times, axis=0).repeat(times, axis=1) for part in parts]), target)


def write_pictures(report: dict[str, Any], folder: Path) -> None:
    """Writes the pictures of the main views."""
    for scene in report["scenes"]:
        view = scene["views"][0]
        for strip, names in STRIPS.items():
            write_strip(folder, view, names, DOCS / "images" / f"{strip}-{scene['id']}.png")
        for name, overlays in OVERLAYS.items():
            if name.endswith(f"-{scene['id']}"):
                write_overlays(folder, view, overlays, DOCS / "images" / f"{name}.png")


def write_summary(results: dict[str, Any]) -> None:
    """Writes the README's table: one row for each main view."""
    rows = {
        (row["view"], row["method"]): row for row in results["results"] if row["part"] == "methods"
    }
    lines = [
        "| scene, VPLs | instant radiosity | random | blue noise, uniform (thesis) | **blue noise, "
        "local (ours)** | "
        "mean / reference, ours | CPU s, ours |",
        "|---" * 7 + "|",
    ]
    scenes, table = settings.load()
    wanted = table["size"]["standard"]["scenes"]
    for scene in (scene for scene in scenes if scene.id in wanted):
        if (f"{scene.id}-main", METHODS[0]) not in rows:
            raise SystemExit(
                f"eval: the README's summary wants {scene.title}, which the run has left out"
            )
        found = [rows[f"{scene.id}-main", method] for method in METHODS]
        best = min(row["relmse"] for row in found)
        cells = [
            f"**{row['relmse']:.3g}**" if row["relmse"] == best else f"{row['relmse']:.3g}"
            for row in found
        ]
        ours = found[-1]
        lines.append(
            f"| {scene.title}, {ours['vpls']} | {' | '.join(cells)} | {ours['mean_ratio']:.3f} ± "
            f"{ours['mean_ratio_error']:.3f} | {ours['cpu_s']:.0f} |"
        )
    path = settings.ROOT / "README.md"
    text, count = re.subn(
        r"<!-- summary -->.*?<!-- end -->",
        "<!-- summary -->\n" + "\n".join(lines) + "\n<!-- end -->",
        path.read_text(),
        flags=re.S,
    )
    if count != 1:
        raise SystemExit(
            f"eval: {path}: has {count} places for the summary, '<!-- summary -->' to '<!-- end "
            "-->', not one"
        )
    output.write_page(path, text)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("folder", type=Path, help="of the run")
    parser.add_argument(
        "--only",
        help="ids of tables and plots, such as gather,scatter, 'pictures', and 'summary', of "
        "the README",
    )
    arguments = parser.parse_args()
    folder = arguments.folder
    report = json.loads((folder / "report.json").read_text())
    places, plots = table_places(), [plot["id"] for plot in report["plots"]]
    known = [*places, *plots, "summary", "pictures"]
    only = arguments.only.split(",") if arguments.only else known
    if unknown := set(only) - set(known):
        raise SystemExit(
            f"eval: {folder}: nothing named '{min(unknown)}'; there are {', '.join(known)}"
        )
    write_tables(report, [name for name in only if name in places])
    results_page.write(DOCS)
    write_plots(folder, [name for name in only if name in plots])
    if "summary" in only:
        write_summary(json.loads((folder / "results.json").read_text()))
    if "pictures" in only:
        write_pictures(report, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
