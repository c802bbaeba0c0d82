"""Compares two renderers' images of one view, several seeds each, with error bars."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

from outputs import output_guard  # noqa: E402

ROUNDING = 2e-4  # relative difference of two float renderers without noise
BLOCK = 8  # side in pixels; single paths must not dominate a block's mean


def read_exr(path: Path) -> npt.NDArray[Any]:
    """Reads RGB as float64 (height, width, 3)."""
    image = oiio.ImageBuf(str(path))
    pixels = image.get_pixels(oiio.FLOAT)
    if pixels is None or pixels.size == 0:
        raise OSError(f"{path}: cannot read the image: {image.geterror()}; render it again")
    names = list(image.spec().channelnames)
    result: npt.NDArray[Any] = np.stack(
        [pixels[..., names.index(c)] for c in "RGB"], axis=-1
    ).astype(np.float64)
    return result


def mean_and_variance(images: npt.NDArray[Any]) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Mean of each pixel over the seeds (first axis), and the variance of that mean."""
    count = len(images)
    if count < 2:
        raise ValueError("at least two seeds are needed for an error bar")
    return images.mean(axis=0), images.var(axis=0, ddof=1) / count


def mean_error(images: npt.NDArray[Any]) -> float:
    """Standard error of the mean of a stack of one-channel images (seed, y, x).

    It is the larger of two estimates. The one from pixels has thousands of degrees of freedom, but
    assumes independent pixels. The one from the scatter of the seeds has few, but assumes nothing.
    """
    pixels = np.sqrt(mean_and_variance(images)[1].sum()) / images[0].size
    seeds = images.mean(axis=(1, 2)).std(ddof=1) / np.sqrt(len(images))
    return float(max(pixels, seeds))


def ratio_with_error(ours: npt.NDArray[Any], cycles: npt.NDArray[Any]) -> dict[str, float | None]:
    """Ratio ours / Cycles of the means of one-channel stacks, with its standard error."""
    a, b = ours.mean(), cycles.mean()
    if a == 0.0 and b == 0.0:
        return {"ours": 0.0, "cycles": 0.0, "ratio": 1.0, "error": 0.0}
    if b == 0.0 or a == 0.0:
        return {"ours": float(a), "cycles": float(b), "ratio": None, "error": None}
    error = np.hypot(mean_error(ours) / a, mean_error(cycles) / b) * a / b
    return {"ours": float(a), "cycles": float(b), "ratio": float(a / b), "error": float(error)}


def block_sums(image: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Sums over BLOCK x BLOCK pixels. Blocks at the right and lower edge may be smaller."""
    height, width = image.shape
    sums = np.add.reduceat(image, np.arange(0, height, BLOCK), axis=0)
    return np.add.reduceat(sums, np.arange(0, width, BLOCK), axis=1)


def block_map(
    ours: npt.NDArray[Any], cycles: npt.NDArray[Any]
) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Difference (ours - Cycles) of each block, relative to Cycles and in standard errors.

    Both are NaN for blocks that are black in both.
    """
    (a, va), (b, vb) = mean_and_variance(ours), mean_and_variance(cycles)
    difference = block_sums(a - b)
    total = block_sums(b)
    error = np.hypot(np.sqrt(block_sums(va + vb)), ROUNDING * np.abs(total))
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(total > 0.0, difference / total, 0.0)
        # A block without noise that differs at all differs beyond doubt.
        z = np.where(error > 0.0, difference / error, np.where(difference == 0.0, 0.0, 1e3))
    black = (total == 0.0) & (difference == 0.0)
    return np.where(black, np.nan, relative), np.where(black, np.nan, z)


def compare(ours: npt.NDArray[Any], cycles: npt.NDArray[Any]) -> dict[str, Any]:
    """Compares stacks (seed, y, x, rgb). Returns the figures for results.json."""
    if ours.shape[1:] != cycles.shape[1:]:
        raise ValueError(f"film sizes differ: {ours.shape[1:3]} and {cycles.shape[1:3]}")
    grey_ours, grey_cycles = ours.mean(axis=3), cycles.mean(axis=3)
    result: dict[str, Any] = {"mean": ratio_with_error(grey_ours, grey_cycles)}
    for channel, name in enumerate(("red", "green", "blue")):
        result[name] = ratio_with_error(ours[..., channel], cycles[..., channel])
    relative, z = block_map(grey_ours, grey_cycles)
    lit = ~np.isnan(z)
    if not lit.any():
        relative, z = np.zeros_like(relative), np.zeros_like(z)
    worst = np.unravel_index(np.nanargmax(np.abs(z)), z.shape)
    result["blocks"] = {
        "count": int(lit.sum()),  # without those that are black in both
        "pixels": BLOCK,
        "mean_square_z": float(np.nanmean(z**2)),
        "beyond_3_errors": int((np.abs(z) > 3).sum()),
        "root_mean_square_relative": float(np.sqrt(np.nanmean(relative**2))),
        "worst": {
            "x": int(worst[1]) * BLOCK,
            "y": int(worst[0]) * BLOCK,
            "z": float(z[worst]),
            "relative": float(relative[worst]),
        },
    }
    return result


def display(image: npt.NDArray[Any], white: float) -> npt.NDArray[Any]:
    """Encodes linear radiance by the sRGB curve, with `white` at 1."""
    x = np.clip(image / white, 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def write_picture(path: Path, title: str, ours: npt.NDArray[Any], cycles: npt.NDArray[Any]) -> None:
    """Writes ours, Cycles, and the differences by block, relative and in standard errors."""
    mean_ours, mean_cycles = ours.mean(axis=0), cycles.mean(axis=0)
    relative, z = block_map(ours.mean(axis=3), cycles.mean(axis=3))
    lit = mean_cycles[mean_cycles > 0.0]
    white = float(np.quantile(lit, 0.97)) if lit.size else 1.0
    height, width = mean_ours.shape[:2]
    size = (16.0, 3.4 * height / width + 0.9)  # inches
    figure, axes = pyplot.subplots(1, 4, figsize=size, layout="constrained")
    figure.suptitle(title)
    for axis, name, image in ((axes[0], "ours", mean_ours), (axes[1], "Cycles", mean_cycles)):
        axis.imshow(display(image, white))
        axis.set_title(name)
    for axis, name, values, limit in (
        (axes[2], "(ours - Cycles) / Cycles", relative, 0.1),
        (axes[3], "difference / standard error", z, 4.0),
    ):
        shown = np.kron(values, np.ones((BLOCK, BLOCK)))[:height, :width]
        drawn = axis.imshow(shown, cmap="RdBu_r", vmin=-limit, vmax=limit)
        axis.set_title(name)
        figure.colorbar(drawn, ax=axis, shrink=0.8)
    for axis in axes:
        axis.set_xticks([])
        axis.set_yticks([])

    def save(partial: Path) -> None:
        figure.savefig(partial, dpi=80, metadata={"Software": None})

    output_guard.replace(path, output_guard.PNG, save)
    pyplot.close(figure)
