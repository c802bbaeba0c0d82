"""A third renderer, tiny and slow: it renders model_scenes.sphere_in_box by random walks in NumPy.

It computes the difference of two material models with common random numbers: ours by
transport/bsdf/*/theory.md, and that of Cycles in Blender 3.4 by its source (scatter_models.py). It
has no light sampling and no meshes: rays hit the box, the lamp and an exact sphere. Arrays have one
row for each path.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

import model_scenes as scenes
import scene_source as source
from bent_normals import cycles_bend, our_bend, softened
from directions import Array, cosine_direction, dot, unit
from scatter_models import Scatter, conductor, scatter_of

FACES = ("left", "floor", "back", "right", "ceiling", "front")  # walls at -x, -y, -z, +x, +y, +z


def relief_factors(p: Array, axis: Array, wo: Array, n: Array, wi: Array) -> Array:
    """Ratio of Lambert under a normal map to plain Lambert, of shape (n, 2, 1)."""
    floor = (axis == 1)[:, None]
    u, v = (p[:, 0] + 1) / 2, np.where(axis == 1, 1 - p[:, 2], 1 + p[:, 1]) / 2
    green = np.where(floor, [[0.0, 0.0, 1.0]], [[0.0, -1.0, 0.0]])  # opposite to glTF's v
    c = scenes.mapped_normal(u, v)
    normal = unit(c[:, :1] * [1.0, 0.0, 0.0] + c[:, 1:2] * green + c[:, 2:] * n)
    cosine = dot(wi, n)
    ours, theirs = our_bend(normal, wo, n), cycles_bend(normal, wo, n)
    lit = np.stack([dot(ours, wi), dot(theirs, wi) * softened(theirs, wi, n)], 1)
    result: Array = (np.maximum(lit, 0.0) / np.maximum(cosine, 1e-9)[:, None])[:, :, None]
    return result


def camera_rays(
    count: int, random: np.random.Generator
) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    camera = source.read_camera(scenes.CAMERA)
    reach = np.tan(np.radians(camera.vertical_fov_deg) / 2)
    x, y = (2 * random.random((2, count)) - 1) * reach  # the film is square
    way = camera.forward + x[:, None] * camera.right + y[:, None] * camera.up
    return np.tile(camera.position, (count, 1)), unit(way)


def to_sphere(o: Array, d: Array) -> Array:
    """Distance to the sphere along the ray; infinite on a miss."""
    away = o - np.array(scenes.CENTRE)
    b, c = dot(away, d), dot(away, away) - scenes.RADIUS**2
    root = b * b - c
    s = np.sqrt(np.maximum(root, 0))
    t = np.where(-b - s > 1e-6, -b - s, -b + s)
    return np.where((root > 0) & (t > 1e-6), t, np.inf)


def frame(n: Array) -> tuple[Array, Array]:
    """Two axes that complete each normal to a frame."""
    other = np.where(np.abs(n[:, :1]) > 0.7, [[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]])
    x = unit(np.cross(other, n))
    return x, np.cross(n, x)


def walk(
    scatter: Scatter, colours: npt.NDArray[Any], count: int, seed: int, mapped: bool = False
) -> npt.NDArray[Any]:
    """Radiance (count, 2, 3) of random points of the film, with our model and with that of Cycles.

    `mapped` selects model_scenes.mapped_box, which has no sphere.
    """
    random = np.random.default_rng(seed)
    o, d = camera_rays(count, random)
    found, weight, row = np.zeros((count, 2, 3)), np.ones((count, 2, 3)), np.arange(count)
    while len(row):
        u = random.random((len(row), 4))
        with np.errstate(divide="ignore"):
            planes = (np.sign(d) - o) / d
        axis, ball = planes.argmin(axis=1), np.full(len(o), np.inf) if mapped else to_sphere(o, d)
        t = np.minimum(planes.min(axis=1), ball)
        p, on_ball, sign = o + t[:, None] * d, ball <= t, np.sign(d[np.arange(len(d)), axis])
        lit = ~on_ball & (axis == 1) & (sign > 0)  # ignores the gap of 0.001 above the lamp
        lit &= (np.abs(p[:, [0, 2]]) < scenes.LAMP_HALF).all(axis=1)
        found[row[lit]] = weight[lit] * scenes.RADIANCE
        n = -np.eye(3)[axis] * sign[:, None]
        n[on_ball] = unit(p[on_ball] - scenes.CENTRE)
        inside = on_ball & (dot(n, d) > 0)
        n[inside] *= -1
        x, y = frame(n)
        wi, factor = cosine_direction(u), colours[np.where(sign > 0, 3, 0) + axis][:, None, :]
        factor = np.repeat(factor, 2, axis=1)
        b = np.flatnonzero(on_ball)
        wo = np.stack([-dot(d[b], x[b]), -dot(d[b], y[b]), np.maximum(-dot(d[b], n[b]), 1e-6)], 1)
        wi[b], factor[b] = scatter(wo, inside[b], u[b])
        if mapped:
            b = np.flatnonzero((sign < 0) & (axis > 0))
            factor[b] *= relief_factors(
                p[b], axis[b], -d[b], n[b], wi[b, :1] * x[b] + wi[b, 1:2] * y[b] + wi[b, 2:] * n[b]
            )
        weight = weight * factor
        stay = np.minimum(weight.max(axis=(1, 2)), 1.0) * ~lit  # Russian roulette
        live = u[:, 3] < stay
        weight = weight[live] / stay[live][:, None, None]
        d = (wi[:, :1] * x + wi[:, 1:2] * y + wi[:, 2:] * n)[live]
        o, row = p[live] + 1e-9 * d, row[live]
    return found


def image_means(data: dict[str, Any], batches: int, batch: int = 1 << 15) -> npt.NDArray[Any]:
    """Mean grey radiance (batches, 2) with our model and with that of Cycles, by the same paths.

    `data` is the sphere's material; an empty one selects mapped_box.
    """
    materials = scenes.box_materials()
    colours = np.array([materials[name]["reflectance"] for name in FACES], float)
    scatter = scatter_of(data) if data else conductor(1.0)
    return np.array(
        [walk(scatter, colours, batch, seed, not data).mean(axis=(0, 2)) for seed in range(batches)]
    )


def expected_ratio(data: dict[str, Any], batches: int) -> tuple[float, float]:
    """Expected ratio ours / Cycles, and its standard error."""
    means = image_means(data, batches)
    ours, cycles = means.mean(axis=0)
    scatter = (means[:, 0] - ours / cycles * means[:, 1]).std(ddof=1) / np.sqrt(batches)
    return float(ours / cycles), float(scatter / cycles)
