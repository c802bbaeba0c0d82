"""Writes what a run found: results.json, results.csv, runs.csv, and report.json with its pictures."""

import csv
import io
import json
import os
import shutil
from pathlib import Path

import matplotlib
import numpy as np

from . import images
from .context import Context
from .settings import View

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (after the choice of its backend)

LAYERS = {"indirect": "Indirect light", "full": "Full image"}


def write_text(path: Path, text: str) -> None:
    partial = path.with_name(f".{path.name}.partial-{os.getpid()}")
    partial.write_text(text)
    os.replace(partial, path)


def write_all(context: Context, folder: Path, provenance: dict) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    rows = [{key: value for key, value in row.items() if key != "images"} for row in context.results]
    runs = [run.record for run in context.runner.runs.values()]
    write_text(folder / "results.json", json.dumps(
        {"provenance": provenance, "settings": context.size, "results": rows, "runs": runs}, indent=1) + "\n")
    write_csv(folder / "results.csv", rows)
    write_csv(folder / "runs.csv", [{**run, "options": " ".join(run["options"]),
                                     "inputs": " ".join(run["inputs"].values())} for run in runs])
    report = {
        "title": "Blue-noise virtual point lights: the evaluation",
        "lead": "VPLs from the light, random VPLs from the camera, the thesis' uniform blue noise, and ours at the local "
                "density of what lights the view; judged against two independent halves of a reference.",
        "provenance": provenance, "tables": context.tables, "plots": context.plots,
        "scenes": [{"id": scene.id, "title": scene.title,
                    "views": [view_entry(context, view, folder) for view in scene.views
                              if view.name in context.pictures]}
                   for scene in context.scenes]}
    write_text(folder / "report.json", json.dumps(report, indent=1) + "\n")
    return folder / "report.json"


def write_csv(path: Path, rows: list[dict]) -> None:
    columns = list(dict.fromkeys(key for row in rows for key in row))
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, columns)
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())


def view_entry(context: Context, view: View, folder: Path) -> dict:
    place = folder / "images" / view.name
    place.mkdir(parents=True, exist_ok=True)
    shown = context.pictures[view.name]
    entry = {"id": view.id, "title": f"{view.scene.title}, {view.title}", "note": view.file,
             "reference": "reference",
             "layers": [{"id": key, "title": title} for key, title in LAYERS.items()],
             "images": [], "pictures": []}
    for image in shown["images"]:
        files = {}
        for layer in LAYERS:
            target = place / f"{image['id']}-{layer}.exr"
            pixels = images.read(image["file"], "indirect" if layer == "indirect" else "")
            images.write_half(target, {"": pixels}, image["label"])
            files[layer] = str(target.relative_to(folder))
        entry["images"].append({"id": image["id"], "label": image["label"], "numbers": image.get("numbers", ""),
                                "files": files})
    for picture in shown["overlays"]:
        target, label = place / f"{picture['id']}.png", picture["label"]
        if "channel" in picture:
            label += heat_map(images.read_channel(picture["file"], picture["channel"]), target)
        else:
            shutil.copyfile(picture["file"], target)
        entry["pictures"].append({"id": picture["id"], "label": label,
                                  "file": str(target.relative_to(folder))})
    return entry


def heat_map(values: np.ndarray, target: Path) -> str:
    """A pixel for each of the image, so that the viewer can lay it over; returns the scale, in words."""
    most = float(values.max())
    plt.imsave(target, values, cmap="viridis", vmin=0, vmax=max(most, 1e-30), metadata={"Software": None})
    return f": dark 0, yellow {most:.0f}" if most >= 10 else f": dark 0, yellow {most:.3g}"
