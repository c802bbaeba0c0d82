#!/usr/bin/env python3
"""Puts a run's tables into docs/results.md and its pictures into docs/images: write_docs.py build/eval/standard

A table stands between '<!-- table ID -->' and '<!-- end -->'; ID is that of report.json.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
from PIL import Image

from bnvpl_eval import images, output, settings

DOCS = settings.ROOT / "docs"
GAP = 4  # pixels of white between two pictures
STRIP = ["light", "random", "uniform", "local", "reference"]


def number(value, better) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return value
    if isinstance(value, dict):  # an error to as many decimals as its value
        text = number(value["value"], better)
        decimals = len(text.partition(".")[2])
        return text if "e" in text else f"{text} ± {value['error']:.{decimals}f}"
    if better == "one":
        return f"{value:.3f}"
    return f"{value:.3g}" if abs(value) < 1000 else f"{value:.0f}"


def markdown(table: dict) -> str:
    heads = ["scene", *(column["label"] + (f", {column['unit']}" if column.get("unit") else "")
                        for column in table["columns"])]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    group = None
    for row in table["rows"]:
        cells = [number(row.get(c["key"]), c.get("better")) for c in table["columns"]]
        lines.append("| " + " | ".join([row["group"] if row["group"] != group else "", *cells]) + " |")
        group = row["group"]
    return "\n".join(lines)


def write_tables(report: dict) -> None:
    path = DOCS / "results.md"
    text = path.read_text()
    tables = {table["id"]: table for table in report["tables"]}

    def filled(match: re.Match) -> str:
        if match[1] not in tables:
            raise SystemExit(f"eval: {path}: wants table '{match[1]}', but report.json has {', '.join(tables)}")
        return f"<!-- table {match[1]} -->\n{markdown(tables[match[1]])}\n<!-- end -->"

    output.write_text(path, re.sub(r"<!-- table ([\w-]+) -->.*?<!-- end -->", filled, text, flags=re.S))


def srgb(pixels: np.ndarray, scale: float) -> np.ndarray:
    x = np.clip(pixels * scale, 0, 1)
    return np.rint(255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x**(1 / 2.4) - 0.055)).astype(np.uint8)


def write_strip(folder: Path, view: dict, target: Path) -> None:
    """The methods side by side at one exposure, twice as large."""
    found = {image["id"]: folder / image["files"]["full"] for image in view["images"]}
    reference = images.read(found["reference"])
    # Middle grey for the logarithmic mean, as vpl-render --exposure auto.
    luminance = reference @ np.array([0.2126, 0.7152, 0.0722])
    scale = 0.18 / np.exp(np.log(luminance[luminance > 0]).mean())
    parts = [srgb(images.read(found[name]), scale) for name in STRIP if name in found]
    height, width = parts[0].shape[:2]
    canvas = np.full((height, len(parts) * (width + GAP) - GAP, 3), 255, np.uint8)
    for i, part in enumerate(parts):
        canvas[:, i * (width + GAP):i * (width + GAP) + width] = part
    Image.fromarray(canvas).resize((canvas.shape[1] * 2, canvas.shape[0] * 2), Image.NEAREST).save(target)


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(sys.argv[1])
    report = json.loads((folder / "report.json").read_text())
    write_tables(report)
    for scene in report["scenes"]:
        for view in scene["views"][:1]:
            write_strip(folder, view, DOCS / "images" / f"methods-{scene['id']}.png")
    for plot in report["plots"]:
        subprocess.run([sys.executable, settings.EVAL / "report/plots.py", folder / "report.json", plot["id"],
                        "-o", DOCS / "images" / f"{plot['id']}.png"], check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
