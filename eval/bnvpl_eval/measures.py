"""Measures of images by vpl-inspect compare."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from . import references
from .context import Context
from .settings import View


def halves(context: Context, view: View) -> dict[str, Path]:
    film = view.scene.film(context.size["film_width"])
    return {half: references.path(view, film, half) for half in "ab"}


MEASURES = ("smape", "flip", "hdr_flip")


def compare(context: Context, view: View, image: str) -> dict[str, Any]:
    run = context.runner.run(
        "vpl-inspect",
        ["compare", "{image}", "{a}", "--second-half", "{b}", "--layer", "indirect", "--json"],
        {"image": Path(image), **halves(context, view)},
        [],
    )
    result: dict[str, Any] = json.loads(run["log.txt"].read_text())
    return result


def compare_all(context: Context, view: View, images: list[str]) -> dict[str, Any]:
    """Means of the measures over the images, and their standard errors."""
    measured = [compare(context, view, image) for image in images]
    means: dict[str, float] = {}
    for key in MEASURES:
        values = np.array([m[key] for m in measured])
        means[key] = float(values.mean())
        if len(values) > 1:
            means[f"{key}_error"] = float(values.std(ddof=1) / np.sqrt(len(values)))
    return means
