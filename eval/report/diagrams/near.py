"""Diagrams of what happens near a VPL: kinds of light, and compensations of what they leave out."""

from __future__ import annotations

import math
from collections.abc import Callable

from .shapes import CLUSTERS, MUTED, VPL, Drawing, Point

LIGHT: Point = (188, 70)
BELOW: Point = (146, 106)
WALL_X = 197
TOP = 2.0  # largest attenuation that is drawn, in 1/R²


def corner(d: Drawing) -> None:
    """A floor and a wall with a VPL, around which a dashed circle shows where 1/d² is bounded."""
    d.wall((8, 112), (WALL_X + 2, 112))
    d.wall((WALL_X, 114), (WALL_X, 8))
    style = f"fill:none;stroke:{VPL};stroke-width:1.2;stroke-dasharray:3 3"
    d.add("circle", style, cx=LIGHT[0], cy=LIGHT[1], r=60)


def bounded(d: Drawing, words: str) -> None:
    """A receiver below the VPL, over what is drawn so far."""
    d.vpl(LIGHT)
    d.receiver(BELOW)
    d.text((8, 16), words)


def none(d: Drawing) -> None:
    corner(d)
    d.ray(BELOW, LIGHT)
    bounded(d, "bounded within\nthe circle: the\ncorner is too dark")


def near_field(d: Drawing) -> None:
    corner(d)
    d.ray(BELOW, LIGHT)
    for y in (102, 90, 56, 30):
        d.arrow(BELOW, (WALL_X - 3, y), CLUSTERS[0])
    bounded(d, "rays by the BSDF\nadd what the bound\ntakes at their ends")


def kollig_keller(d: Drawing) -> None:
    corner(d)
    path: list[Point] = [BELOW, (WALL_X - 3, 92), (166, 108), (WALL_X - 3, 30)]
    for a, b in zip(path, path[1:], strict=False):
        d.arrow(a, b, CLUSTERS[0])
        d.untested(b, LIGHT)
    bounded(d, "paths go on from\nvertex to vertex\nwhile the bound\ntakes light")


def local(d: Drawing) -> None:
    corner(d)
    block: list[Point] = [(130, 106), (150, 106), (170, 106)]
    for x, y in zip((130, 150, 170), (34, 56, 92), strict=True):
        hit = (WALL_X - 3, y)
        for at in block:
            d.untested(hit, at, CLUSTERS[0])
        d.ray((x, 106), hit, CLUSTERS[0])
        d.vpl(hit, CLUSTERS[0], 3)
    d.vpl(LIGHT)
    for at in block:
        d.receiver(at)
    d.text((8, 16), "a ray's end lights\nthe whole block,\nwithout tests")


def curve(d: Drawing, value: Callable[[float], float], colour: str, width: float) -> None:
    """Attenuation over the distance, 0 to 3 radii of the light."""
    steps = 48
    points: list[Point] = []
    for k in range(steps + 1):
        distance = 3 * k / steps
        if value(distance) <= TOP:
            points.append((24 + 70 * distance, 108 - 92 / TOP * value(distance)))
    for a, b in zip(points, points[1:], strict=False):
        d.line(a, b, colour, width)


def attenuation(d: Drawing, value: Callable[[float], float]) -> None:
    d.arrow((24, 108), (236, 108))
    d.arrow((24, 108), (24, 6))
    d.text((236, 122), "distance", "end")
    curve(d, lambda x: 1 / max(x * x, 1e-6), MUTED, 1)
    curve(d, lambda x: 1 / max(x * x, 1.0), CLUSTERS[0], 1.4)
    curve(d, value, VPL, 2.4)
    d.line((94, 108), (94, 104))
    d.text((94, 122), "R", "middle")


def point(d: Drawing) -> None:
    attenuation(d, lambda x: 1 / max(x * x, 1.0))
    d.text((110, 22), "1 / max(d², R²)\ngrey: 1 / d²")


def disk(d: Drawing) -> None:
    attenuation(d, lambda x: 1 / (x * x + 1))
    d.text((110, 22), "a disk: 1 / (d² + R²)\nthin: a bounded point")


def yuksel(d: Drawing) -> None:
    attenuation(d, lambda x: 2 / (x * x + 1 + x * math.sqrt(x * x + 1)))
    d.text((110, 22), "mean over a disk's axis\nthin: a bounded point")


def spherical(d: Drawing) -> None:
    at, light, radius = (52.0, 104.0), (168.0, 52.0), 34.0
    style = f"fill:{VPL};fill-opacity:0.16;stroke:{VPL};stroke-width:1.2"
    d.add("circle", style, cx=light[0], cy=light[1], r=radius)
    towards = math.atan2(light[1] - at[1], light[0] - at[0])
    reach = math.hypot(light[0] - at[0], light[1] - at[1])
    half = math.asin(radius / reach)
    for side in (-1, 1):
        length = math.sqrt(reach * reach - radius * radius)
        angle = towards + side * half
        d.untested(at, (at[0] + length * math.cos(angle), at[1] + length * math.sin(angle)))
    d.ray(at, light)
    d.vpl(light)
    d.receiver(at)
    d.text((8, 16), "mean over the\nsphere's cone")
