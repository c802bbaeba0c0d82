"""Tabulates energy: mean image over the reference, and the destinations of the photons' energy."""

import json

from .. import pipeline
from ..context import Context
from ..tables import column, table

COLUMNS = [
    column("label"),
    column("mean_ratio", "mean ratio, indirect"),
    column("full_mean_ratio", "mean ratio, full image", better="one"),
    *(column(key, key, "%") for key in ("deposited", "outside", "incompatible", "hidden")),
]


def run(context: Context) -> None:
    rows = []
    for view in context.views():
        for method in context.size["methods"]:
            row = next(
                r
                for r in context.results
                if r["part"] == "methods" and r["view"] == view.name and r["method"] == method
            )
            shown = {"group": f"{view.scene.title}, {view.title}", **row}
            _, runs = pipeline.lit(context.runner, view, context.configuration(view, method), 1)
            stats = (
                json.loads(runs[-1]["stats.json"].read_text())
                if runs[-1].record["tool"] == "vpl-estimate"
                else {}
            )
            if account := stats.get("energy_W"):  # energy account of the photons
                whole = account["reflected"]
                shown |= {"deposited": 100 * account["deposited"] / whole}
                shown |= {
                    key: 100 * account["dropped_" + key] / whole
                    for key in ("outside", "incompatible", "hidden")
                }
            rows.append(shown)
    context.tables.append(
        table(
            "energy",
            "Energy",
            "Of the energy that photons leave at surfaces: deposited at VPLs, or dropped because "
            "no VPL reaches the hit (outside: it lights nothing in view), none on a compatible "
            "surface (incompatible), or in sight (hidden). "
            "Near-field rays restore what incompatible and hidden lose.",
            COLUMNS,
            rows,
        )
    )
