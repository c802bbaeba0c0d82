"""Measures and maps that vpl-inspect makes."""

import json
from pathlib import Path

from . import references
from .settings import View


def halves(context, view: View) -> dict[str, Path]:
    film = view.scene.film(context.size["film_width"])
    return {half: references.path(view, film, half) for half in "ab"}


def compare(context, view: View, image: str) -> dict:
    run = context.runner.run(
        "vpl-inspect", ["compare", "{image}", "{a}", "--second-half", "{b}", "--layer", "indirect", "--json"],
        {"image": Path(image), **halves(context, view)}, [])
    measured = json.loads(run["log.txt"].read_text())
    return {key: measured[key] for key in ("smape", "flip", "hdr_flip") if key in measured}
