"""Compares every gather beside compensations, on the same virtual lights, scenes and rays.

Equal VPLs: without compensation, for each count, the same lit VPLs and samples a pixel. Equal time:
with the compensations of its size, at one count, as many samples a pixel as fit into a time that is
the same for all. Combinations that vpl-render refuses are listed with its reason. Kinds of light
spare the spikes of near points as compensations do, so a row has one of either.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import images, measures, pipeline
from ..context import Context
from ..equal_samples import TOO_LONG, fitting_spp
from ..field_methods import KINDS, explanation
from ..runner import TookTooLong, ToolFailed
from ..settings import View
from ..tables import column, table
from .convergence import series

NONE = "none"
DEFAULT = "tilecuts"  # the gather of vpl-render
DEFAULTS = (f"{DEFAULT}-near-field", f"{DEFAULT}-none")  # the first that is there is shown first
EQUAL_VPLS, EQUAL_TIME = "equal VPLs", "equal time"
CONTRIBUTIONS_WIDTH = 40  # pixels; each samples all VPLs
REFUSED = 2  # exit code of vpl-render
LAYERS = ("", "indirect")

COLUMNS = [
    column("gather", "gather"),
    column("scene", "scene"),
    {**column("vpls", "VPLs"), "decimals": 0},
    column("at", "at"),
    column("compensate", "compensation or kind of light"),
    {**column("spp", "spp"), "decimals": 0},
    column("relmse"),
    column("rmse_over_mean"),
    column("smape"),
    column("flip"),
    column("mean_ratio"),
    column("bias_over_mean"),
    column("std_over_mean"),
    column("render_cpu_s", "render", "CPU s", "low"),
    column("shadow_rays", "shadow rays a sample", better="low"),
    column("render_peak_mib", "memory", "MiB", "low"),
]


@dataclass
class Field:
    """What the part has measured so far."""

    context: Context
    rows: list[dict[str, Any]] = field(default_factory=list)
    refused: dict[str, str] = field(default_factory=dict)  # reasons, by combination
    skipped: list[str] = field(default_factory=list)  # runs that would take too long

    @property
    def size(self) -> dict[str, Any]:
        return self.context.size

    def configuration(self, view: View, gather: str, compensate: str, vpls: int) -> Any:
        c = self.context.configuration(view, self.size.get("method", "local"))
        of_kind = compensate in KINDS
        options = ("--gather", gather, "--compensate", NONE if of_kind else compensate)
        kind = ("--light", compensate) if of_kind else ()
        return c.but(
            vpls=vpls,
            candidates=vpls * self.size["candidates_per_vpl"],
            estimate=tuple(self.size.get("estimate", ())),
            render=(*options, "--fireflies", "keep", *kind, *self.size.get("render", ())),
        )

    def grouped(self) -> list[dict[str, Any]]:
        """The rows, with those that compare gathers under equal conditions one after the other."""
        scenes = [scene.title for scene in self.context.scenes]
        return sorted(
            self.rows,
            key=lambda r: (scenes.index(r["scene"]), r["at"], r["compensate"], r["vpls"]),
        )

    def unless_refused(self, gather: str, compensate: str, run: Callable[[], Any]) -> Any:
        """What run() returns; None, with the reason kept, if vpl-render refuses the combination."""
        try:
            return run()
        except ToolFailed as failed:
            if failed.exit_code != REFUSED:
                raise
            reason = failed.message.partition(": ")[2]
            self.refused.setdefault(f"{gather} with {compensate}", reason)
            return None

    def judge(self, view: View, gather: str, compensate: str, vpls: int, spp: int, at: str) -> Any:
        """Adds a row and returns it; None for a refusal."""
        c = self.configuration(view, gather, compensate, vpls).but(spp=spp)
        seeds = range(1, 1 + self.size["seeds"])
        labels = {"scene": view.scene.title, "gather": gather, "compensate": compensate, "at": at}
        row = self.unless_refused(
            gather, compensate, lambda: self.context.judge("field", view, c, seeds, **labels)
        )
        if row is None:
            return None
        row |= measures.compare_all(self.context, view, row["images"])
        row["shadow_rays"] = pipeline.shadow_rays(self.context.runner, view, c, seeds[0])
        row["group"] = f"{view.scene.title}, {vpls} VPLs, {at}, {compensate}"
        self.rows.append(row)
        return row

    def at_equal_vpls(self, view: View, gather: str) -> list[dict[str, Any]]:
        """Rows for growing counts, up to the first whose time exceeds the limit."""
        rows: list[dict[str, Any]] = []
        for count in self.size["vpls"]:
            if self.too_long(view, gather, count, rows):
                self.skipped.append(f"{gather}, {count} VPLs, {view.scene.title}")
                break
            row = self.judge(view, gather, NONE, count, self.size["spp"], EQUAL_VPLS)
            if row is None:
                break
            rows.append(row)
        return rows

    def too_long(self, view: View, gather: str, count: int, rows: list[dict[str, Any]]) -> bool:
        """Whether the count needs more CPU seconds than the limit, by its growth or by a trial."""
        limit_s: float = self.size["limit_s"]
        if expected_s(rows, count) > limit_s:
            return True
        c = self.configuration(view, gather, NONE, count)
        pipeline.lit(self.context.runner, view, c, 1)  # whose time does not count
        try:
            with self.context.runner.limited("vpl-render", limit_s):
                self.unless_refused(
                    gather, NONE, lambda: pipeline.image(self.context.runner, view, c, 1)
                )
        except TookTooLong:
            return True
        return False

    def leave_out(self, view: View, gather: str, compensate: str) -> None:
        self.skipped.append(f"{gather}, {compensate}, equal time, {view.scene.title}")

    def at_equal_time(
        self, view: View, gather: str, compensate: str, at_equal_vpls: list[dict[str, Any]]
    ) -> dict[str, Any] | None:
        """The row of as many samples as fit into the time; None if one does not, or a refusal."""
        c = self.configuration(view, gather, compensate, self.size["equal_time_vpls"])
        if expected_s(at_equal_vpls, c.vpls) > c.spp * self.size["time_s"]:
            self.leave_out(view, gather, compensate)
            return None

        runner, time_s = self.context.runner, self.size["time_s"]
        pipeline.lit(runner, view, c, 1)

        def cpu_s(spp: int) -> float:
            limit_s = TOO_LONG * spp * time_s  # beyond it, one sample takes too long
            with runner.limited("vpl-render", limit_s):
                _, runs = pipeline.image(runner, view, c.but(spp=spp), 1)
            return float(runs[-1].cpu_s)

        try:
            spp = self.unless_refused(
                gather, compensate, lambda: fitting_spp(cpu_s, c.spp, time_s)
            )
        except TookTooLong:
            spp = 0
        if spp is None:
            return None
        if spp < 1:
            self.leave_out(view, gather, compensate)
            return None
        row: dict[str, Any] | None = self.judge(
            view, gather, compensate, c.vpls, spp, EQUAL_TIME
        )
        return row


def paired(size: dict[str, Any], gather: str, compensate: str) -> bool:
    if compensate in KINDS:
        return gather == DEFAULT and compensate in size["kinds"]
    return compensate in size["compensations"] or gather in size["gathers_with_any"]


def expected_s(rows: list[dict[str, Any]], count: int) -> float:
    """CPU seconds of the next count, if the time grows as before; after one row it may stay."""
    if not rows:
        return 0.0
    last = rows[-1]
    exponent = 0.0
    if len(rows) > 1:
        before = rows[-2]
        exponent = math.log(last["render_cpu_s"] / before["render_cpu_s"]) / math.log(
            last["vpls"] / before["vpls"]
        )
    return float(last["render_cpu_s"] * (count / last["vpls"]) ** exponent)


def identity(row: dict[str, Any]) -> str:
    name = f"{row['gather']}-{row['compensate']}"
    return name if row["at"] == EQUAL_TIME else f"{name}-{row['vpls']}"


def label(row: dict[str, Any]) -> str:
    name = f"{row['gather']}, {row['compensate']}"
    return name if row["at"] == EQUAL_TIME else f"{name}, {row['vpls']:,} VPLs"


def mean_reference(context: Context, view: View) -> Path:
    """The mean of both halves, which has half of the variance of one."""
    layers = {layer: np.mean(context.halves(view, layer), axis=0) for layer in LAYERS}
    file = context.runner.cache / f"reference-{view.name}-{context.size['film_width']}.exr"
    images.write_half(file, layers, "mean of both halves of the reference")
    return file


def add_pictures(context: Context, view: View, rows: list[dict[str, Any]]) -> None:
    shown = [{"id": "reference", "label": "reference", "file": mean_reference(context, view)}]
    for row in rows:
        row["picture"] = {"scene": view.scene.id, "view": view.id, "image": identity(row)}
        shown.append(
            {
                "id": identity(row),
                "label": label(row),
                "file": row["images"][0],
                "numbers": f"in the table: mean ratio {row['mean_ratio']:.3f}, relMSE "
                f"{row['relmse']:.3g} ({row['seeds']} seeds)",
            }
        )
    names = [identity(row) for row in rows]
    vpls = context.size.get("equal_time_vpls", context.size["vpls"][0])
    c = Field(context).configuration(view, DEFAULT, NONE, vpls)
    context.pictures[view.name] = {
        "images": shown,
        "overlays": [],
        "first": next((name for name in DEFAULTS if name in names), None),
        "contributions": pipeline.contributions(
            context.runner, view, c, 1, view.scene.film(CONTRIBUTIONS_WIDTH)
        ),
    }


def add_plots(context: Context, view: View, found: dict[str, list[dict[str, Any]]]) -> None:
    seconds, error = "CPU seconds of vpl-render", "RMSE / mean of the indirect light"
    for name, x, x_label, y, y_label in (
        ("vpls", "vpls", "VPLs", "rmse_over_mean", error),
        ("render-cpu-s", "render_cpu_s", seconds, "rmse_over_mean", error),
        ("growth", "vpls", "VPLs", "render_cpu_s", seconds),
    ):
        lines = {gather: series(gather, rows, x, y) for gather, rows in found.items()}
        context.plots.append(
            {
                "id": f"field-{name}-{view.scene.id}",
                "title": f"{view.scene.title}: {y_label.split(' of ')[0]} over {x_label}",
                "caption": f"Without compensation, {context.size['spp']} samples a pixel.",
                "x_label": x_label,
                "y_label": y_label,
                "x_log": True,
                "y_log": True,
                "series": [line for line in lines.values() if line["x"]],
            }
        )


def note(size: dict[str, Any], run: Field) -> str:
    parts = [
        "One set of lit VPLs for each scene, count and seed.",
        f"Equal VPLs: no compensation, spp {size['spp']}.",
        f"{size['seeds']} seeds.",
    ]
    if size["compensations"]:
        parts += [
            f"Equal time: {size['time_s']} CPU seconds of vpl-render, "
            f"{size['equal_time_vpls']} VPLs.",
            f"{', '.join(size['gathers_with_any'])} also with compensations other than "
            f"{' and '.join(size['compensations'])}.",
            f"Kinds of light: {DEFAULT}, no compensation.",
        ]
    if run.skipped:
        parts.append(f"Left out, as they take too long: {'; '.join(run.skipped)}.")
    parts += [f"{name}: refused ({reason})." for name, reason in sorted(run.refused.items())]
    return " ".join(parts)


def run(context: Context) -> None:
    gathers = pipeline.methods_of(context.runner, "vpl-render", "gather")
    compensations = pipeline.methods_of(context.runner, "vpl-render", "compensate")
    all_of = Field(context)
    for view in context.views("main"):
        found = {}
        for gather in gathers:
            context.say(f"field: {view.name}, {gather}")
            found[gather] = all_of.at_equal_vpls(view, gather)
        shown = []
        for compensate in (*compensations, *KINDS):
            for gather in gathers:
                if not paired(context.size, gather, compensate):
                    continue
                context.say(f"field: {view.name}, {gather}, {compensate}, equal time")
                row = all_of.at_equal_time(view, gather, compensate, found[gather])
                shown += [row] if row else []
        # The image of the most VPLs of each gather stands beside those at equal time.
        most = [rows[-1] for rows in found.values() if rows]
        if shown + most:
            add_pictures(context, view, shown + most)
        add_plots(context, view, {g: rows for g, rows in found.items() if rows})
    context.title = "Gathers of virtual point lights, on equal terms"
    context.lead = (
        "How vpl-render's gathers light the same scenes from the same VPLs. Choose rows by the "
        "lists, sort by a heading, and open a gather's picture by its name."
    )
    rows = all_of.grouped()
    made = table("field", "Every gather", note(context.size, all_of), COLUMNS, rows)
    made["filters"] = ["gather", "scene", "vpls", "at", "compensate"]
    for shown_row, row in zip(made["rows"], rows, strict=True):
        shown_row["picture"] = row.get("picture")
    context.tables.append(made)
    context.tables.append(explanation(gathers, compensations))
