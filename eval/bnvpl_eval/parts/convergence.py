"""Plots error over the number of VPLs, and over time beside the path tracer."""

from typing import Any

from ..context import Context
from ..pipeline import METHODS, sampled, told
from ..settings import View
from ..statistics import slope


def run(context: Context) -> None:
    plan = context.size["convergence"]
    for view in (view for view in context.views("main") if view.scene.id in plan["scenes"]):
        seeds = range(1, 1 + plan["seeds"])
        found: dict[str, list[dict[str, Any]]] = {method: [] for method in plan["methods"]}
        for method, rows in found.items():
            for count in plan["counts"]:
                context.say(f"convergence: {view.name}, {method}, {count} VPLs")
                c = sampled(context.configuration(view, method), plan).but(
                    vpls=count,
                    candidates=count * plan["candidates_per_vpl"],
                    photons=plan["photons"],
                )
                rows.append(context.judge("convergence", view, c, seeds))
        path = []
        for spp in plan["path_spp"]:
            context.say(f"convergence: {view.name}, path tracer, {spp} spp")
            path.append(context.judge_path("convergence", view, c.film, spp, seeds))
        add_plots(context, view, found, path)


def series(
    label: str, rows: list[dict[str, Any]], x: str, y: str = "rmse_over_mean"
) -> dict[str, Any]:
    """A column over the column x. Points that are not positive are left out."""
    rows = [row for row in rows if row[y] > 0]
    xs, ys = [row[x] for row in rows], [row[y] for row in rows]
    made: dict[str, Any] = {
        "label": label,
        "x": xs,
        "y": ys,
        "error": [row.get("rmse_error", 0.0) for row in rows] if y == "rmse_over_mean" else [],
    }
    if len(xs) > 1:
        made["slope"] = slope(xs, ys)
    return made


def add_plots(
    context: Context, view: View, found: dict[str, Any], path: list[dict[str, Any]]
) -> None:
    common = {"y_label": "RMSE / mean of the indirect light", "x_log": True, "y_log": True}
    name = view.scene.id
    plan = context.size["convergence"]
    context.plots.append(
        {
            "id": f"convergence-vpls-{name}",
            "title": f"{view.scene.title}: error against VPLs",
            "caption": f"{plan['photons'] // 1000}k photons, {plan['candidates_per_vpl']} "
            f"candidates a VPL, {told(plan)}; "
            f"{plan['seeds']} seeds.",
            "x_label": "VPLs",
            "series": [series(METHODS[m], rows, "vpls") for m, rows in found.items()],
            **common,
        }
    )
    context.plots.append(
        {
            "id": f"convergence-time-{name}",
            "title": f"{view.scene.title}: error against time",
            "caption": f"CPU time of all stages, a film of {path[0]['film']} pixels.",
            "x_label": "CPU seconds",
            "series": [series(METHODS[m], rows, "cpu_s") for m, rows in found.items()]
            + [{**series("path tracer", path, "cpu_s"), "dash": True}],
            **common,
        }
    )
