"""Tests the central claims of the papers behind ward, stochastic, lightslice and rejection.

Each claim is a row. Gathers are judged by their difference to the sum over all VPLs at the same
points, rejection by the reference.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import images, pipeline, statistics
from ..context import Context
from ..settings import View
from ..tables import column, table

COLUMNS = [
    column("label", "method"),
    column("claim", "the paper says"),
    column("measured", "measured here"),
    column("holds", "holds"),
]
CUT = 32  # cut size for stochastic and lightcuts: the minimum of lightcuts
SLICES = 100  # fewer than the default, as one clustering by the rows of all slices is slow
VPLS_A_COLUMN = 10


def run(context: Context) -> None:
    plan = context.size["claims"]
    rows = []
    for view in (view for view in context.views("main") if view.scene.id in plan["scenes"]):
        context.say(f"claims: {view.name}")
        gathers = Gathers(context, view, plan)
        for claims in (ward(gathers), stochastic(gathers), lightslice(gathers), rejection(gathers)):
            rows += [
                {
                    "group": f"{view.scene.title}, {plan['vpls']} VPLs",
                    "label": label,
                    "claim": claim,
                    "measured": measured,
                    "holds": "yes" if holds else "no",
                }
                for label, claim, measured, holds in claims
            ]
    context.tables.append(
        table(
            "claims",
            "The papers' claims, tried again",
            f"{plan['vpls']} VPLs, {plan['spp']} samples a pixel, {plan['seeds']} seeds, "
            "--compensate none. Differences are to "
            "--gather all at the same points; relative MSE is weighted as relMSE.",
            COLUMNS,
            rows,
        )
    )


class Gathers:
    """Renders one view, and computes differences to the sum over all VPLs."""

    def __init__(self, context: Context, view: View, plan: dict[str, Any]) -> None:
        self.context, self.view, self.plan = context, view, plan
        self.all = self.row("all")
        self.truth = self.images(self.all)

    def row(self, gather: str, *options: object, method: str = "local") -> dict[str, Any]:
        c = self.context.configuration(self.view, method).but(
            vpls=self.plan["vpls"],
            candidates=self.plan["vpls"] * self.plan["candidates_per_vpl"],
            photons=self.plan["photons"],
            spp=self.plan["spp"],
            estimate=tuple(self.plan.get("estimate", ())),
            render=("--gather", gather, "--compensate", "none", "--fireflies", "keep", *options),
        )
        seeds = range(1, 1 + self.plan["seeds"])
        row = self.context.judge("claims", self.view, c, seeds, label=gather)
        row["shadow_rays"] = pipeline.shadow_rays(self.context.runner, self.view, c, seeds[0])
        return row

    def images(self, row: dict[str, Any]) -> npt.NDArray[Any]:
        result: npt.NDArray[Any] = np.stack(
            [images.read(file, "indirect") for file in row["images"]]
        ).astype(np.float64)
        return result

    def differences(self, row: dict[str, Any]) -> npt.NDArray[Any]:
        result: npt.NDArray[Any] = self.images(row) - self.truth
        return result

    def rms(self, row: dict[str, Any]) -> float:
        """RMS difference over the mean."""
        return statistics.root((self.differences(row) ** 2).mean()) / float(self.truth.mean())

    def relative(self, row: dict[str, Any]) -> float:
        weight = statistics.relative_weight(self.truth.mean(axis=0))
        return float((self.differences(row) ** 2 * weight).mean())

    def ratio(self, row: dict[str, Any]) -> tuple[float, float]:
        """Ratio of the mean to that of all VPLs, and its standard error over the seeds."""
        ratios = self.images(row).mean(axis=(1, 2, 3)) / self.truth.mean(axis=(1, 2, 3))
        return float(ratios.mean()), float(ratios.std(ddof=1) / np.sqrt(len(ratios)))


def correlation(differences: npt.NDArray[Any]) -> float:
    """Correlation of the differences of horizontally neighbouring pixels."""
    return float(
        (differences[:, :, 1:] * differences[:, :, :-1]).mean()
        / max((differences**2).mean(), 1e-30)
    )


def student_t(freedom: int) -> float:
    """Two-sided 1 % quantile of Student's t."""
    return {1: 63.66, 2: 9.925, 3: 5.841, 4: 4.604, 5: 4.032, 6: 3.707, 7: 3.499}.get(freedom, 3.4)


