"""Rates that are not negative, by the least squares of relative errors."""

import numpy as np


def non_negative(matrix, target, rounds=20000):
    """The x >= 0 of least |matrix x - target|, by coordinate descent: each step solves for one x_k."""
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


def rates(terms, runs):
    """{term: rate} from [(counts, measured)]; terms is {term: function of counts}."""
    measured = np.array([value for _, value in runs], float)
    columns = (
        np.array([[term(counts) for term in terms.values()] for counts, _ in runs], float)
        / measured[:, None]
    )
    scale = np.abs(columns).max(axis=0)
    scale[scale == 0] = 1
    found = non_negative(columns / scale, np.ones(len(runs))) / scale
    return {name: float(f"{rate:.4g}") for name, rate in zip(terms, found) if rate > 0}
