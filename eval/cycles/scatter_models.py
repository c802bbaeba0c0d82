"""Material models in pairs for walk.py: ours, and that of Cycles in Blender 3.4.

Directions are local, with z along the normal on the side of `wo`. Arrays have one row for each
path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from directions import Array, cosine_direction, dot, reflected, unit

# Maps wo, inside, and random numbers (n, 4) to wi and the weights f |cos| / pdf of shape
# (n, 2, 1 or 3), first ours, then those of Cycles.
Scatter = Callable[[Array, Array, Array], tuple[Array, Array]]


def g1(w: Array, alpha: float) -> Array:
    """Smith's masking function G1 of GGX."""
    z2 = np.maximum(w[:, 2] ** 2, 1e-12)
    result: Array = 2 / (1 + np.sqrt(1 + alpha**2 * (1 - np.minimum(z2, 1)) / z2))
    return result


def shadowing(wo: Array, wi: Array, alpha: float) -> Array:
    """G2 / G1(wo): ours has the height-correlated G2, Cycles 3.4 has G2 = G1(wo) G1(wi)."""
    a, b = g1(wo, alpha), g1(wi, alpha)
    return np.stack([b / (a + b - a * b), b], 1)


def visible_facet(wo: Array, alpha: float, u: Array) -> Array:
    """Samples a facet's normal by its area visible from `wo` (Heitz 2018)."""
    v = unit(wo * [alpha, alpha, 1.0])
    flat = np.hypot(v[:, 0], v[:, 1])
    t1 = np.stack([-v[:, 1], v[:, 0], np.zeros(len(v))], 1) / np.maximum(flat, 1e-12)[:, None]
    t1[flat < 1e-9] = (1.0, 0.0, 0.0)
    t2 = np.cross(v, t1)
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    x, s = r * np.cos(phi), (1 + v[:, 2]) / 2
    y = (1 - s) * np.sqrt(np.maximum(0, 1 - x**2)) + s * r * np.sin(phi)
    z = np.sqrt(np.maximum(0, 1 - x**2 - y**2))
    h = x[:, None] * t1 + y[:, None] * t2 + z[:, None] * v
    return unit(np.stack([alpha * h[:, 0], alpha * h[:, 1], np.maximum(h[:, 2], 1e-9)], 1))


def fresnel(cosine: Array, eta: Array | float) -> tuple[Array, Array]:
    """Fresnel reflectance of a dielectric, and the refracted cosine (0 for total reflection)."""
    sin2 = (1 - cosine**2) / eta**2
    t = np.sqrt(np.maximum(0, 1 - sin2))
    across = (cosine - eta * t) / (cosine + eta * t)
    along = (eta * cosine - t) / (eta * cosine + t)
    return np.where(sin2 >= 1, 1.0, (across**2 + along**2) / 2), t


def conductor(alpha: float) -> Scatter:
    def scatter(wo: Array, inside: Array, u: Array) -> tuple[Array, Array]:
        wi = reflected(wo, visible_facet(wo, alpha, u))
        both = shadowing(wo, wi, alpha)
        return wi, np.where(wi[:, 2:] > 0, both, 0.0)[:, :, None]

    return scatter


def dielectric(alpha: float, index: float) -> Scatter:
    """Glass. Ours has the Fresnel reflectance of the facet.

    The Glass BSDF of Cycles has that of the mean normal, and loses light where a facet reflects
    totally.
    """

    def scatter(wo: Array, inside: Array, u: Array) -> tuple[Array, Array]:
        eta = np.where(inside, 1 / index, index)
        h = visible_facet(wo, alpha, u)
        o = np.minimum(dot(wo, h), 1.0)
        facet, t = fresnel(o, eta)
        smooth = fresnel(np.minimum(wo[:, 2], 1.0), eta)[0]
        chance = (facet + smooth) / 2
        mirror = u[:, 2] < chance
        refracted = unit(h * (o / eta - t)[:, None] - wo / eta[:, None])
        wi = np.where(mirror[:, None], reflected(wo, h), refracted)
        good = np.where(mirror, wi[:, 2] > 0, (wi[:, 2] < 0) & (t > 0))
        share = np.stack([facet, smooth], 1)
        drawn = np.where(mirror[:, None], share, 1 - share)
        both = shadowing(wo, wi, alpha) * drawn / np.where(mirror, chance, 1 - chance)[:, None]
        return wi, np.where(good[:, None], both, 0.0)[:, :, None]

    return scatter


def coat_albedo(alpha: float, index: float) -> tuple[Callable[[Array], Array], float]:
    """Albedo E of our coat, interpolated between 33 cosines, and its cosine-weighted mean."""
    cosines = np.linspace(0, 1, 33)
    u = np.random.default_rng(1).random((1 << 14, 2))
    table = []
    for c in np.maximum(cosines, 1e-3):
        wo = np.tile([np.sqrt(1 - c * c), 0.0, c], (len(u), 1))
        h = visible_facet(wo, alpha, u)
        wi = reflected(wo, h)
        share = fresnel(np.minimum(dot(wo, h), 1.0), index)[0] * shadowing(wo, wi, alpha)[:, 0]
        table.append(np.where(wi[:, 2] > 0, share, 0.0).mean())
    return lambda c: np.interp(c, cosines, table), float(np.trapz(2 * cosines * table, cosines))


