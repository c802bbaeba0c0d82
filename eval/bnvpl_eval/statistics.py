"""Errors of a configuration over its seeds, bias and noise apart, against a reference in two halves.

With images x_s of S seeds, and halves a and b of the reference whose noise is independent:
  MSE       mean over s of mean (x_s - a)(x_s - b)        the reference's own noise cancels on average
  variance  mean of the sample variance over s            noise of one image
  bias^2    mean (m - a)(m - b) - variance / S            m the mean image, whose own noise is taken out
All over pixels and channels; each root is divided by the mean of the reference. A difference that comes out
below zero is noise, and shown as 0.
"""

import numpy as np

EPSILON = 1e-4  # of relMSE, times the squared mean of the reference: as vpl-inspect compare


def relative_weight(reference: np.ndarray) -> np.ndarray:
    """What relMSE multiplies squared errors by."""
    return 1.0 / (reference**2 + EPSILON * reference.mean() ** 2)


def root(value: float) -> float:
    return float(np.sqrt(max(value, 0.0)))


def summarise(images: list[np.ndarray], halves: tuple[np.ndarray, np.ndarray]) -> dict:
    a, b = (half.astype(np.float64) for half in halves)
    reference = (a + b) / 2
    mean = reference.mean()
    weight = relative_weight(reference)
    stack = np.stack(images).astype(np.float64)
    products = (stack - a) * (stack - b)
    mse = products.mean(axis=(1, 2, 3))
    relative = (products * weight).mean(axis=(1, 2, 3))
    ratios = stack.mean(axis=(1, 2, 3)) / mean
    # The reference's mean is known as well as its halves agree.
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
            # Of the images and of the reference: they have nothing to do with each other.
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
    """Of log y over log x, least squares."""
    lx, ly = np.log(np.asarray(x, dtype=float)), np.log(np.asarray(y, dtype=float))
    return float(np.polyfit(lx, ly, 1)[0])
