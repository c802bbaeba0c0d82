"""Arithmetic of directions: arrays with one row for each path."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def dot(a: Array, b: Array) -> Array:
    result: Array = (a * b).sum(-1)
    return result


def unit(v: Array) -> Array:
    result: Array = v / np.linalg.norm(v, axis=-1, keepdims=True)
    return result


def reflected(wo: Array, h: Array) -> Array:
    return 2 * dot(wo, h)[:, None] * h - wo


def cosine_direction(u: Array) -> Array:
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u[:, 0])], 1)
