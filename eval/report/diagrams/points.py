"""Diagrams of gathers that take the VPLs one by one."""

from __future__ import annotations

from .shapes import CLUSTERS, STRONG, VPL, Drawing, Point

RECEIVER: Point = (120, 112)


def all_vpls(d: Drawing) -> None:
    xs, ys = range(16, 240, 26), (58, 22, 70, 14, 44, 14, 70, 22, 58)
    for at in zip(xs, ys, strict=True):
        d.ray(RECEIVER, at)
        d.vpl(at)
    d.receiver(RECEIVER)
    d.text((4, 112), "a ray to\nevery VPL")


def ward(d: Drawing) -> None:
    tested = 4
    d.wall((72, 62), (92, 62))
    for i, radius in enumerate((10, 8.5, 7.5, 6.5, 4, 3.5, 3, 2.5, 2)):
        at = (20.0 + 25 * i, 34.0)
        if i == 2:
            d.blocked(at, RECEIVER, 0.36)
        elif i < tested:
            d.ray(RECEIVER, at)
        else:
            d.untested(RECEIVER, at)
        d.vpl(at, radius=radius, full=i < tested)
    d.receiver(RECEIVER)
    d.text((10, 14), "brightest: tested")
    d.text((232, 14), "the rest: estimated", "end")
    d.line((107.5, 6), (107.5, 46), STRONG, dash="2 2")


def interleaved(d: Drawing) -> None:
    size, corner, chosen = 16, (6, 8), (1, 5)
    lights = [(122.0 + 13.2 * (i % 9), 16.0 + 22 * (i // 9)) for i in range(18)]
    for y in range(6):
        for x in range(6):
            k = 3 * (y % 3) + x % 3
            at = corner[0] + size * x, corner[1] + size * y
            d.box(at, (size, size), VPL if (y, x) == chosen else STRONG, 0.6 * ((y, x) == chosen))
            d.text((at[0] + size / 2, at[1] + 12), str(k), "middle")
    pixel = corner[0] + size * (chosen[1] + 0.5), corner[1] + size * (chosen[0] + 0.5)
    for i, light in enumerate(lights):
        if i % 9 == 5:
            d.ray((pixel[0] + 8, pixel[1]), light)
        d.vpl(light, full=i % 9 == 5)
    d.box((corner[0] + 3 * size, corner[1] + 3 * size), (3 * size, 3 * size), CLUSTERS[0], 0.2, 2)
    d.arrow((corner[0] + 6 * size + 4, 80), (132, 80), CLUSTERS[0])
    d.box((136, 72), (size, size), CLUSTERS[0], 0.5, 2)
    d.text((158, 78), "mean of\n3x3 pixels")
    d.text((6, 120), "pixel 5 gathers VPLs 5, 14, 23, ...")
