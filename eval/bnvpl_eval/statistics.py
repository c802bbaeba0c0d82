"""Errors of a configuration over its seeds, split into bias and noise.

Let x_s be the images of S seeds, m their mean, and a and b halves of the reference, whose noise is
independent. Means are over pixels and channels:
    MSE       mean over s of mean (x_s - a)(x_s - b)        the noise of a and b cancels on average
    variance  mean of the sample variance over s            noise of one image
    bias^2    mean (m - a)(m - b) - variance / S            without the noise of the mean image
Each root is divided by the mean of the reference. Negative estimates, due to noise, count as 0.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

EPSILON = 1e-4  # epsilon of relMSE over the squared mean, as in vpl-inspect compare


def relative_weight(reference: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Weights of the squared errors in relMSE."""
    result: npt.NDArray[Any] = 1.0 / (reference**2 + EPSILON * reference.mean() ** 2)
    return result


def root(value: float) -> float:
    return float(np.sqrt(max(value, 0.0)))


def summarise(
    images: list[npt.NDArray[Any]], halves: tuple[npt.NDArray[Any], npt.NDArray[Any]]
) -> dict[str, Any]:
    a, b = (half.astype(np.float64) for half in halves)
    reference = (a + b) / 2
    mean = reference.mean()
    weight = relative_weight(reference)
    stack = np.stack(images).astype(np.float64)
    products = (stack - a) * (stack - b)
    mse = products.mean(axis=(1, 2, 3))
    relative = (products * weight).mean(axis=(1, 2, 3))
    ratios = stack.mean(axis=(1, 2, 3)) / mean
    # Standard error of the mean of the reference, estimated from its two halves.
    reference_ratio_error = abs(a.mean() - b.mean()) / (2 * mean)
    result = {
        "seeds": len(images),
        "mean_ratio": float(ratios.mean()),
        "rmse_over_mean": root(mse.mean()) / mean,
        "relmse": float(relative.mean()),
        "reference_half_difference": root(((a - b) ** 2).mean()) / mean,
        "reference_mean_ratio_error": float(reference_ratio_error),
    }
    if len(images) > 1:
        count = len(images)
        variance = stack.var(axis=0, ddof=1)
        middle = stack.mean(axis=0)
        squared_bias = (middle - a) * (middle - b) - variance / count
        result |= {
            # The errors of the images and of the reference are independent, so they add in squares.
            "mean_ratio_error": float(
                np.hypot(ratios.std(ddof=1) / np.sqrt(count), reference_ratio_error)
            ),
            "relmse_error": float(relative.std(ddof=1) / np.sqrt(count)),
            "rmse_error": float(
                mse.std(ddof=1) / np.sqrt(count) / (2 * max(root(mse.mean()), 1e-30)) / mean
            ),
            "bias_over_mean": root(squared_bias.mean()) / mean,
            "std_over_mean": root(variance.mean()) / mean,
            "relmse_bias": max(0.0, float((squared_bias * weight).mean())),
            "relmse_variance": float((variance * weight).mean()),
        }
    return result


def slope(x: list[float], y: list[float]) -> float:
    """Slope of log y over log x by least squares."""
    lx, ly = np.log(np.asarray(x, dtype=float)), np.log(np.asarray(y, dtype=float))
    return float(np.polyfit(lx, ly, 1)[0])
