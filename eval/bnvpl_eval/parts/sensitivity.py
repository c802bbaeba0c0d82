"""Varies one option at a time, on main views. settings.toml sets samples and rays.

The other options have their defaults.
"""

from typing import Any

from ..context import Context
from ..pipeline import Configuration, sampled, told
from ..settings import View
from ..tables import column, table

COLUMNS = [
    column("value", "value"),
    *(
        column(key)
        for key in (
            "mean_ratio",
            "rmse_over_mean",
            "bias_over_mean",
            "std_over_mean",
            "relmse",
            "cpu_s",
        )
    ),
]


def varied(context: Context, view: View, entry: dict[str, Any], value: Any) -> Configuration:
    plan = context.size["sensitivity"]
    c = sampled(context.configuration(view, "local"), plan).but(photons=plan["photons"])
    match entry["stage"]:
        case "photons":
            return c.but(photons=max(1, int(c.photons * value)))
        case "candidates":
            return c.but(candidates=c.vpls * value)
        case stage:
            return c.but(**{stage: (*getattr(c, stage), entry["option"], value)})


def run(context: Context) -> None:
    plan = context.size["sensitivity"]
    rows = []
    for entry in context.settings["sensitivity"]:
        for view in (view for view in context.views("main") if view.scene.id in plan["scenes"]):
            for value in entry["values"]:
                context.say(f"sensitivity: {view.name}, {entry['title']} {value}")
                c = varied(context, view, entry, value)
                row = context.judge(
                    "sensitivity",
                    view,
                    c,
                    range(1, 1 + plan["seeds"]),
                    option=entry["id"],
                    value=value,
                )
                rows.append({"group": f"{entry['title']}: {view.scene.title}", **row})
    context.tables.append(
        table(
            "sensitivity",
            "Sensitivity: one option at a time",
            f"{plan['photons'] // 1000}k photons and {plan['seeds']} seeds; {told(plan)}; the "
            "other options at their defaults.",
            COLUMNS,
            rows,
        )
    )
