"""Two renderers' images of one view, several seeds each -> how far apart, and how sure that is."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np
import OpenImageIO as oiio

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

from outputs import output_guard  # noqa: E402

ROUNDING = 2e-4  # relative: two float renderers differ by this where neither has noise
BLOCK = 8  # pixels: wide enough that its mean is not a single path's


def read_exr(path: Path) -> np.ndarray:
    """RGB as float64 (height, width, 3)."""
    image = oiio.ImageBuf(str(path))
    pixels = image.get_pixels(oiio.FLOAT)
    if pixels is None or pixels.size == 0:
        raise OSError(f"{path}: cannot read the image: {image.geterror()}; render it again")
    names = list(image.spec().channelnames)
    return np.stack([pixels[..., names.index(c)] for c in "RGB"], axis=-1).astype(np.float64)


def mean_and_variance(images: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Over seeds (first axis): the mean, and the variance of that mean, of each pixel."""
    count = len(images)
    if count < 2:
        raise ValueError("at least two seeds are needed for an error bar")
    return images.mean(axis=0), images.var(axis=0, ddof=1) / count


def mean_error(images: np.ndarray) -> float:
    """Standard error of the mean of a stack of one-channel images (seed, y, x).

    From the pixels, which has thousands of degrees of freedom but takes pixels as independent, or
    from the scatter of the seeds, which has few but assumes nothing: the larger.
    """
    pixels = np.sqrt(mean_and_variance(images)[1].sum()) / images[0].size
    seeds = images.mean(axis=(1, 2)).std(ddof=1) / np.sqrt(len(images))
    return float(max(pixels, seeds))


def ratio_with_error(ours: np.ndarray, cycles: np.ndarray) -> dict[str, float | None]:
    """Of one-channel stacks: ours / Cycles of the image mean, with one standard error."""
    a, b = ours.mean(), cycles.mean()
    if a == 0.0 and b == 0.0:
        return {"ours": 0.0, "cycles": 0.0, "ratio": 1.0, "error": 0.0}
    if b == 0.0 or a == 0.0:
        return {"ours": float(a), "cycles": float(b), "ratio": None, "error": None}
    error = np.hypot(mean_error(ours) / a, mean_error(cycles) / b) * a / b
    return {"ours": float(a), "cycles": float(b), "ratio": float(a / b), "error": float(error)}


def block_sums(image: np.ndarray) -> np.ndarray:
    """Sums over BLOCK x BLOCK pixels; blocks at the right and lower edge may be smaller."""
    height, width = image.shape
    sums = np.add.reduceat(image, np.arange(0, height, BLOCK), axis=0)
    return np.add.reduceat(sums, np.arange(0, width, BLOCK), axis=1)


def block_map(ours: np.ndarray, cycles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Relative difference (ours - Cycles) / Cycles of each block, and it in standard errors."""
    (a, va), (b, vb) = mean_and_variance(ours), mean_and_variance(cycles)
    difference = block_sums(a - b)
    total = block_sums(b)
    error = np.hypot(np.sqrt(block_sums(va + vb)), ROUNDING * np.abs(total))
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.where(total > 0.0, difference / total, 0.0)
        # Light in a block where Cycles has none at all, without noise: a difference beyond doubt.
        z = np.where(error > 0.0, difference / error, np.where(difference == 0.0, 0.0, 1e3))
    return relative, z


def compare(ours: np.ndarray, cycles: np.ndarray) -> dict:
    """Stacks (seed, y, x, rgb) -> figures for results.json."""
    if ours.shape[1:] != cycles.shape[1:]:
        raise ValueError(f"film sizes differ: {ours.shape[1:3]} and {cycles.shape[1:3]}")
    grey_ours, grey_cycles = ours.mean(axis=3), cycles.mean(axis=3)
    result = {"mean": ratio_with_error(grey_ours, grey_cycles)}
    for channel, name in enumerate(("red", "green", "blue")):
        result[name] = ratio_with_error(ours[..., channel], cycles[..., channel])
    relative, z = block_map(grey_ours, grey_cycles)
    worst = np.unravel_index(np.argmax(np.abs(z)), z.shape)
    result["blocks"] = {
        "count": int(z.size),
        "pixels": BLOCK,
        "mean_square_z": float(np.mean(z**2)),
        "beyond_3_errors": int((np.abs(z) > 3).sum()),
        "root_mean_square_relative": float(np.sqrt(np.mean(relative**2))),
        "worst": {
            "x": int(worst[1]) * BLOCK,
            "y": int(worst[0]) * BLOCK,
            "z": float(z[worst]),
            "relative": float(relative[worst]),
        },
    }
    return result


def display(image: np.ndarray, white: float) -> np.ndarray:
    """Linear radiance -> sRGB curve, `white` at 1."""
    x = np.clip(image / white, 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def write_picture(path: Path, title: str, ours: np.ndarray, cycles: np.ndarray) -> None:
    """Ours, Cycles, relative difference by block, and the same in standard errors, side by side."""
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
    output_guard.replace(
        path,
        output_guard.PNG,
        lambda partial: figure.savefig(partial, dpi=80, metadata={"Software": None}),
    )
    pyplot.close(figure)
