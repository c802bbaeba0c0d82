"""Normals of normal maps: how ours and those of Cycles are bent, and what Cycles dims."""

from __future__ import annotations

import numpy as np

from directions import Array, dot, reflected, unit


def softened(normal: Array, wi: Array, n: Array) -> Array:
    """Factor by which Cycles dims surfaces that a map turns to the light.

    See Chiang et al. 2019, "Taming the shadow terminator".
    """
    g = dot(n, wi) / np.maximum(dot(normal, wi) * dot(n, normal), 1e-9)
    return np.where(g < 1, g + g**2 - g**3, 1.0)


def our_bend(normal: Array, wo: Array, n: Array) -> Array:
    """Bends a normal so that the mirror direction of wo stays above n (ggx/theory.md)."""
    mirror, o = reflected(wo, normal), dot(wo, n)
    least = np.minimum(0.01, 0.9 * o)[:, None]
    up = dot(mirror, n)[:, None]
    along = unit(mirror - n * up + 1e-12)
    bent = unit(wo + along * np.sqrt(1 - least**2) + n * least)
    return np.where((up >= least) & (dot(normal, wo) > 0)[:, None], normal, bent)


def cycles_bend(normal: Array, wo: Array, n: Array) -> Array:
    """The same in Cycles (ensure_valid_reflection), which turns the normal straight towards n."""
    least = np.minimum(0.01, 0.9 * dot(wo, n))
    flat: Array = normal - dot(normal, n)[:, None] * n
    x = unit(flat + 1e-12)
    ix, iz = dot(wo, x), dot(wo, n)
    a = ix**2 + iz**2
    b, c = np.sqrt(np.maximum(0, ix**2 * (a - least**2))), iz * least + a
    z2 = np.stack([b + c, c - b]) / (2 * a)
    valid = (z2 > 1e-5) & (z2 <= 1 + 1e-5)
    z2 = np.clip(z2, 0, 1)
    nx, nz = np.sqrt(1 - z2), np.sqrt(z2)
    height = 2 * (nx * ix + nz * iz) * nz - iz
    both = valid.all(0)
    good = (height >= 1e-5) & both
    first = np.where(good.all(0), height[0] < height[1], height[0] > height[1])
    first = np.where(both, first, valid[0])
    rows = np.arange(len(n))
    which = np.where(first, 0, 1)
    bent = nx[which, rows][:, None] * x + nz[which, rows][:, None] * n
    bent = np.where(valid.any(0)[:, None], bent, n)
    keep = dot(reflected(wo, normal), n) >= least
    return np.where(keep[:, None], normal, bent)
