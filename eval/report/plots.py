#!/usr/bin/python3
"""Draws one plot of report.json into a PNG or SVG file, for documents.

    plots.py report.json PLOT_ID -o convergence.png

Equal input gives equal bytes. Exit codes: 0 done, 2 wrong options, 3 bad or missing input, 4
output cannot be written.
"""

from __future__ import annotations

import argparse
import io
import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.axis import Axis as PlotAxis  # noqa: E402

from axis import Axis, axes_of, ticks  # noqa: E402
from make_report import EXIT_INPUT, output_guard, write_output  # noqa: E402
from palette import LIGHT, MARKERS  # noqa: E402
from report_json import ReportError, load  # noqa: E402
from svg_plot import name_lines  # noqa: E402

SYMBOLS = {
    "circle": "o",
    "square": "s",
    "triangle": "^",
    "diamond": "D",
    "down": "v",
    "plus": "P",
    "cross": "X",
}
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#6b7076",
    "svg.hashsalt": "bnvpl",
    "svg.fonttype": "path",
    "path.simplify": False,
}


def tick_text(factor: float | None, power: int | None) -> str:
    if factor is None:
        return f"$10^{{{power}}}$"
    return f"{factor:.6g}" if power == 0 else f"${factor:.0f}\\cdot10^{{{power}}}$"


def set_ticks(target: PlotAxis, axis: Axis) -> None:
    all_ticks = ticks(axis)
    major = [t for t in all_ticks if t.power is not None]
    target.set_ticks([t.value for t in major], [tick_text(t.factor, t.power) for t in major])
    target.set_ticks([t.value for t in all_ticks if t.power is None], minor=True)
    target.set_minor_formatter(matplotlib.ticker.NullFormatter())


def draw(axes: Axes, plot: dict[str, Any]) -> None:
    for i, s in enumerate(plot["series"]):
        marker = SYMBOLS[MARKERS[i % len(MARKERS)]]
        axes.errorbar(
            s["x"],
            s["y"],
            yerr=s["error"] or None,
            label=", ".join(name_lines(s)),
            color=LIGHT[i % len(LIGHT)],
            marker=marker,
            markersize=5,
            linewidth=1.6,
            linestyle="--" if s["dash"] else "-",
            capsize=2.5,
            elinewidth=1,
        )
    x_axis, y_axis = axes_of(plot)
    axes.set_xscale("log" if x_axis.log else "linear")
    axes.set_yscale("log" if y_axis.log else "linear")
    axes.set_xlim(x_axis.low, x_axis.high)
    axes.set_ylim(y_axis.low, y_axis.high)
    set_ticks(axes.xaxis, x_axis)
    set_ticks(axes.yaxis, y_axis)
    axes.set_xlabel(plot["x_label"])
    axes.set_ylabel(plot["y_label"])
    axes.set_title(plot["title"], loc="left", fontsize=11, fontweight="bold")
    axes.grid(True, which="major", color="#dfe1e3", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(1.01, 0.5))


def picture(plot: dict[str, Any], kind: str, dpi: int) -> bytes:
    # The file has no date and no version, so that equal input gives equal bytes.
    metadata = {"svg": {"Date": None, "Creator": None}, "png": {"Software": None}}[kind]
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(7.6, 4.2))
        draw(axes, plot)
        buffer = io.BytesIO()
        figure.savefig(
            buffer, format=kind, dpi=dpi, bbox_inches="tight", facecolor="white", metadata=metadata
        )
        plt.close(figure)
    return buffer.getvalue()


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("report", type=Path, help="the report (.json)")
    parser.add_argument("plot", help="id of the plot")
    parser.add_argument("-o", "--output", type=Path, required=True, help="picture (.png or .svg)")
    parser.add_argument("--dpi", type=int, default=110, help="of a PNG (default: %(default)s)")
    options = parser.parse_args(arguments)
    kind = options.output.suffix.lstrip(".").lower()
    if kind not in ("png", "svg"):
        parser.error(f"{options.output}: neither .png nor .svg")
    if options.dpi < 20 or options.dpi > 1200:
        parser.error(f"--dpi {options.dpi}: outside 20 to 1200")
    try:
        plots = {p["id"]: p for p in load(options.report)["plots"]}
        if options.plot not in plots:
            raise ReportError(
                f"{options.report}: no plot has the id '{options.plot}'; it has "
                f"{', '.join(plots) or 'none'}"
            )
    except ReportError as e:
        print(f"plots.py: {e}", file=sys.stderr)
        return EXIT_INPUT
    return write_output(
        "plots.py",
        options.output,
        picture(plots[options.plot], kind, options.dpi),
        {"png": output_guard.PNG, "svg": output_guard.SVG}[kind],
        options.report,
    )


if __name__ == "__main__":
    sys.exit(main())
