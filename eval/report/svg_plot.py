"""Draws a plot as inline SVG. The colours are classes, so the page's style decides light or dark.

Two sizes of each plot are written, and the style shows one: a wide one with the names at the ends
of the lines, and a narrow one for phones with the names below. A single drawing, scaled, would have
too small letters on a phone.
"""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

from axis import Axis, Tick, axes_of, ticks
from palette import LIGHT, MARKERS


@dataclass(frozen=True)
class Frame:
    width: int
    height: int
    left: int
    right: int
    top: int
    bottom: int

    def x(self, share: float) -> float:
        return self.left + share * (self.width - self.left - self.right)

    def y(self, share: float) -> float:
        return self.height - self.bottom - share * (self.height - self.top - self.bottom)


@dataclass
class Label:
    index: int
    x: float
    y: float
    at: float  # top of the text


def plot_svg(plot: dict[str, Any], wide: bool) -> str:
    names = [name_lines(s) for s in plot["series"]]
    if wide:
        longest = max(max(len(t) for t in lines) for lines in names)
        frame = Frame(880, 460, 74, min(44 + 7 * longest, 270), 16, 58)
    else:
        frame = Frame(360, 330 + 22 * len(names), 58, 12, 12, 62 + 22 * len(names))
    x_axis, y_axis = axes_of(plot)
    title = escape(f"{plot['title']}: {plot['y_label']} against {plot['x_label']}")
    kind = "wide" if wide else "narrow"
    parts = [
        f'<svg class="plot {kind}" viewBox="0 0 {frame.width} {frame.height}" role="img" '
        f'aria-label="{title}"><title>{title}</title>'
    ]
    parts += grid(frame, x_axis, y_axis)
    parts += axis_titles(frame, plot)
    points = [
        [
            (frame.x(x_axis.at(x)), frame.y(y_axis.at(y)))
            for x, y in zip(s["x"], s["y"], strict=True)
        ]
        for s in plot["series"]
    ]
    for i, s in enumerate(plot["series"]):
        parts += series(i, s, points[i], frame, y_axis)
    parts += end_labels(names, points, frame) if wide else legend(names, plot, frame)
    return "\n".join(parts + ["</svg>"])


def number(v: float) -> str:
    return f"{v:.1f}".rstrip("0").rstrip(".")


def slope_text(slope: float) -> str:
    return f"slope {slope:+.2f}".replace("-", "−")


def name_lines(s: dict[str, Any]) -> list[str]:
    return [s["label"]] + ([slope_text(s["slope"])] if s["slope"] is not None else [])


def tick_label(tick: Tick) -> str:
    """Label of a tick; empty for a minor tick."""
    if tick.power is None:
        return ""
    exponent = str(tick.power).replace("-", "−")
    power = f'10<tspan class="power" dy="-5">{exponent}</tspan>'
    if tick.factor is None:
        return power
    if tick.power == 0:
        return f"{tick.factor:.6g}".replace("-", "−")
    return f"{tick.factor:.0f}·{power}"


def grid(frame: Frame, x_axis: Axis, y_axis: Axis) -> list[str]:
    left, right, bottom, top = frame.x(0), frame.x(1), frame.y(0), frame.y(1)
    parts = []
    for tick in ticks(x_axis):
        x, text = number(frame.x(x_axis.at(tick.value))), tick_label(tick)
        kind = "grid" if text else "minor"
        parts.append(
            f'<line class="{kind}" x1="{x}" x2="{x}" y1="{number(bottom)}" '
            f'y2="{number(top if text else bottom - 4)}"/>'
        )
        if text:
            parts.append(
                f'<text x="{x}" y="{number(bottom + 20)}" text-anchor="middle">{text}</text>'
            )
    for tick in ticks(y_axis):
        y, text = frame.y(y_axis.at(tick.value)), tick_label(tick)
        kind = "grid" if text else "minor"
        parts.append(
            f'<line class="{kind}" y1="{number(y)}" y2="{number(y)}" '
            f'x1="{number(left)}" x2="{number(right if text else left + 4)}"/>'
        )
        if text:
            parts.append(
                f'<text x="{number(left - 8)}" y="{number(y + 4.5)}" '
                f'text-anchor="end">{text}</text>'
            )
    parts.append(
        f'<path class="axis" d="M{number(left)} {number(top)}V{number(bottom)}H{number(right)}"/>'
    )
    return parts


def axis_titles(frame: Frame, plot: dict[str, Any]) -> list[str]:
    x, y = number(frame.x(0.5)), number(frame.y(0) + 46)
    middle = number(frame.y(0.5))
    return [
        f'<text class="title" x="{x}" y="{y}" text-anchor="middle">'
        f"{escape(plot['x_label'])}</text>",
        f'<text class="title" transform="translate(15 {middle}) rotate(-90)" '
        f'text-anchor="middle">{escape(plot["y_label"])}</text>',
    ]


