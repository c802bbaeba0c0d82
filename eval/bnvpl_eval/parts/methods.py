"""Where VPLs come from: light, random, blue noise at uniform and at local density, and the thesis to the letter
(its comparisons (a)/(b), blue noise against random, literal against guarded scatter)."""

from ..context import Context
from ..pipeline import METHODS

COLUMNS = [
    {"key": "label", "label": "VPLs", "better": None},
    {"key": "seeds", "label": "seeds", "better": None},
    {"key": "mean_ratio", "label": "mean ratio", "better": "one"},
    {"key": "rmse_over_mean", "label": "RMSE / mean", "better": "low"},
    {"key": "bias_over_mean", "label": "bias / mean", "better": "low"},
    {"key": "std_over_mean", "label": "noise / mean", "better": "low"},
    {"key": "relmse", "label": "relMSE", "better": "low"},
    {"key": "smape", "label": "SMAPE", "better": "low"},
    {"key": "flip", "label": "FLIP", "better": "low"},
    {"key": "hdr_flip", "label": "HDR-FLIP", "better": "low"},
    {"key": "cpu_s", "label": "time", "unit": "CPU s", "better": "low"},
]


def run(context: Context) -> None:
    rows = []
    for view in context.views():
        for method in context.size["methods"]:
            context.say(f"methods: {view.name}, {method}")
            c = context.configuration(view, method)
            row = context.judge("methods", view, c, context.seeds(view), label=METHODS[method])
            row |= perceived(context, view, row)
            rows.append(row | {"group": group(view, c.vpls)})
    context.tables.append({
        "id": "methods", "title": "Where VPLs come from: indirect light against the path tracer",
        "note": "Means over the seeds. RMSE, bias and noise are root mean squares over pixels and channels over "
                "the reference's mean; bias is the mean image against the reference, noise the standard deviation "
                "of one image. Time is the CPU time of all stages together.",
        "columns": COLUMNS, "rows": [{key: row.get(key) for key in ["group", *(c["key"] for c in COLUMNS)]}
                                     for row in rows]})


def group(view, vpls: int) -> str:
    return f"{view.scene.title}, {view.title}, {vpls} VPLs"


def perceived(context: Context, view, row: dict) -> dict:
    """SMAPE and FLIP of the first seed, by vpl-inspect."""
    from .. import measures
    return measures.compare(context, view, row["images"][0])
