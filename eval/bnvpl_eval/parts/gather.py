"""Compares gathers of vpl-render on the same lit files, at equal samples and at equal time.

At equal time each gather takes as many samples a pixel as fit in the time of the slowest, so that
noise counts beside its own error. Near-field rays are off, as they cost the same for all gathers.
"""

from functools import partial

from .. import images, pipeline, statistics
from ..context import Context
from ..equal_samples import MAX_SPP, fitting_spp
from ..settings import View
from ..tables import column, table

COLUMNS = [
    column("label", "gather"),
    column("mean_ratio"),
    column("rmse_over_mean"),
    column("relmse"),
    column("cut_rmse", "difference to all / mean", better="low"),
    column("shadow_rays", "shadow rays a sample", better="low"),
    column("render_cpu_s", "render", "CPU s", "low"),
    column("equal_spp", "at equal time", "spp"),
    column("equal_relmse", "its relMSE", better="low"),
]
# Those of the thesis and around it; the part `field` has all.
GATHERS = ("all", "lightcuts", "lightslice", "stochastic", "tilecuts", "ward")


def run(context: Context) -> None:
    rows = []
    plan = context.size["gather"]
    seeds = range(1, 1 + plan["seeds"])
    for view in (view for view in context.views("main") if view.scene.id in plan["scenes"]):
        context.say(f"gather: {view.name}")
        made = {}
        for gather in GATHERS:
            made[gather] = context.judge(
                "gather", view, configuration(context, view, gather), seeds, label=gather
            )
            made[gather]["shadow_rays"] = pipeline.shadow_rays(
                context.runner, view, configuration(context, view, gather), seeds[0]
            )
        # All gathers have the same samples and VPLs, so differences are errors of the gather.
        every = [images.read(file, "indirect") for file in made["all"]["images"]]
        mean = sum(b.mean() for b in every) / len(every)
        for row in made.values():
            cut = [images.read(file, "indirect") for file in row["images"]]
            difference = sum(((a - b) ** 2).mean() for a, b in zip(cut, every, strict=True)) / len(
                cut
            )
            row["cut_rmse"] = statistics.root(difference) / float(mean)
        slowest = max(row["render_cpu_s"] for row in made.values())
        for gather, row in made.items():
            c = configuration(context, view, gather)
            spp = max(1, fitting_spp(partial(cpu_s, context, view, c), c.spp, slowest))
            c = c.but(spp=spp)
            equal = context.judge("gather-equal-time", view, c, seeds, label=gather)
            row |= {"equal_spp": spp, "equal_relmse": equal["relmse"]}
        title = f"{view.scene.title}, {made['all']['vpls']} VPLs"
        rows += [{"group": title, **row} for row in made.values()]
    context.tables.append(
        table(
            "gather",
            "Gathers against all VPLs, at equal VPLs and at equal time",
            f"The same VPLs and rays, {plan['seeds']} seeds, --compensate none; a gather's own "
            "error is its "
            "difference to all VPLs. At equal time: samples a pixel in the CPU time of the "
            f"slowest, at most {MAX_SPP}.",
            COLUMNS,
            rows,
        )
    )


def cpu_s(context: Context, view: View, c: pipeline.Configuration, spp: int) -> float:
    """CPU seconds of vpl-render with so many samples a pixel."""
    _, runs = pipeline.image(context.runner, view, c.but(spp=spp), 1)
    return runs[-1].cpu_s


def configuration(context: Context, view: View, gather: str) -> pipeline.Configuration:
    plan = context.size["gather"]
    return context.configuration(view, "local").but(
        spp=plan["spp"],
        estimate=tuple(plan.get("estimate", ())),
        render=("--gather", gather, "--compensate", "none", "--fireflies", "keep"),
    )
