"""Diagrams of gathers that refine pairs of nodes of two trees."""

from __future__ import annotations

from .shapes import CLUSTERS, INK, MUTED, STRONG, Drawing, Node, Tree


def multidimensional(d: Drawing) -> None:
    left, top, wide, high = 66.0, 46.0, 20.0, 16.0
    columns = Tree((left + wide / 2, top - 4), (wide, 0), (0, -12), 3)
    rows = Tree((left - 4, top + high / 2), (0, high), (-16, 0), 2)
    columns.draw(d, [])
    rows.draw(d, [])
    for k in range(8):
        d.vpl(columns.leaf(k), radius=3)
    for k in range(4):
        x, y = rows.leaf(k)
        d.box((x - 3, y - 3), (6, 6), INK, 1)
    pairs = (  # node of samples, node of VPLs, row and column of the one term
        (Node(2, 0), Node(2, 0), 2, 1),
        (Node(1, 0), Node(1, 2), 0, 4),
        (Node(1, 1), Node(1, 2), 3, 5),
        (Node(1, 0), Node(1, 3), 1, 7),
        (Node(0, 2), Node(0, 6), 2, 6),
        (Node(0, 2), Node(0, 7), 2, 7),
        (Node(0, 3), Node(1, 3), 3, 6),
    )
    for i, (row, column, r, c) in enumerate(pairs):
        corner = left + wide * column.leaves.start, top + high * row.leaves.start
        size = wide * len(column.leaves), high * len(row.leaves)
        d.box(corner, size, CLUSTERS[i % 4], 0.22, 1.5)
        at = left + wide * (c + 0.5), top + high * (r + 0.5)
        d.vpl(at, CLUSTERS[i % 4], 3)
    d.text((2, 16), "samples of\na pixel")
    d.text((236, 14), "VPLs", "end")
    d.text((66, 124), "each box: a pair, one term")


def illumination_cut(d: Drawing) -> None:
    lights = [[(x + 12 * k, 28.0) for k in range(4)] for x in (60.0, 144.0)]
    groups = [[(x + 20 * k, 96.0) for k in range(3)] for x in (58.0, 142.0)]
    sources = [lights[0][1], lights[1][2]]
    for root, end, places in ((8.0, 20.0, lights), (122.0, 107.0, groups)):
        for place in places:
            d.line((120, root), ((place[0][0] + place[-1][0]) / 2, end))
        d.box((117, root - 3), (6, 6), INK, 1)
    d.wall((120, 42), (120, 86))
    for receiver in groups[0]:
        d.untested(receiver, sources[0], CLUSTERS[0])
    d.blocked(sources[1], groups[0][1], 0.5, MUTED)
    d.blocked(sources[0], groups[1][1], 0.5, MUTED)
    for receiver in groups[1]:
        d.ray(receiver, sources[1], CLUSTERS[1])
    for cluster, colour in zip(lights, CLUSTERS, strict=False):
        d.around(cluster, colour, 8)
        for light in cluster:
            d.vpl(light, colour, 3.5, full=light in sources)
    for group in groups:
        d.around(group, STRONG, 11)
        for receiver in group:
            d.receiver(receiver)
    d.text((2, 56), "all arrive:\nno more\nrays")
    d.text((238, 56), "they differ:\na ray\neach", "end")
    d.text((2, 124), "points of the film")
    d.text((2, 11), "VPLs")
    d.text((238, 124), "× none: dropped", "end")
