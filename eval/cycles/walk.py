"""A third renderer, tiny and slow: it renders model_scenes.sphere_in_box by random walks in NumPy.

It computes the difference of two material models with common random numbers: ours by
transport/bsdf/*/theory.md, and that of Cycles in Blender 3.4 by its source. It has no light
sampling and no meshes: rays hit the box, the lamp and an exact sphere. Directions are local, with z
along the normal on the side of `wo`. Arrays have one row for each path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

import model_scenes as scenes
import scene_source as source

# Maps wo, inside, and random numbers (n, 4) to wi and the weights f |cos| / pdf of shape
# (n, 2, 1 or 3), first ours, then those of Cycles.
Array = npt.NDArray[Any]
Scatter = Callable[[Array, Array, Array], tuple[Array, Array]]
FACES = ("left", "floor", "back", "right", "ceiling", "front")  # walls at -x, -y, -z, +x, +y, +z


def dot(a: Array, b: Array) -> Array:
    result: Array = (a * b).sum(-1)
    return result


def unit(v: Array) -> Array:
    result: Array = v / np.linalg.norm(v, axis=-1, keepdims=True)
    return result


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


def cosine_direction(u: Array) -> Array:
    r, phi = np.sqrt(u[:, 0]), 2 * np.pi * u[:, 1]
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - u[:, 0])], 1)


def fresnel(cosine: Array, eta: Array | float) -> tuple[Array, Array]:
    """Fresnel reflectance of a dielectric, and the refracted cosine (0 for total reflection)."""
    sin2 = (1 - cosine**2) / eta**2
    t = np.sqrt(np.maximum(0, 1 - sin2))
    across = (cosine - eta * t) / (cosine + eta * t)
    along = (eta * cosine - t) / (eta * cosine + t)
    return np.where(sin2 >= 1, 1.0, (across**2 + along**2) / 2), t


def reflected(wo: Array, h: Array) -> Array:
    return 2 * dot(wo, h)[:, None] * h - wo


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
