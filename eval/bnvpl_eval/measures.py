"""Measures and maps that vpl-inspect makes."""

import json
from pathlib import Path

import numpy as np

from . import references
from .settings import View


def halves(context, view: View) -> dict[str, Path]:
    film = view.scene.film(context.size["film_width"])
    return {half: references.path(view, film, half) for half in "ab"}


MEASURES = ("smape", "flip", "hdr_flip")


def compare(context, view: View, image: str) -> dict:
    run = context.runner.run(
        "vpl-inspect",
        ["compare", "{image}", "{a}", "--second-half", "{b}", "--layer", "indirect", "--json"],
        {"image": Path(image), **halves(context, view)},
        [],
    )
    return json.loads(run["log.txt"].read_text())


def compare_all(context, view: View, images: list[str]) -> dict:
    """Means over the images, and their standard errors."""
    measured = [compare(context, view, image) for image in images]
    means = {}
    for key in MEASURES:
        values = np.array([m[key] for m in measured])
        means[key] = float(values.mean())
        if len(values) > 1:
            means[f"{key}_error"] = float(values.std(ddof=1) / np.sqrt(len(values)))
    return means