def marker(shape: str, x: float, y: float) -> str:
    paths = {
        "circle": "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
        "square": "M-3.6-3.6h7.2v7.2h-7.2z",
        "triangle": "M0-4.8L4.6 3.4H-4.6z",
        "diamond": "M0-5L5 0L0 5L-5 0z",
        "down": "M0 4.8L4.6-3.4H-4.6z",
        "plus": "M-1.5-4.5h3v3h3v3h-3v3h-3v-3h-3v-3h3z",
        "cross": "M-4.2-2.1L-2.1-4.2L0-2.1L2.1-4.2L4.2-2.1L2.1 0L4.2 2.1L2.1 4.2L0 2.1L-2.1 4.2"
        "L-4.2 2.1L-2.1 0z",
    }
    return (
        f'<path class="marker" transform="translate({number(x)} {number(y)})" d="{paths[shape]}"/>'
    )


def series(
    index: int, s: dict[str, Any], points: list[tuple[float, float]], frame: Frame, y_axis: Axis
) -> list[str]:
    shape = MARKERS[index % len(MARKERS)]
    parts = [f'<g class="series s{index % len(LIGHT)}">']
    for i, (x, _) in enumerate(points):
        if not s["error"] or s["error"][i] == 0:
            continue
        ends = [min(max(y_axis.at(s["y"][i] + sign * s["error"][i]), 0.0), 1.0) for sign in (1, -1)]
        high, low = (number(frame.y(e)) for e in ends)
        cap, end = number(x - 3.5), number(x + 3.5)
        parts.append(
            f'<path class="bar" d="M{cap} {high}H{end}M{number(x)} {high}V{low}'
            f'M{cap} {low}H{end}"/>'
        )
    path = "L".join(f"{number(x)} {number(y)}" for x, y in points)
    dash = ' stroke-dasharray="7 5"' if s["dash"] else ""
    parts.append(f'<path class="line" d="M{path}"{dash}/>')
    for i, (x, y) in enumerate(points):
        parts.append(
            marker(shape, x, y)[:-2] + f"><title>{escape(s['label'])}: "
            f"{s['x'][i]:.6g}, {s['y'][i]:.4g}</title></path>"
        )
    return parts + ["</g>"]


def end_labels(
    names: list[list[str]], points: list[list[tuple[float, float]]], frame: Frame
) -> list[str]:
    """The names at the right ends of the lines, moved apart so that none overlap."""
    labels = sorted(
        (Label(i, *p[-1], p[-1][1]) for i, p in enumerate(points)),
        key=lambda label: (label.y, label.index),
    )
    heights = [16.0 * len(names[label.index]) + 5 for label in labels]
    lowest = frame.top + 2.0
    for label, height in zip(labels, heights, strict=True):
        label.at = max(label.y - height / 2, lowest)
        lowest = label.at + height
    limit = frame.height - 6.0
    for label, height in zip(reversed(labels), reversed(heights), strict=True):
        label.at = min(label.at, limit - height)
        limit = label.at
    text_x = frame.x(1) + 24
    parts = []
    for label, height in zip(labels, heights, strict=True):
        middle = label.at + height / 2
        number_of = label.index % len(LIGHT)
        parts.append(
            f'<path class="leader s{number_of}" d="M{number(label.x + 7)} '
            f'{number(label.y)}L{number(text_x - 5)} {number(middle)}"/>'
        )
        lines = names[label.index]
        first = middle + 5 - 8 * (len(lines) - 1)
        parts.append(
            f'<text class="name s{number_of}" x="{number(text_x)}" '
            f'y="{number(first)}">{escape(lines[0])}</text>'
        )
        if len(lines) > 1:
            parts.append(
                f'<text class="slope" x="{number(text_x)}" y="{number(first + 16)}">'
                f"{escape(lines[1])}</text>"
            )
    return parts


def legend(names: list[list[str]], plot: dict[str, Any], frame: Frame) -> list[str]:
    parts = []
    for i, lines in enumerate(names):
        y = frame.y(0) + 72 + 22 * i
        dash = ' stroke-dasharray="7 5"' if plot["series"][i]["dash"] else ""
        parts.append(
            f'<g class="series s{i % len(LIGHT)}"><path class="line" '
            f'd="M8 {number(y)}H36"{dash}/>'
            f"{marker(MARKERS[i % len(MARKERS)], 22, y)}</g>"
            f'<text class="name s{i % len(LIGHT)}" x="44" y="{number(y + 4.5)}">'
            f"{escape(lines[0])}"
        )
        if len(lines) > 1:
            parts.append(f'<tspan class="slope">  {escape(lines[1])}</tspan>')
        parts.append("</text>")
    return parts
