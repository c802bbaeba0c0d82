"""Diagrams of gathers that cut a tree of VPLs."""

from __future__ import annotations

from .shapes import CLUSTERS, INK, MUTED, STRONG, Drawing, Node, Point, Tree

LIGHTS = Tree(first=(22, 62), step=(28, 0), rise=(0, -17), height=3)
CUT = [Node(2, 0), Node(1, 2), Node(1, 3)]
RECEIVER: Point = (120, 112)


def outline_clusters(d: Drawing, cut: list[Node]) -> None:
    for i, node in enumerate(cut):
        d.around([LIGHTS.leaf(k) for k in node.leaves], CLUSTERS[i])


def draw_lights(d: Drawing, cut: list[Node], chosen: set[int]) -> None:
    for i, node in enumerate(cut):
        for k in node.leaves:
            d.vpl(LIGHTS.leaf(k), CLUSTERS[i], full=k in chosen)


def draw_descent(d: Drawing, node: Node, leaf: int, colour: str) -> None:
    """The way from a node to the leaf that is drawn."""
    while node.level:
        below = Node(node.level - 1, leaf >> (node.level - 1))
        d.line(LIGHTS.at(node), LIGHTS.at(below), colour, 3.5)
        node = below


def draw_cut(
    d: Drawing, cut: list[Node], rays: list[tuple[Point, list[int]]], descents: bool = False
) -> None:
    """The tree with its cut, and a ray from each receiver to its leaf of each cluster."""
    outline_clusters(d, cut)
    LIGHTS.draw(d, cut)
    for receiver, leaves in rays:
        for node, k, colour in zip(cut, leaves, CLUSTERS, strict=False):
            if descents:
                draw_descent(d, node, k, colour)
            d.ray(receiver, LIGHTS.leaf(k), colour)
    draw_lights(d, cut, {k for _, leaves in rays for k in leaves})


def lightcuts(d: Drawing) -> None:
    draw_cut(d, CUT, [(RECEIVER, [1, 4, 7])])
    d.receiver(RECEIVER)
    d.text((4, 9), "a cut for\neach sample")
    d.text((4, 112), "a ray for\neach cluster")
    d.text((236, 112), "the rest as its\nrepresentative", "end")


def tilecuts(d: Drawing) -> None:
    rays: list[tuple[Point, list[int]]] = [
        ((88, 112), [0, 5, 6]),
        ((120, 112), [3, 4, 7]),
        ((152, 112), [2, 5, 7]),
    ]
    draw_cut(d, CUT, rays)
    d.box((72, 103), (96, 22), STRONG, 0.12)
    for receiver, _ in rays:
        d.receiver(receiver)
    d.text((4, 9), "one cut for\na tile")
    d.text((4, 114), "tile")
    d.text((236, 103), "each draws\nVPLs of\nits own", "end")


def stochastic(d: Drawing) -> None:
    draw_cut(d, CUT, [(RECEIVER, [2, 4, 7])], descents=True)
    d.receiver(RECEIVER)
    d.text((4, 9), "random\ndescents")
    d.text((4, 112), "a ray for\neach draw")
    d.text((236, 9), "a cut of\nfixed size", "end")


def adaptive_tree(d: Drawing) -> None:
    cut = [Node(2, 0), Node(0, 4), Node(0, 5), Node(1, 3)]
    receiver = (160.0, 112.0)
    draw_cut(d, cut, [(receiver, [1, 4, 5, 6])], descents=True)
    for k in range(8):
        x, y = LIGHTS.leaf(k)
        d.arrow((x, y), (x + 10, y + 10) if k < 4 else (x, y + 14), MUTED)
    for node in (Node(3, 0), Node(2, 1), Node(1, 2)):
        d.vpl(LIGHTS.at(node), INK, 3.5, full=False)
    d.receiver(receiver)
    d.text((4, 9), "small σ: one\nis drawn")
    d.text((236, 9), "large σ (○):\nsplit", "end")
    d.text((4, 112), "nodes of like\nnormals")
