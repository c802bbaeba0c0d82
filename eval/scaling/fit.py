"""Fits non-negative rates by the least squares of relative errors."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from cost import Counts


def non_negative(
    matrix: npt.NDArray[np.float64], target: npt.NDArray[np.float64], rounds: int = 20000
) -> npt.NDArray[np.float64]:
    """Minimises |matrix x - target| over x >= 0 by coordinate descent, one x_k at a time."""
    x, residual = np.zeros(matrix.shape[1]), np.array(target, float)
    squares = (matrix**2).sum(axis=0)
    for _ in range(rounds):
        most = 0.0
        for k, square in enumerate(squares):
            if square == 0:
                continue
            step = max(-x[k], matrix[:, k] @ residual / square)
            if step != 0:
                x[k] += step
                residual -= step * matrix[:, k]
                most = max(most, step**2 * square)
        if most < 1e-22 * (target @ target):
            break
    return x


def rates(
    terms: Mapping[str, Callable[[Counts], float]], runs: Sequence[tuple[Counts, float]]
) -> dict[str, float]:
    """Rates of the terms {name: function of counts}, from runs (counts, measured value)."""
    measured = np.array([value for _, value in runs], float)
    columns = (
        np.array([[term(counts) for term in terms.values()] for counts, _ in runs], float)
        / measured[:, None]
    )
    scale = np.abs(columns).max(axis=0)
    scale[scale == 0] = 1
    found = non_negative(columns / scale, np.ones(len(runs))) / scale
    return {name: float(f"{rate:.4g}") for name, rate in zip(terms, found, strict=True) if rate > 0}
