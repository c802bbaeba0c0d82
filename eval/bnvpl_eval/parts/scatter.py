"""Compares the thesis' scatter, to all VPLs within reach, with the guarded one: how much leaks."""

import json
from typing import Any

from ..context import Context
from ..pipeline import METHODS
from ..settings import ROOT
from ..stage_runs import estimated, kept, placed, rendered
from ..tables import column, table

COLUMNS = [
    column("label", "scatter"),
    *(
        column(key)
        for key in ("mean_ratio", "rmse_over_mean", "bias_over_mean", "std_over_mean", "relmse")
    ),
    column("dark_room", "light in the dark room", "W/(m2 sr)", "low"),
]
# The scene is a lit and a dark room that share floor, ceiling and a thin wall.
ROOMS = ROOT / "scenes/test/two-rooms.toml"


def run(context: Context) -> None:
    rows: list[dict[str, Any]] = []
    for view in context.views("main"):
        for method in ("local", "even", "literal"):
            context.say(f"scatter: {view.name}, {method}")
            row = context.judge(
                "scatter",
                view,
                context.configuration(view, method),
                range(1, 1 + context.size["scatter"]["seeds"]),
                label=METHODS[method],
            )
            rows.append({"group": view.scene.title, **row})
    for scatter in ("guarded", "even"):
        rows.append(
            {
                "group": "Two closed rooms, seen in the dark one: the right answer is 0",
                "label": f"--method {scatter}",
                "mean_ratio": None,
                **dark_room(context, scatter),
            }
        )
    context.tables.append(
        table(
            "scatter",
            "The thesis' scatter against the guarded one",
            "'ours, but the thesis' scatter' changes --method alone; that with sites also spreads "
            "VPLs uniformly, shines from where they stand and has no near-field rays. "
            f"{context.size['scatter']['seeds']} seeds.",
            COLUMNS,
            rows,
        )
    )


def dark_room(context: Context, scatter: str) -> dict[str, Any]:
    tools = context.runner
    candidates = placed(tools, ROOMS, "-n", 20000)["candidates.vpl"]
    vpls = kept(tools, candidates, "-n", 500)["vpls.vpl"]
    lit = estimated(tools, ROOMS, vpls, "--photons", "1M", "--method", scatter)["lit.vpl"]
    image = rendered(tools, ROOMS, lit, "--size", "80x60", "--spp", 8)
    stats = json.loads(image["stats.json"].read_text())
    return {"dark_room": stats["mean_indirect"]}
