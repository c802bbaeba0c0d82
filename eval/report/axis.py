"""Computes the range of an axis and its ticks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Tick:
    value: float
    factor: float | None  # the label is factor * 10^power, or 10^power where None
    power: int | None  # None marks a minor tick, which has no label


@dataclass(frozen=True)
class Axis:
    log: bool
    low: float
    high: float

    def at(self, value: float) -> float:
        """Position on the axis from 0 to 1; below 0 for values that a log axis cannot show."""
        if not self.log:
            return (value - self.low) / (self.high - self.low)
        if value <= 0:
            return -1.0
        return math.log(value / self.low) / math.log(self.high / self.low)


def axis_over(values: list[float], log: bool) -> Axis:
    """An axis that covers all values with a margin of 5 %."""
    low, high = min(values), max(values)
    if log:
        if high / low < 1.2:
            low, high = low / 1.5, high * 1.5
        margin = (high / low) ** 0.05
        return Axis(True, low / margin, high * margin)
    if high == low:
        low, high = low - 0.5 * (abs(low) or 1), high + 0.5 * (abs(high) or 1)
    margin = 0.05 * (high - low)
    bottom = 0.0 if 0 <= low <= 0.3 * high else low - margin
    return Axis(False, bottom, high + margin)


def axes_of(plot: dict[str, Any]) -> tuple[Axis, Axis]:
    xs = [x for s in plot["series"] for x in s["x"]]
    ys = []
    for s in plot["series"]:
        for i, y in enumerate(s["y"]):
            bar = s["error"][i] if s["error"] else 0.0
            ys += [y, y + bar]
            if not plot["y_log"] or y - bar > 0.3 * y:
                ys.append(y - bar)
    return axis_over(xs, plot["x_log"]), axis_over(ys, plot["y_log"])


def ticks(axis: Axis) -> list[Tick]:
    return log_ticks(axis) if axis.log else linear_ticks(axis)


def log_ticks(axis: Axis) -> list[Tick]:
    first, last = math.floor(math.log10(axis.low)), math.ceil(math.log10(axis.high))
    decades = [n for n in range(first, last + 1) if axis.low <= 10.0**n <= axis.high]
    step = max(1, math.ceil(len(decades) / 8))
    # Labels at one or two decades alone would leave most of the axis unlabelled.
    labelled = {1: (2, 5), 2: (3,)}.get(len(decades), (2, 3, 5) if not decades else ())
    result = []
    for n in range(first, last + 1):
        for factor in range(1, 10):
            value = factor * 10.0**n
            if not axis.low <= value <= axis.high:
                continue
            if factor == 1 and n % step == 0:
                result.append(Tick(value, None, n))
            elif factor in labelled:
                result.append(Tick(value, factor, n))
            elif step == 1:
                result.append(Tick(value, None, None))
    return result


def linear_ticks(axis: Axis) -> list[Tick]:
    raw = (axis.high - axis.low) / 6
    size = 10.0 ** math.floor(math.log10(raw))
    step = next(m * size for m in (1, 2, 5, 10) if m * size >= raw)
    start = math.ceil(axis.low / step - 1e-9)
    stop = math.floor(axis.high / step + 1e-9)
    return [Tick(i * step, i * step, 0) for i in range(start, stop + 1)]
