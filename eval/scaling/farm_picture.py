"""Draws a simulated farm: wall time over nodes, and the cores that each stage holds over time."""

import math
from typing import Any

from farm_graph import Job
from farm_schedule import Outcome

WIDTH, HEIGHT, LEFT, RIGHT = 800, 300, 70, 150
COLOURS = {
    "place": "#4e79a7",
    "eliminate": "#e15759",
    "estimate": "#f28e2b",
    "render": "#59a14f",
    "merge": "#b07aa1",
}
UNITS = ((86400, "d"), (3600, "h"), (60, "min"), (1, "s"))
COLUMNS = 200


Span = tuple[float, float]
Points = list[tuple[float, float]]
Ticks = list[tuple[float, Any]]


class Plot:
    """A plot whose axes grow to the right and upwards; both are logarithmic, or both linear."""

    def __init__(self, top: float, title: str, x: Span, y: Span, log: bool) -> None:
        self.top, self.x, self.y, self.log = top + 30, x, y, log
        self.rows = [f'<text x="{LEFT}" y="{top + 18}" font-weight="bold">{title}</text>']

    def share(self, value: float, span: Span) -> float:
        low, high, value = (
            (math.log(max(v, 1e-9)) for v in (*span, value)) if self.log else (*span, value)
        )
        return (value - low) / (high - low) if high > low else 0.5

    def place(self, x: float, y: float) -> tuple[float, float]:
        inner = WIDTH - LEFT - RIGHT
        return LEFT + inner * self.share(x, self.x), self.top + (HEIGHT - 80) * (
            1 - self.share(y, self.y)
        )

    def line(self, points: Points, colour: str, dash: str = "", width: float = 2) -> None:
        path = " ".join(f"{px:.1f},{py:.1f}" for px, py in (self.place(*p) for p in points))
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.rows.append(
            f'<polyline points="{path}" fill="none" stroke="{colour}" '
            f'stroke-width="{width}"{dashes}/>'
        )

    def area(self, points: Points, colour: str) -> None:
        path = " ".join(f"{px:.1f},{py:.1f}" for px, py in (self.place(*p) for p in points))
        self.rows.append(f'<polygon points="{path}" fill="{colour}"/>')

    def text(
        self,
        x: float,
        y: float,
        words: str,
        anchor: str = "middle",
        dx: float = 0.0,
        dy: float = 0.0,
        colour: str = "#222",
    ) -> None:
        px, py = self.place(x, y)
        self.rows.append(
            f'<text x="{px + dx:.1f}" y="{py + dy:.1f}" text-anchor="{anchor}" '
            f'fill="{colour}">{words}</text>'
        )

    def dot(self, x: float, y: float, colour: str) -> None:
        px, py = self.place(x, y)
        self.rows.append(f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill="{colour}"/>')

    def axes(self, xs: Ticks, ys: Ticks, what: str) -> None:
        for x, words in xs:
            self.line([(x, self.y[0]), (x, self.y[1])], "#ddd", width=1)
            self.text(x, self.y[0], words, dy=16)
        for y, words in ys:
            self.line([(self.x[0], y), (self.x[1], y)], "#ddd", width=1)
            self.text(self.x[0], y, words, "end", dx=-6, dy=4)
        self.text(self.x[1], self.y[0], what, "start", dx=34, dy=16)


def time_words(s: float) -> str:
    size, unit = next(((size, unit) for size, unit in UNITS if s >= size), (1, "s"))
    return f"{s / size:g} {unit}"


def time_ticks(low: float, high: float) -> Ticks:
    ticks = [
        n * size
        for size, _, steps in (
            (1, "s", (1, 10)),
            (60, "min", (1, 10)),
            (3600, "h", (1, 5)),
            (86400, "d", (1, 10, 100, 1000)),
        )
        for n in steps
    ]
    return [(t, time_words(t)) for t in ticks if low <= t <= high]


def over_nodes(rows: list[dict[str, Any]], limit_s: float) -> list[str]:
    walls = [row["wall_s"] for row in rows]
    nodes = (rows[0]["nodes"], max(rows[-1]["nodes"], rows[0]["nodes"] + 1))
    ideal = [(n, walls[0] * nodes[0] / n) for n in nodes]
    plot = Plot(0, "Wall time", nodes, (0.7 * min(limit_s, *walls), 1.4 * max(walls)), True)
    plot.axes([(row["nodes"], row["nodes"]) for row in rows], time_ticks(*plot.y), "nodes")
    low = [(n, s) for n, s in ideal if s >= plot.y[0]]
    if len(low) < 2:  # the line leaves the plot through its lower border
        low = [ideal[0], (walls[0] * nodes[0] / plot.y[0], plot.y[0])]
    plot.line(low, "#999", "4 3", 1.5)
    plot.text(*low[-1], "in proportion", "end", dx=-8, dy=-4, colour="#777")
    plot.line([(nodes[0], limit_s), (nodes[1], limit_s)], "#e15759", "4 3", 1.5)
    plot.text(nodes[1], limit_s, "critical path", "start", dx=8, dy=4, colour="#e15759")
    plot.line([(row["nodes"], row["wall_s"]) for row in rows], "#4e79a7")
    for row in rows:
        plot.dot(row["nodes"], row["wall_s"], "#4e79a7")
    plot.text(rows[-1]["nodes"], walls[-1], "this farm", "start", dx=8, dy=-8, colour="#4e79a7")
    return plot.rows


def kind_of(job: Job) -> str:
    return "merge" if job.stage.startswith("merge-") else job.stage


def cores_over_time(jobs: list[Job], outcome: Outcome) -> dict[str, list[float]]:
    """Mean number of cores that each kind of stage holds in each column of the time axis."""
    width, held = outcome.wall_s / COLUMNS, {kind: [0.0] * COLUMNS for kind in COLOURS}
    for attempt in outcome.attempts:
        job = jobs[attempt.job]
        for column in range(
            int(attempt.begin_s / width), min(COLUMNS, int(attempt.end_s / width) + 1)
        ):
            inside = min(attempt.end_s, (column + 1) * width) - max(attempt.begin_s, column * width)
            held[kind_of(job)][column] += job.cores * max(0.0, inside) / width
    return held


def steps(heights: list[float], width: float) -> Points:
    """Corners of a step function with the given height in each column."""
    corners: Points = []
    for k, height in enumerate(heights):
        if corners and corners[-1][1] == height:
            corners.pop()
        else:
            corners.append((k * width, height))
        corners.append(((k + 1) * width, height))
    return corners


def over_time(jobs: list[Job], outcome: Outcome, cores: int) -> list[str]:
    nodes_text = f"Cores that each stage holds, {cores} in all"
    plot = Plot(HEIGHT, nodes_text, (0.0, outcome.wall_s), (0.0, float(cores)), False)
    below, width = [0.0] * COLUMNS, outcome.wall_s / COLUMNS
    for kind, held in cores_over_time(jobs, outcome).items():
        above = [a + b for a, b in zip(below, held, strict=True)]
        if any(held):
            plot.area(steps(above, width) + steps(below, width)[::-1], COLOURS[kind])
        below = above
    step = outcome.wall_s / 5
    size, unit = next(((size, unit) for size, unit in UNITS if step >= size), (1, "s"))
    plot.axes(
        [(k * step, f"{k * step / size:.1f} {unit}") for k in range(6)],
        [(cores * k / 4, f"{cores * k / 4:g}") for k in range(5)],
        "time",
    )
    for k, (kind, colour) in enumerate(COLOURS.items()):
        y = plot.top + 12 + 18 * k
        plot.rows += [
            f'<rect x="{WIDTH - RIGHT + 10}" y="{y - 10}" width="12" height="12" fill="{colour}"/>',
            f'<text x="{WIDTH - RIGHT + 28}" y="{y}">{kind}</text>',
        ]
    return plot.rows


def svg(
    rows: list[dict[str, Any]], limit_s: float, jobs: list[Job], outcome: Outcome, cores: int
) -> str:
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{2 * HEIGHT}" '
        'font-family="sans-serif" '
        f'font-size="12" fill="#222">\n<rect width="{WIDTH}" height="{2 * HEIGHT}" fill="white"/>\n'
    )
    return (
        head + "\n".join(over_nodes(rows, limit_s) + over_time(jobs, outcome, cores)) + "\n</svg>\n"
    )
