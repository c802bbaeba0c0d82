"""One option at a time, the others at their defaults; main views alone."""

from ..context import Context
from ..settings import View

COLUMNS = [
    {"key": "value", "label": "value", "better": None},
    {"key": "mean_ratio", "label": "mean ratio", "better": "one"},
    {"key": "rmse_over_mean", "label": "RMSE / mean", "better": "low"},
    {"key": "bias_over_mean", "label": "bias / mean", "better": "low"},
    {"key": "std_over_mean", "label": "noise / mean", "better": "low"},
    {"key": "relmse", "label": "relMSE", "better": "low"},
    {"key": "cpu_s", "label": "time", "unit": "CPU s", "better": "low"},
]


def varied(context: Context, view: View, entry: dict, value):
    plan = context.size["sensitivity"]
    c = context.configuration(view, "local").but(photons=plan["photons"])
    match entry["stage"]:
        case "photons":
            return c.but(photons=max(1, int(c.photons * value)))
        case "candidates":
            return c.but(candidates=c.vpls * value)
        case stage:
            return c.but(**{stage: (entry["option"], value)})


def run(context: Context) -> None:
    plan = context.size["sensitivity"]
    rows = []
    for entry in context.settings["sensitivity"]:
        for view in (view for view in context.views("main") if view.scene.id in plan["scenes"]):
            for value in entry["values"]:
                context.say(f"sensitivity: {view.name}, {entry['title']} {value}")
                c = varied(context, view, entry, value)
                row = context.judge("sensitivity", view, c, range(1, 1 + plan["seeds"]),
                                    option=entry["id"], value=value)
                rows.append({"group": f"{entry['title']}: {view.scene.title}", **row})
    context.tables.append({
        "id": "sensitivity", "title": "Sensitivity: one option at a time",
        "note": f"{plan['photons'] // 1000}k photons and {plan['seeds']} seeds; the other options at their defaults.",
        "columns": COLUMNS, "rows": [{key: row.get(key) for key in ["group", *(c["key"] for c in COLUMNS)]}
                                     for row in rows]})
