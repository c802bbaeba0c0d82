"""Compares the whole pipeline with the path tracer at equal time, on a film that outweighs loading.

Both errors are measured on the small film, over all seeds. The path tracer's relMSE falls as
1 / spp, so its error at any spp follows from one measurement. Its time comes from an image that
takes about as long as the pipeline.

The pipeline runs twice: as in the comparison of methods, and with the settings of [equal_time] in
settings.toml. At 8 samples a pixel most of the error is the variation within the pixel's footprint,
so the second run spreads the near-field rays over more samples.
"""

from typing import Any

from .. import pipeline
from ..context import Context
from ..equal_samples import samples_within
from ..pipeline import sampled, told
from ..settings import View
from ..tables import column, table

COLUMNS = [
    column("vpls", "VPLs"),
    column("spp", "samples a pixel"),
    column("film", "film"),
    column("pipeline_s", "pipeline", "CPU s"),
    column("pipeline_relmse", "its relMSE"),
    column("path_spp", "path tracer in that time", "spp"),
    column("path_relmse", "its relMSE"),
    column("gain", "path tracer / pipeline", better="high"),
    column("wall_gain", "the same by wall time", better="high"),
]
MEASURED_SPP = 64
TRIAL_SPP = 2, 16  # samples of two images whose times yield those of a sample and of loading


def picture_spp(context: Context, view: View, c: pipeline.Configuration, target_s: float) -> int:
    few, many = (
        (spp, pipeline.traced(context.runner, view, c.film, spp, 1)[1][0].cpu_s)
        for spp in TRIAL_SPP
    )
    return max(1, round(samples_within(target_s, few, many)))


def balanced(c: pipeline.Configuration, size: dict[str, Any]) -> pipeline.Configuration:
    plan = size["equal_time"]
    return sampled(c, plan).but(
        vpls=plan["vpls"],
        candidates=plan["vpls"] * plan["candidates_per_vpl"],
        photons=plan["photons"],
    )


def run(context: Context) -> None:
    rows = []
    plan = context.size["equal_time"]
    for view in (view for view in context.views() if view.id in plan["views"]):
        small = view.scene.film(context.size["film_width"])
        path = context.judge_path("equal-time", view, small, MEASURED_SPP, context.seeds(view))
        as_compared = context.configuration(view, "local", plan["film_width"])
        for c in (as_compared, balanced(as_compared, context.size)):
            context.say(f"equal time: {view.name}, {c.vpls} VPLs, {c.spp} spp")
            _, runs = pipeline.image(context.runner, view, c, 1)
            pipeline_s = sum(run.cpu_s for run in runs)
            pipeline_wall_s = sum(run.record["wall_s"] for run in runs)
            spp = picture_spp(context, view, c, pipeline_s)
            _, picture = pipeline.traced(context.runner, view, c.film, spp, 1)
            equal_spp = spp * pipeline_s / picture[0].cpu_s
            judged = context.judge("equal-time", view, c.but(film=small), context.seeds(view))
            relmse = path["relmse"] * MEASURED_SPP / equal_spp
            gain = relmse / judged["relmse"] if judged["relmse"] > 0 else None
            # Wall time favours the path tracer, which keeps both cores busier than the stages do.
            fewer = pipeline_s / picture[0].cpu_s / (pipeline_wall_s / picture[0].record["wall_s"])
            row = {
                "view": view.name,
                "vpls": c.vpls,
                "spp": c.spp,
                "film": c.film,
                "pipeline_s": pipeline_s,
                "pipeline_relmse": judged["relmse"],
                "path_spp": round(equal_spp),
                "path_relmse": relmse,
                "gain": gain,
                "wall_gain": gain * fewer if gain else None,
                "pipeline_wall_s": pipeline_wall_s,
            }
            rows.append({"group": f"{view.scene.title}, {view.title}", **row})
            context.results.append({"part": "equal-time", "method": "local", **row})
    context.tables.append(
        table(
            "equal-time",
            "Equal time: whole pipeline against the path tracer",
            "All stages with loading, seed 1; relMSE of the indirect light over all seeds, the "
            "path tracer's from the small "
            f"film at {MEASURED_SPP} spp, as 1 / spp. The first row of a view is the comparison "
            "above; the second has "
            f"{plan['vpls']} VPLs of {plan['candidates_per_vpl']} candidates each, "
            f"{plan['photons'] // 1000}k photons and "
            f"{told(plan)}.",
            COLUMNS,
            rows,
        )
    )
