"""Diagrams of gathers that divide space into cells."""

from __future__ import annotations

import math

from .shapes import CLUSTERS, INK, MUTED, STRONG, VPL, Drawing


def shirley(d: Drawing) -> None:
    side, receiver = 38, (64.0, 72.0)
    for row in range(3):
        for column in range(4):
            d.box((6 + side * column, 8 + side * row), (side, side), STRONG)
    d.box((6 + side, 8 + side), (side, side), CLUSTERS[0], 0.25)
    dim = [(16, 18), (90, 14), (118, 26), (148, 20), (142, 52), (150, 88), (128, 112), (96, 116)]
    dim += [(14, 112), (18, 84)]
    bright = [(34.0, 30.0), (104.0, 62.0), (52.0, 106.0)]
    for at in [*bright, dim[2], dim[5]]:
        d.ray(receiver, at)
    for at in dim:
        d.vpl(at, radius=2.5, full=at in (dim[2], dim[5]))
    for at in bright:
        d.vpl(at, radius=5.5)
    d.receiver(receiver)
    d.vpl((172, 40), radius=5.5)
    d.text((182, 38), "bright\nhere: all")
    d.vpl((172, 80), radius=2.5, full=False)
    d.text((182, 78), "dim: a few,\nat random")


def lie(d: Drawing) -> None:
    d.box((6, 6), (116, 116), STRONG)
    d.line((64, 6), (64, 122), STRONG)
    d.line((6, 64), (122, 64), STRONG)
    d.line((93, 6), (93, 64), STRONG)
    d.line((64, 35), (122, 35), STRONG)
    d.box((6, 64), (58, 58), CLUSTERS[0], 0.25)
    d.wall((110, 70), (110, 122))
    lights = [(160.0, 18.0), (160.0, 62.0), (160.0, 110.0)]
    receivers = [(22.0, 76.0), (48.0, 86.0), (28.0, 108.0)]
    for receiver in receivers:
        d.untested(receiver, lights[0])
        slope = (lights[1][1] - receiver[1]) / (lights[1][0] - receiver[0])
        if receiver[1] + slope * (110 - receiver[0]) > 70:
            d.blocked(lights[1], receiver, 50 / (lights[1][0] - receiver[0]))
        else:
            d.ray(receiver, lights[1])
    for receiver in receivers:
        d.receiver(receiver)
    d.vpl(lights[0])
    d.vpl(lights[1])
    d.vpl(lights[2], MUTED, full=False)
    for light, words in zip(
        lights, ("visible:\nno rays", "partial:\nrays", "hidden:\nskipped"), strict=True
    ):
        d.text((light[0] + 12, light[1] - 1), words)


def grid_hierarchy(d: Drawing) -> None:
    receiver, fine = (86.0, 64.0), 14.0
    near = [(72, 52), (80, 44), (100, 52), (66, 70), (104, 76), (90, 84), (74, 84), (106, 62)]
    grids = ((fine, 32, 56, CLUSTERS[0]), (2 * fine, 50, 200, CLUSTERS[1]))
    for size, least, most, colour in grids:
        places = [(size * (x + 0.5), size * (y + 0.5)) for x in range(-6, 6) for y in range(-4, 4)]
        for x, y in places:
            if max(abs(x) / 6, abs(y) / 4) < fine and least <= math.hypot(x, y) < most:
                at = receiver[0] + x, receiver[1] + y
                d.box((at[0] - size / 2, at[1] - size / 2), (size, size), colour, 0.1, 0.6)
                d.line(receiver, at, colour, 0.4)
                d.vpl(at, colour, size / 6)
    for place in near:
        d.ray(receiver, place)
        d.vpl(place, radius=2.5)
    d.receiver(receiver)
    legend = ((VPL, 2.5, "VPLs"), (CLUSTERS[0], 2.5, "fine grid"), (CLUSTERS[1], 5.0, "coarse"))
    for k, (colour, radius, words) in enumerate(legend):
        d.vpl((184, 30 + 32 * k), colour, radius)
        d.text((193, 33.5 + 32 * k), words)


def paquette(d: Drawing) -> None:
    receiver = (52.0, 116.0)
    nodes = [((6, 6), (112, 46)), ((122, 6), (112, 46)), ((122, 56), (112, 46))]
    nodes += [((64, 56), (54, 46))]
    offsets = ((0.2, 0.3), (0.4, 0.7), (0.65, 0.25), (0.8, 0.65), (0.55, 0.8))
    for i, (corner, size) in enumerate(nodes):
        colour = CLUSTERS[i]
        d.box(corner, size, colour, 0.12)
        places = [(corner[0] + size[0] * x, corner[1] + size[1] * y) for x, y in offsets]
        mean = sum(x for x, _ in places) / 5, sum(y for _, y in places) / 5
        d.untested(receiver, mean, colour)
        tested = min(places)
        d.ray(receiver, tested, colour)
        for place in places:
            d.vpl(place, colour, 2.5, full=place == tested)
        d.box((mean[0] - 4, mean[1] - 4), (8, 8), colour, 1, radius=1)
    for at in ((16.0, 64.0), (42.0, 72.0), (22.0, 90.0)):
        d.box((at[0] - 9, at[1] - 8), (18, 16), INK, 0, 0.6)
        d.ray(receiver, at)
        d.vpl(at)
    d.receiver(receiver)
    d.text((236, 114), "far node: its mean (■),\none ray; near: opened", "end")
