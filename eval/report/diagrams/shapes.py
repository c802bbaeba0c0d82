"""The shapes that the diagrams of methods share, drawn as SVG with the colours of the page.

A disc is a VPL, a square a receiver. A line is a shadow ray, a dashed one light that is not tested.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from html import escape

Point = tuple[float, float]
WIDTH, HEIGHT = 240, 130
INK, MUTED, STRONG, PAPER = "var(--ink)", "var(--muted)", "var(--strong)", "var(--paper)"
VPL = "var(--s4)"
CLUSTERS = ("var(--s0)", "var(--s1)", "var(--s2)", "var(--s3)")


def between(a: Point, b: Point, share: float) -> Point:
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])


@dataclass
class Drawing:
    """Shapes on a sheet of WIDTH x HEIGHT, of which later ones lie above earlier ones."""

    shapes: list[str] = field(default_factory=list)

    def add(self, name: str, style: str, content: str = "", **numbers: float) -> None:
        places = " ".join(f'{key}="{value:.5g}"' for key, value in numbers.items())
        self.shapes.append(f'<{name} {places} style="{style}">{content}</{name}>')

    def line(
        self, a: Point, b: Point, colour: str = INK, width: float = 1.0, dash: str = "none"
    ) -> None:
        style = f"stroke:{colour};stroke-width:{width:g};stroke-dasharray:{dash}"
        self.add("line", style, x1=a[0], y1=a[1], x2=b[0], y2=b[1])

    def ray(self, a: Point, b: Point, colour: str = INK) -> None:
        self.line(a, b, colour)

    def untested(self, a: Point, b: Point, colour: str = INK) -> None:
        self.line(a, b, colour, dash="2.5 2.5")

    def blocked(self, a: Point, b: Point, share: float, colour: str = INK) -> None:
        """A ray from a towards b that ends at a cross after a share of the way."""
        end = between(a, b, share)
        self.line(a, end, colour)
        self.cross(end, colour)

    def cross(self, at: Point, colour: str) -> None:
        x, y = at
        self.line((x - 3, y - 3), (x + 3, y + 3), colour, 1.6)
        self.line((x - 3, y + 3), (x + 3, y - 3), colour, 1.6)

    def wall(self, a: Point, b: Point) -> None:
        self.line(a, b, STRONG, 4)

    def vpl(self, at: Point, colour: str = VPL, radius: float = 4, full: bool = True) -> None:
        style = f"fill:{colour if full else PAPER};stroke:{colour};stroke-width:1.2"
        self.add("circle", style, cx=at[0], cy=at[1], r=radius)

    def receiver(self, at: Point) -> None:
        x, y = at
        self.line((x - 9, y + 4), (x + 9, y + 4), STRONG, 1.5)
        self.box((x - 3.5, y - 3.5), (7, 7), INK, fill=1)

    def box(
        self,
        corner: Point,
        size: Point,
        colour: str,
        fill: float = 0,
        width: float = 1,
        radius: float = 0,
    ) -> None:
        """A rectangle with an outline; fill is the opacity of its inside."""
        style = f"fill:{colour};fill-opacity:{fill:g};stroke:{colour};stroke-width:{width:g}"
        x, y = corner
        self.add("rect", style, x=x, y=y, width=size[0], height=size[1], rx=radius)

    def around(self, places: Iterable[Point], colour: str, margin: float = 7) -> None:
        """The outline of a cluster."""
        xs, ys = zip(*places, strict=True)
        corner = min(xs) - margin, min(ys) - margin
        size = max(xs) - min(xs) + 2 * margin, max(ys) - min(ys) + 2 * margin
        self.box(corner, size, colour, 0.14, 1.2, margin)

    def text(self, at: Point, words: str, anchor: str = "start") -> None:
        style = f"fill:{INK};text-anchor:{anchor}"
        for k, line in enumerate(words.split("\n")):
            self.add("text", style, escape(line), x=at[0], y=at[1] + 11 * k)

    def arrow(self, a: Point, b: Point, colour: str = INK) -> None:
        self.line(a, b, colour, 1.4)
        dx, dy = b[0] - a[0], b[1] - a[1]
        size = 4 / (dx * dx + dy * dy) ** 0.5
        for side in (0.7, -0.7):
            back = b[0] - size * (dx - side * dy), b[1] - size * (dy + side * dx)
            self.line(b, back, colour, 1.4)

    def svg(self, title: str) -> str:
        return (
            f'<svg class="diagram" viewBox="0 0 {WIDTH} {HEIGHT}" role="img">'
            f"<title>{escape(title)}</title>{''.join(self.shapes)}</svg>"
        )


@dataclass(frozen=True)
class Node:
    """A node of a tree: place k of the level, where level 0 is that of the leaves."""

    level: int
    k: int

    @property
    def leaves(self) -> range:
        return range(self.k << self.level, (self.k + 1) << self.level)

    def is_within(self, other: Node) -> bool:
        return self.level <= other.level and self.leaves.start in other.leaves


@dataclass(frozen=True)
class Tree:
    """A complete binary tree whose leaves stand in a line, and whose levels rise from it."""

    first: Point
    step: Point
    rise: Point
    height: int

    def at(self, node: Node) -> Point:
        middle = (node.leaves.start + node.leaves.stop - 1) / 2
        return (
            self.first[0] + middle * self.step[0] + node.level * self.rise[0],
            self.first[1] + middle * self.step[1] + node.level * self.rise[1],
        )

    def leaf(self, k: int) -> Point:
        return self.at(Node(0, k))

    def draw(self, to: Drawing, cut: list[Node]) -> None:
        """The edges, the part below a node of the cut in the colour of that node."""
        for level in range(self.height):
            for k in range(1 << (self.height - level)):
                node, parent = Node(level, k), Node(level + 1, k // 2)
                within = [CLUSTERS[i] for i, above in enumerate(cut) if parent.is_within(above)]
                look = (within[0], 1.0) if within else (INK, 1.4)
                to.line(self.at(node), self.at(parent), *look)
        for i, node in enumerate(cut):
            x, y = self.at(node)
            if node.level:
                to.box((x - 3, y - 3), (6, 6), CLUSTERS[i], 1)