def coated(alpha: float, index: float, reflectance: Sequence[float]) -> Scatter:
    """Coated diffuse. Half of the paths sample the gloss, half the base.

    The Mix of Cycles has the Fresnel reflectance of the mean normal for `wo` only. Its gloss over
    black has that of the facet.
    """
    albedo, mean = coat_albedo(alpha, index)
    base = np.array(reflectance, float)
    our_base = base / (index**2 * (1 - base * (1 - (1 - mean) / index**2)))

    def scatter(wo: Array, inside: Array, u: Array) -> tuple[Array, Array]:
        h = visible_facet(wo, alpha, u)
        gloss = u[:, 2] < 0.5
        wi = np.where(gloss[:, None], reflected(wo, h), cosine_direction(u[:, :2]))
        facet = fresnel(np.minimum(dot(wo, h), 1.0), index)[0]
        mixed = fresnel(np.minimum(wo[:, 2], 1.0), index)[0] if base.any() else facet
        shine = np.stack([facet, mixed], 1) * shadowing(wo, wi, alpha)
        ours = ((1 - albedo(wo[:, 2])) * (1 - albedo(np.maximum(wi[:, 2], 0))))[:, None] * our_base
        below = np.stack([ours, (1 - mixed)[:, None] * base], 1)
        both = np.where(gloss[:, None, None], shine[:, :, None], below)
        return wi, 2 * np.where(wi[:, 2:, None] > 0, both, 0.0)

    return scatter


def metallic_roughness(colour: Sequence[float], metallic: float, roughness: float) -> Scatter:
    """glTF's model. Ours follows appendix B of glTF 2.0 by metallic_roughness/theory.md.

    The Principled BSDF has Disney's diffuse term, which the gloss does not reduce, and a Fresnel
    term with the shape of index 1.5 instead of Schlick's.
    """
    alpha, tint = roughness**2, np.array(colour, float)
    f0 = 0.04 * (1 - metallic) + tint * metallic
    base = tint * (1 - metallic)
    kept = _kept_base(alpha, 0.04)  # only a non-metal has a base

    def scatter(wo: Array, inside: Array, u: Array) -> tuple[Array, Array]:
        gloss = u[:, 2] < 0.5
        h = visible_facet(wo, alpha, u)
        wi = np.where(gloss[:, None], reflected(wo, h), cosine_direction(u[:, :2]))
        h = np.where(gloss[:, None], h, unit(wo + wi))
        m = np.clip(dot(wo, h), 0, 1)
        rises = np.stack([(1 - m) ** 5, (fresnel(m, 1.5)[0] - 0.04) / 0.96], 1)
        f = f0 + (1 - f0) * rises[:, :, None]
        shine = f * shadowing(wo, wi, alpha)[:, :, None]
        o, i = wo[:, 2], np.clip(wi[:, 2], 0, 1)
        below_gloss = 0.96 * (1 - rises[:, 0]) * np.minimum(kept(o), kept(i))
        ours = np.repeat(below_gloss[:, None], 3, 1)
        fo, fi, back = (1 - o) ** 5, (1 - i) ** 5, 2 * roughness * m**2
        disney = (1 - fo / 2) * (1 - fi / 2) + back * (fo + fi + fo * fi * (back - 1))
        below = base * np.stack([ours, np.repeat(disney[:, None], 3, 1)], 1)
        both = np.where(gloss[:, None, None], shine, below)
        return wi, 2 * np.where(wi[:, 2:, None] > 0, both, 0.0)

    return scatter


def _kept_base(alpha: float, f0: float) -> Callable[[Array], Array]:
    """k(w) of equation 3, interpolated between 33 cosines."""
    cosines = np.linspace(0, 1, 33)
    u = np.random.default_rng(1).random((1 << 14, 2))
    table = []
    for c in np.maximum(cosines, 1e-3):
        wo = np.tile([np.sqrt(1 - c * c), 0.0, c], (len(u), 1))
        h = visible_facet(wo, alpha, u)
        wi = reflected(wo, h)
        f = f0 + (1 - f0) * (1 - dot(wo, h)) ** 5
        gloss = np.where(wi[:, 2] > 0, f * shadowing(wo, wi, alpha)[:, 0], 0.0).mean()
        m = dot(wo, unit(wo + cosine_direction(u)))
        table.append(min(1.0, (1 - gloss) / (1 - f0 - (1 - f0) * (1 - m) ** 5).mean()))
    return lambda c: np.interp(c, cosines, table)


def scatter_of(data: dict[str, Any]) -> Scatter:
    """Our model by transport/bsdf/<model>/theory.md, that of Cycles by cycles_models.py."""
    if data["type"] == "conductor":
        return conductor(data["roughness"])
    if data["type"] == "dielectric":
        return dielectric(data["roughness"], data["eta"])
    if data["type"] == "metallicroughness":
        return metallic_roughness(data["reflectance"], data["metallic"], data["roughness"])
    return coated(data["roughness"], data["eta"], data["reflectance"])
