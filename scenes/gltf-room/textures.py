"""Computes the room's textures: arrays of rows from bottom to top, with sRGB colours from 0 to 1.

All tile except the picture, the rug and the leaf.
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]
RNG = np.random.default_rng(4)


def noise(size: int, falloff: float, stretch: float = 1.0) -> Array:
    """Tileable noise of unit variance, stretched `stretch` times along the rows."""
    v, u = np.meshgrid(
        np.fft.fftfreq(size, 1.0) * size, np.fft.fftfreq(size, 1.0) * size, indexing="ij"
    )
    frequency = np.hypot(u * stretch, v)
    frequency[0, 0] = np.inf
    field = np.fft.ifft2(np.fft.fft2(RNG.standard_normal((size, size))) * frequency**-falloff).real
    result: Array = field / field.std()
    return result


def normals(height: Array, slope: float) -> Array:
    """Tangent-space normals (y up) of a tileable height field."""
    du = np.roll(height, -1, 1) - np.roll(height, 1, 1)
    dv = np.roll(height, -1, 0) - np.roll(height, 1, 0)
    n = np.stack([-slope * du, -slope * dv, np.ones_like(height)], -1)
    result: Array = n / np.linalg.norm(n, axis=-1, keepdims=True) * 0.5 + 0.5
    return result


def tinted(colour: tuple[float, float, float], shade: Array) -> Array:
    result: Array = np.clip(np.asarray(colour) * shade[..., None], 0, 1)
    return result


def cells(size: int, rows: int, columns: int, offsets: Array) -> tuple[Array, Array]:
    """Number of each pixel's brick or plank, and the pixel's distance from its edges."""
    v, u = np.mgrid[0:size, 0:size]
    height, width = size // rows, size // columns
    row = v // height
    u = (u + offsets[row]) % size
    from_edge = np.minimum(
        np.minimum(u % width, width - 1 - u % width),
        np.minimum(v % height, height - 1 - v % height),
    )
    return row * columns + u // width, from_edge


def planks() -> tuple[Array, Array, Array]:
    which, from_edge = cells(512, 8, 2, RNG.integers(0, 512, 8))
    grain, tone = noise(512, 1.1, 16), RNG.standard_normal(16)
    for plank in range(16):  # each plank has a grain of its own
        own = which == plank
        grain[own] = np.roll(grain, RNG.integers(0, 512, 2), (0, 1))[own]
    gap = np.clip(1.5 - from_edge, 0, 1)
    shade = (1 + 0.09 * tone[which] + 0.08 * grain) * (1 - 0.6 * gap)
    rough = np.clip(0.38 + 0.06 * grain + 0.4 * gap, 0, 1)
    return tinted((0.66, 0.47, 0.31), shade), normals(0.05 * grain - gap, 0.5), rough


def oak() -> Array:
    return tinted((0.63, 0.45, 0.30), 1 + 0.10 * noise(256, 1.1, 12))


def bricks() -> tuple[Array, Array]:
    which, from_edge = cells(512, 8, 4, np.arange(8) % 2 * 64)
    rough, tone = noise(512, 1.0), RNG.standard_normal(32)
    mortar = np.clip((5 + rough - from_edge) / 2, 0, 1)
    clay = tinted((0.80, 0.66, 0.57), 1 + 0.06 * tone[which] + 0.04 * rough)
    lime = tinted((0.82, 0.79, 0.74), 1 + 0.02 * rough)
    colour = clay + (lime - clay) * mortar[..., None]
    return colour, normals(0.25 * rough - 2 * mortar, 0.35)


def rug() -> Array:
    v, u = np.mgrid[0:256, 0:256] / 256
    diamonds = np.abs((u * 8) % 1 - 0.5) + np.abs((v * 5) % 1 - 0.5)
    edge = np.minimum(np.minimum(u, 1 - u) * 1.6, np.minimum(v, 1 - v))
    colour = np.full((256, 256, 3), (0.80, 0.74, 0.64))
    colour[np.abs(diamonds - 0.5) < 0.07] = (0.23, 0.30, 0.38)
    colour[diamonds < 0.16] = (0.66, 0.30, 0.20)
    colour[edge < 0.10] = (0.23, 0.30, 0.38)
    colour[(edge > 0.05) & (edge < 0.065)] = (0.80, 0.74, 0.64)
    result: Array = np.clip(colour * (1 + 0.07 * noise(256, 0.2))[..., None], 0, 1)
    return result


def weave() -> Array:
    v, u = np.mgrid[0:128, 0:128] * (2 * math.pi * 16 / 128)
    return normals(np.sin(u) * np.sin(v), 0.25)


def landscape() -> Array:
    """A picture of hills, which get paler with distance, under an evening sky."""
    v, u = np.mgrid[0:192, 0:256] / 192
    picture = np.array((0.95, 0.72, 0.50)) + (v[..., None] * np.array((-0.35, -0.10, 0.22)))
    picture[np.hypot(u - 0.85, v - 0.72) < 0.09] = (0.99, 0.92, 0.75)
    for hill in range(5):
        ridge = 0.62 - 0.12 * hill + 0.05 * np.sin(u * (4 + 2 * hill) + RNG.uniform(0, 6))
        picture[v < ridge] = np.array((0.55, 0.55, 0.66)) * (1 - 0.18 * hill)
    result: Array = np.clip(picture, 0, 1)
    return result


def frond() -> Array:
    """A palm's leaf with its stalk at v = 0. The alpha channel cuts out the leaflets."""
    v, u = np.mgrid[0:256, 0:256] / 256
    across = np.abs(u - 0.5) * 2
    reach = 0.97 * np.sin(math.pi * np.clip(v * 1.1 - 0.1, 0, 1) ** 0.7)
    leaflet = np.abs((v * 15 - across * 4.5) % 1 - 0.5) < 0.42 * (1 - across / (reach + 1e-6))
    alpha = leaflet | (across < 0.035 * (1.1 - v))
    green = tinted((0.30, 0.46, 0.20), 1 + 0.10 * noise(256, 1.0) + 0.25 * across)
    return np.concatenate([green, alpha[..., None]], -1)
