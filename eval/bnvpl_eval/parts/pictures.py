"""Makes the pictures of the report's viewer: images, the reference, dots and cut sizes.

The viewer computes error maps itself.
"""

from typing import Any

from .. import pipeline
from ..context import Context
from ..pipeline import METHODS
from ..settings import ROOT, View
from .equal_time import picture_spp

LEAKING = ["even", "literal"]
REFERENCE_SEED = 1000  # differs from the seeds of the images that are judged


def run(context: Context) -> None:
    plan = context.size["pictures"]
    for view in (view for view in context.views() if view.id in plan["views"]):
        context.say(f"pictures: {view.name}")
        shown = [reference(context, view, plan)]
        cuts = []
        leaking = LEAKING if view.id == "main" else []  # the methods of the comparison of scatters
        for method in [*reversed(plan["methods"]), *leaking]:  # ours first, beside the reference
            c = pipeline.sampled(context.configuration(view, method, plan["width"]), plan)
            file, _ = pipeline.image(context.runner, view, c, 1)
            shown.append(
                {
                    "id": method,
                    "label": METHODS[method],
                    "file": file,
                    "numbers": numbers(context, view, method),
                }
            )
            if method == "local":
                cuts.append(
                    {
                        "id": "cut",
                        "label": "Cut size, clusters a sample (tile cuts)",
                        "file": file,
                        "channel": "cutsize",
                    }
                )
                cuts.append(lightcuts(context, view, c))
                shown.append(equal_time(context, view, c))
        c = context.configuration(view, "local", plan["width"])
        context.pictures[view.name] = {
            "images": shown,
            "overlays": dots(context, view) + cuts,
            "contributions": pipeline.contributions(
                context.runner, view, c, 1, view.scene.film(min(80, plan["width"] // 2))
            ),
        }


def reference(context: Context, view: View, plan: dict[str, Any]) -> dict[str, Any]:
    """An image with many VPLs, which has less noise than the path tracer's in such a time."""
    of = plan["reference"]
    c = context.configuration(view, "local", plan["width"]).but(
        vpls=of["vpls"],
        candidates=of["vpls"] * of["candidates_per_vpl"],
        photons=of["photons"],
        spp=of["spp"],
    )
    file, _ = pipeline.image(context.runner, view, c, REFERENCE_SEED)
    return {
        "id": "reference",
        "label": f"reference: {of['vpls']} VPLs of another seed, {of['spp']} samples a pixel",
        "file": file,
    }


def numbers(context: Context, view: View, method: str) -> str:
    """Errors against the small film's reference, which shares nothing with VPLs."""
    for row in context.results:
        if (
            row["view"] == view.name
            and row["method"] == method
            and row["part"] in ("methods", "scatter")
        ):
            return (
                f"in the tables: mean ratio {row['mean_ratio']:.3f}, relMSE "
                f"{row['relmse']:.3g} ({row['seeds']} seeds)"
            )
    return ""


def lightcuts(context: Context, view: View, c: pipeline.Configuration) -> dict[str, Any]:
    cuts = c.but(render=(*c.render, "--gather", "lightcuts"))
    file, _ = pipeline.image(context.runner, view, cuts, 1)
    return {
        "id": "cut-lightcuts",
        "label": "Cut size, clusters a sample (Lightcuts)",
        "file": file,
        "channel": "cutsize",
    }


def equal_time(context: Context, view: View, c: pipeline.Configuration) -> dict[str, Any]:
    """The path tracer's image in the time that all stages take, loading included."""
    _, runs = pipeline.image(context.runner, view, c, 1)
    spp = picture_spp(context, view, c, sum(run.cpu_s for run in runs))
    path, _ = pipeline.traced(context.runner, view, c.film, spp, 1)
    return {"id": "path", "label": f"path tracer, time of ours ({spp} spp)", "file": path}


def dots(context: Context, view: View) -> list[dict[str, Any]]:
    """Figure 3.2 of the thesis: equal numbers of random and blue-noise VPLs over the view."""
    count = context.size["dots"]
    made = []
    for method in ("random", "uniform", "local"):
        c = context.configuration(view, method).but(vpls=count, candidates=10 * count)
        placed = pipeline.candidates(context.runner, view, c, 1)
        kept = context.runner.run(
            "vpl-eliminate",
            ["{c}", "-n", count, *pipeline.ELIMINATE[method], "-o", "@v.vpl", "--quiet"],
            {"c": placed["candidates.vpl"]},
            ["v.vpl"],
        )
        plot = context.runner.run(
            "vpl-inspect",
            [
                "plot",
                "{v}",
                "--scene",
                "{scene}",
                "-o",
                "@dots.png",
                "--quiet",
                "--dot",
                3,
                "--size",
                view.scene.film(min(640, 4 * context.size["pictures"]["width"])),
            ],
            {"v": kept["v.vpl"], "scene": ROOT / view.file},
            ["dots.png"],
        )
        made.append(
            {
                "id": f"dots-{method}",
                "label": f"{count} VPLs, {METHODS[method]}",
                "file": plot["dots.png"],
            }
        )
    return made