def ward(g: Gathers) -> list[tuple[Any, ...]]:
    row = g.row("ward", "--tolerance", 0.1)
    saved, error = 1 - row["shadow_rays"] / g.all["shadow_rays"], g.rms(row)
    return [
        (
            "ward",
            "a tolerance of 10 % saves most shadow rays, and the light stays within it",
            f"{saved:.0%} of the rays are saved; RMS difference {error:.1%} of the mean",
            saved > 0.5 and error < 0.1,
        )
    ]


def stochastic(g: Gathers) -> list[tuple[Any, ...]]:
    draws, cut = (
        g.row("stochastic", "--cut", CUT),
        g.row("lightcuts", "--error", 0, "--max-cut", CUT),
    )
    fine, few = g.row("lightcuts"), g.row("stochastic")
    of_draws, of_cut = (correlation(g.differences(row)) for row in (draws, cut))
    mean, error = g.ratio(draws)
    # The squared error of draws falls as one over the number of samples.
    in_its_time = g.relative(draws) * draws["render_cpu_s"] / cut["render_cpu_s"]
    times = fine["render_cpu_s"] / (
        few["render_cpu_s"] * max(1.0, g.relative(few) / g.relative(fine))
    )
    return [
        (
            "stochastic",
            "at equal cuts its error is noise, where that of lightcuts is correlated",
            f"cuts of {CUT}: correlation of neighbouring pixels {of_draws:.2f}, lightcuts "
            f"{of_cut:.2f}",
            abs(of_draws) < 0.1 and of_cut > 0.3,
        ),
        (
            "stochastic",
            "unbiased",
            f"mean over that of all VPLs {mean:.4f} ± {error:.4f}",
            abs(mean - 1) < student_t(g.plan["seeds"] - 1) * max(error, 1e-4),
        ),
        (
            "stochastic",
            "at equal time better than lightcuts with as small cuts",
            f"cuts of {CUT}: relative MSE {in_its_time:.2g} in the time of lightcuts, which has "
            f"{g.relative(cut):.2g}",
            in_its_time < g.relative(cut),
        ),
        (
            "stochastic",
            "at the error of lightcuts (2 %, 1000) cuts of 10 are 10 times faster",
            f"{times:.2g} times as fast at its relative MSE, by samples",
            times > 10,
        ),
    ]


def lightslice(g: Gathers) -> list[tuple[Any, ...]]:
    options = ("--slices", SLICES, "--columns", g.plan["vpls"] // VPLS_A_COLUMN)
    own, one = (
        g.row("lightslice", *options),
        g.row("lightslice", *options, "--neighbour-slices", 1024),
    )
    times, rays = g.relative(one) / g.relative(own), own["shadow_rays"] / g.all["shadow_rays"]
    return [
        (
            "lightslice",
            "at equal columns, clusters of a slice's own are better than one clustering by all "
            "rows",
            f"relative MSE of one clustering {times:.2g} times as large",
            times > 1,
        ),
        (
            "lightslice",
            "near all VPLs at a fraction of the shadow rays",
            f"{options[-1]} columns: RMS difference {g.rms(own):.1%} of the mean by {rays:.0%} "
            "of the rays",
            g.rms(own) < 0.05 and rays < 0.5,
        ),
    ]


def rejection(g: Gathers) -> list[tuple[Any, ...]]:
    # --gather all adds no noise to either.
    light, chosen = (g.row("all", method=method) for method in ("light", "rejection"))
    times = light["relmse"] / chosen["relmse"]
    return [
        (
            "rejection",
            "an order of magnitude better at equal VPLs, where the camera sees little of the lit "
            "part",
            f"relMSE {chosen['relmse']:.3g}, of as many VPLs from the light "
            f"{light['relmse']:.3g}: {times:.2g} times",
            times > 10,
        )
    ]
