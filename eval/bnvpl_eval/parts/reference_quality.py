"""Compares the error of the references, by the difference of their halves, with what they judge."""

from typing import Any

import numpy as np
import numpy.typing as npt

from .. import references
from ..context import Context
from ..statistics import relative_weight
from ..tables import column, table

COLUMNS = [
    column("integrator", "traced from"),
    column("spp", "samples or photons a pixel, both halves"),
    column("half_difference", "RMS difference of the halves / mean"),
    column("own_relmse", "relMSE of their mean"),
    column("judged", "lowest relMSE that is judged by it"),
    column("ratio", "judged / own", better="high"),
]

FROM = {"path": "the camera", "guided": "the camera, guided", "light": "the lights"}


def own_relmse(halves: tuple[npt.NDArray[Any], npt.NDArray[Any]]) -> float:
    """relMSE of the mean of the halves, whose error is estimated as half of their difference."""
    a, b = (half.astype(np.float64) for half in halves)
    return float((((a - b) / 2) ** 2 * relative_weight((a + b) / 2)).mean())


def run(context: Context) -> None:
    rows = []
    for view in context.views():
        film = view.scene.film(context.size["film_width"])
        halves = context.halves(view)
        judged = min(
            row["relmse"]
            for row in context.results
            if row["part"] == "methods" and row["view"] == view.name
        )
        own = own_relmse(halves)
        rows.append(
            {
                "group": f"{view.scene.title}, {view.title}",
                "integrator": FROM[references.integrator_of(view, film)],
                "spp": sum(record["spp"] for record in references.require(view, film).values()),
                "half_difference": references.half_difference(halves),
                "own_relmse": own,
                "judged": judged,
                "ratio": judged / own,
            }
        )
    context.tables.append(
        table(
            "references",
            "The references",
            "Errors are products of the differences to both halves, which are right on average "
            "however noisy the halves are; "
            "SMAPE and FLIP, which have no such product, hold the references' noise.",
            COLUMNS,
            rows,
        )
    )
