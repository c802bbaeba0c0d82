"""Writes the results: results.json, results.csv, runs.csv, and report.json with its pictures.

Each file replaces nothing but an older file of its kind.
"""

import csv
import functools
import io
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import numpy.typing as npt

from . import images
from .context import Context
from .guard import guarded, output_guard
from .settings import View

matplotlib.use("Agg")
import matplotlib.pyplot as plt

plt.rcParams["svg.hashsalt"] = "bnvpl"  # equal input gives equal bytes

__all__ = ["output_guard", "plt"]

LAYERS = {"indirect": "Indirect light", "full": "Full image"}


RESULTS = output_guard.json_object(
    "the results of an evaluation", "provenance", "settings", "results", "runs"
)
REPORT = output_guard.json_object("the report of an evaluation", "title", "provenance", "scenes")
CONTRIBUTIONS = output_guard.json_object("a list of contributions", "format", "rows", "pixels")
FILES = {
    "results.json": RESULTS,
    "results.csv": output_guard.CSV,
    "runs.csv": output_guard.CSV,
    "report.json": REPORT,
}


def check(folder: Path) -> None:
    """Checks, before hours of work, that write_all() will replace no other files in the folder."""
    if folder.exists() and not folder.is_dir():
        raise SystemExit(f"eval: {folder}: is no folder; name another for the results")
    for name, kind in FILES.items():
        guarded(output_guard.check, folder / name, kind)


def write_text(path: Path, text: str, kind: output_guard.Kind) -> None:
    guarded(output_guard.write, path, text, kind)


def write_page(path: Path, text: str) -> None:
    """Writes a page that was read before, so it may replace a file of any kind."""
    write_text(path, text, output_guard.Kind("a page", lambda _: True))


def save(target: Path, kind: output_guard.Kind, make: Callable[[Path], object]) -> None:
    """Replaces the target by a file that make() writes beside it, with the same extension."""
    guarded(output_guard.replace, target, kind, make)


def write_all(context: Context, folder: Path, provenance: dict[str, Any]) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    rows = [
        {key: value for key, value in row.items() if key != "images"} for row in context.results
    ]
    runs = [run.record for run in context.runner.runs.values()]
    write_text(
        folder / "results.json",
        json.dumps(
            {"provenance": provenance, "settings": context.size, "results": rows, "runs": runs},
            indent=1,
        )
        + "\n",
        RESULTS,
    )
    write_csv(folder / "results.csv", rows)
    write_csv(
        folder / "runs.csv",
        [
            {**run, "options": " ".join(run["options"]), "inputs": " ".join(run["inputs"].values())}
            for run in runs
        ],
    )
    report = {
        "title": context.title,
        "lead": context.lead,
        "provenance": provenance,
        "tables": context.tables,
        "plots": context.plots,
        "scenes": [
            {
                "id": scene.id,
                "title": scene.title,
                "views": [
                    view_entry(context, view, folder)
                    for view in scene.views
                    if view.name in context.pictures
                ],
            }
            for scene in context.scenes
        ],
    }
    write_text(folder / "report.json", json.dumps(report, indent=1) + "\n", REPORT)
    return folder / "report.json"


def write_csv(path: Path, rows: list[dict[str, Any]]) -> None:
    columns = list(dict.fromkeys(key for row in rows for key in row))
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, columns)
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue(), output_guard.CSV)


def view_entry(context: Context, view: View, folder: Path) -> dict[str, Any]:
    place = folder / "images" / view.name
    place.mkdir(parents=True, exist_ok=True)
    shown = context.pictures[view.name]
    entry: dict[str, Any] = {
        "id": view.id,
        "title": f"{view.scene.title}, {view.title}",
        "note": view.file,
        "reference": "reference",
        "first": shown.get("first"),
        "contributions": None,
        "layers": [{"id": key, "title": title} for key, title in LAYERS.items()],
        "images": [],
        "pictures": [],
    }
    if listed := shown.get("contributions"):
        target = place / "contributions.json"
        save(target, CONTRIBUTIONS, functools.partial(shutil.copyfile, listed))
        entry["contributions"] = str(target.relative_to(folder))
    for image in shown["images"]:
        files = {}
        for layer in LAYERS:
            target = place / f"{image['id']}-{layer}.exr"
            pixels = images.read(image["file"], "indirect" if layer == "indirect" else "")
            images.write_half(target, {"": pixels}, image["label"])
            files[layer] = str(target.relative_to(folder))
        entry["images"].append(
            {
                "id": image["id"],
                "label": image["label"],
                "numbers": image.get("numbers", ""),
                "files": files,
            }
        )
    for picture in shown["overlays"]:
        target, label = place / f"{picture['id']}.png", picture["label"]
        if "channel" in picture:
            label += heat_map(images.read_channel(picture["file"], picture["channel"]), target)
        else:
            save(
                target,
                output_guard.PNG,
                functools.partial(shutil.copyfile, picture["file"]),
            )
        entry["pictures"].append(
            {"id": picture["id"], "label": label, "file": str(target.relative_to(folder))}
        )
    return entry


def heat_map(values: npt.NDArray[Any], target: Path) -> str:
    """Writes one pixel for each of the image, so the viewer can overlay it. Returns the scale."""
    most = float(values.max())
    save(
        target,
        output_guard.PNG,
        lambda partial: plt.imsave(
            partial,
            values,
            cmap="viridis",
            vmin=0,
            vmax=max(most, 1e-30),
            metadata={"Software": None},
        ),
    )
    return f": dark 0, yellow {most:.0f}" if most >= 10 else f": dark 0, yellow {most:.3g}"
