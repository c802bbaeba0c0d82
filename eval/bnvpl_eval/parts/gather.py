"""Tile cuts and Lightcuts against all VPLs: the same lit files, error and time."""

from .. import images, statistics
from ..context import Context
from ..tables import column, table

COLUMNS = [column("label", "gather"), column("mean_ratio"), column("rmse_over_mean"), column("relmse"),
           column("cut_rmse", "difference to all / mean", better="low"),
           column("render_cpu_s", "render", "CPU s", "low")]


def run(context: Context) -> None:
    rows = []
    for view in context.views("main"):
        context.say(f"gather: {view.name}")
        seeds = context.seeds(view)
        made = {}
        for gather in ("tilecuts", "lightcuts", "all"):
            c = context.configuration(view, "local").but(render=("--gather", gather))
            made[gather] = context.judge("gather", view, c, seeds, label=gather)
        # The same samples and VPLs, so that only the cut differs.
        every = [images.read(file, "indirect") for file in made["all"]["images"]]
        mean = sum(b.mean() for b in every) / len(every)
        for gather, row in made.items():
            cut = [images.read(file, "indirect") for file in row["images"]]
            difference = sum(((a - b)**2).mean() for a, b in zip(cut, every)) / len(cut)
            row["cut_rmse"] = statistics.root(difference) / float(mean)
        title = f"{view.scene.title}, {made['all']['vpls']} VPLs"
        rows += [{"group": title, **row} for row in made.values()]
    context.tables.append(table(
        "gather", "Cuts against all VPLs",
        f"The same VPLs and rays, {context.size['seeds']} seeds; the cut's own error is its difference to all VPLs.",
        COLUMNS, rows))
