"""Equal time: the whole pipeline against the path tracer, at picture size.

The path tracer's relMSE falls as 1 / spp, so its error at any spp follows from one measurement on the small film,
over all seeds; the time comes from a picture that is rendered for about as long as the pipeline takes.
"""

from .. import pipeline
from ..context import Context
from ..tables import column, table

COLUMNS = [column("label", "film"), column("pipeline_s", "pipeline", "CPU s"),
           column("pipeline_relmse", "its relMSE"), column("path_spp", "path tracer in that time", "spp"),
           column("path_relmse", "its relMSE"), column("gain", "path tracer / pipeline", better="high")]
MEASURED_SPP = 64
FIRST_SPP = 4  # of the picture that tells how long a sample takes


def picture_spp(context: Context, view, c, target_s: float) -> int:
    _, short = pipeline.path_traced(context.runner, view, c.film, FIRST_SPP, 1)
    return max(1, round(FIRST_SPP * target_s / short[0].cpu_s))


def run(context: Context) -> None:
    rows = []
    for view in context.views():
        context.say(f"equal time: {view.name}")
        c = context.configuration(view, "local", picture=True)
        _, runs = pipeline.image(context.runner, view, c, 1)
        pipeline_s = sum(run.cpu_s for run in runs)
        spp = picture_spp(context, view, c, pipeline_s)
        _, picture = pipeline.path_traced(context.runner, view, c.film, spp, 1)
        equal_spp = spp * pipeline_s / picture[0].cpu_s
        judged = next(r for r in context.results if r["part"] == "methods" and r["view"] == view.name and
                      r["method"] == "local")
        path = context.judge_path("equal-time", view, view.scene.film(context.size["film_width"]), MEASURED_SPP,
                                  context.seeds(view))
        relmse = path["relmse"] * MEASURED_SPP / equal_spp
        row = {"view": view.name, "label": c.film, "pipeline_s": pipeline_s,
               "pipeline_relmse": judged["relmse"], "path_spp": round(equal_spp), "path_relmse": relmse,
               "gain": relmse / judged["relmse"] if judged["relmse"] > 0 else None}
        rows.append({"group": f"{view.scene.title}, {view.title}", **row})
        context.results.append({"part": "equal-time", "method": "local", **row})
    context.tables.append(table(
        "equal-time", "Equal time: whole pipeline against the path tracer",
        f"All stages with loading, {context.size['spp']} spp; relMSE of the indirect light, "
        "the path tracer's from the small film at "
        f"{MEASURED_SPP} spp, as 1 / spp.",
        COLUMNS, rows))
