"""Compares sources of VPLs: the light, random, blue noise of uniform and local density, the thesis.

These are the thesis' comparisons (a) and (b), blue noise against random, and literal against
guarded scatter.
"""

from .. import measures
from ..context import Context
from ..pipeline import METHODS
from ..settings import View
from ..tables import column, table

COLUMNS = [
    column(key)
    for key in (
        "label",
        "seeds",
        "mean_ratio",
        "rmse_over_mean",
        "bias_over_mean",
        "std_over_mean",
        "relmse",
        "smape",
        "flip",
        "hdr_flip",
        "cpu_s",
    )
]


def run(context: Context) -> None:
    rows = []
    for view in context.views():
        for method in context.size["methods"]:
            context.say(f"methods: {view.name}, {method}")
            c = context.configuration(view, method)
            row = context.judge("methods", view, c, context.seeds(view), label=METHODS[method])
            row |= measures.compare_all(context, view, row["images"])
            rows.append(row | {"group": group(view, c.vpls)})
    context.tables.append(
        table(
            "methods",
            "Where VPLs come from: indirect light against the reference",
            "Means over the seeds. RMSE, bias and noise are root mean squares over pixels and "
            "channels over "
            "the reference's mean; bias is the mean image against the reference, noise the "
            "standard deviation "
            "of one image. Time is the CPU time of all stages together.",
            COLUMNS,
            rows,
        )
    )


def group(view: View, vpls: int) -> str:
    return f"{view.scene.title}, {view.title}, {vpls} VPLs"
