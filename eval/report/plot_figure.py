"""Draws a plot of the report with Matplotlib, as a picture file or as SVG inside the page.

Equal input gives equal bytes. The page's SVG takes fonts and colours from the page's style, so that
it suits light and dark modes; its markers have tooltips.
"""

from __future__ import annotations

import io
import math
import re
import warnings
from html import escape
from textwrap import fill, wrap
from typing import Any
from xml.etree import ElementTree

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.axis import Axis  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter  # noqa: E402

# The hues follow Okabe and Ito, so that they differ under the common colour-vision deficiencies.
# Their contrast with the background is at least 4.5:1. No line is identified by its colour alone.
LIGHT = ("#0067b3", "#cc4b00", "#00795a", "#a8327e", "#846500", "#4a4f57", "#5b4bc4", "#b3261e")
DARK = ("#63b3ff", "#ff9550", "#2fd0a0", "#f490cf", "#e3c64a", "#c3c8cf", "#b0a4ff", "#ff8a80")
MARKERS = "os^DvPXo"
PAPER, INK, STRONG, LINE = "#ffffff", "#16181b", "#8a9097", "#d5d8db"
# The page's SVG has these variables of page.css in place of the colours.
VARIABLES = {PAPER: "paper", INK: "ink", STRONG: "strong", LINE: "line"} | {
    colour: f"s{i}" for i, colour in enumerate(LIGHT)
}
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "text.color": INK,
    "text.parse_math": False,
    "axes.labelcolor": INK,
    "axes.edgecolor": STRONG,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": LINE,
    "xtick.color": STRONG,
    "ytick.color": STRONG,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "legend.frameon": False,
    "legend.labelcolor": "linecolor",
    "path.simplify": False,
}
XLINK = "http://www.w3.org/1999/xlink"
SUPERSCRIPT = str.maketrans("−0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def minus(text: str) -> str:
    return text.replace("-", "−")


def slope_text(slope: float) -> str:
    return minus(f"slope {slope:+.2f}")


def tick_text(value: float, plain: bool) -> str:
    """Label of a tick in ordinary characters, such as 0.5, or 10³ and 2·10³."""
    if plain or value == 0:
        return minus(f"{value:.6g}")
    factor, power = f"{value:.5e}".split("e")
    ten = "10" + minus(str(int(power))).translate(SUPERSCRIPT)
    return ten if float(factor) == 1 else minus(f"{float(factor):g}·{ten}")


def set_ticks(axis: Axis, log: bool) -> None:
    low, high = axis.get_view_interval()
    if log:
        # Labels at one or two decades alone would leave most of the axis unlabelled.
        decades = math.log10(high / low)
        factors = (1, 2, 5) if decades < 1.5 else (1, 3) if decades < 2.5 else (1,)
        axis.set_major_locator(LogLocator(subs=factors))
        axis.set_minor_formatter(NullFormatter())
    else:
        axis.set_major_locator(MaxNLocator(8, steps=(1, 2, 5, 10)))
    size = max(abs(low), abs(high))
    plain = (low if log else size) > 5e-4 and size < 1e5
    axis.set_major_formatter(FuncFormatter(lambda value, _: tick_text(value, plain)))


def draw(axes: Axes, plot: dict[str, Any]) -> list[Line2D]:
    """Draws the plot. Returns the lines, those that end higher first."""
    axes.set_xscale("log" if plot["x_log"] else "linear")
    axes.set_yscale("log" if plot["y_log"] else "linear")
    axes.set(xlabel=plot["x_label"], ylabel=fill(plot["y_label"], 40))
    lines: list[Line2D] = []
    for i, s in enumerate(plot["series"]):
        slope = [] if s["slope"] is None else [slope_text(s["slope"])]
        lines += axes.plot(
            s["x"],
            s["y"],
            label="\n".join([*wrap(s["label"], 34), *slope]),
            color=LIGHT[i % len(LIGHT)],
            linewidth=1.6,
            linestyle="--" if s["dash"] else "-",
            # A colour that comes again has another marker.
            marker=MARKERS[(i + i // len(LIGHT)) % len(MARKERS)],
            markersize=6,
            markeredgecolor=PAPER,
            markeredgewidth=0.7,
            gid=f"series-{i}",
        )
        for x, y, error in zip(s["x"], s["y"], s["error"], strict=False):
            # A bar that ends near zero must not stretch a logarithmic axis.
            low = max(y - error, 0.3 * y) if plot["y_log"] else y - error
            axes.update_datalim([(x, low), (x, y + error)])
    axes.autoscale_view()
    if not plot["y_log"] and 0 <= axes.dataLim.y0 <= 0.3 * axes.dataLim.y1:
        axes.set_ylim(bottom=0)
    axes.autoscale(False)
    set_ticks(axes.xaxis, plot["x_log"])
    set_ticks(axes.yaxis, plot["y_log"])
    for s, line in zip(plot["series"], lines, strict=True):
        if any(s["error"]):
            bars = [error or math.nan for error in s["error"]]  # an error of 0 has no bar
            look = {"fmt": "none", "ecolor": line.get_color(), "elinewidth": 1, "capsize": 2.5}
            axes.errorbar(s["x"], s["y"], bars, **look)
    return sorted(lines, key=lambda line: -float(line.get_ydata()[-1]))


def add_legend(owner: Axes | Figure, lines: list[Line2D], **place: Any) -> None:
    # Matplotlib leaves out labels that begin with an underscore, so the texts are set afterwards.
    legend = owner.legend(lines, ["-"] * len(lines), **place)
    for text, line in zip(legend.get_texts(), lines, strict=True):
        text.set_text(line.get_label())


def picture(
    plot: dict[str, Any], kind: str, dpi: int = 72, wide: bool = True, page: bool = False
) -> bytes:
    """The plot as "png" or "svg", with the names of its lines at the right, or else below."""
    # No date and no version, so that equal input gives equal bytes.
    metadata = {"svg": {"Date": None, "Creator": None}, "png": {"Software": None}}[kind]
    style = STYLE | {
        # Ids begin with the hash, so that no two drawings of a page share one.
        "svg.hashsalt": f"{plot['id']} {wide}",
        "svg.fonttype": "none" if page else "path",
    }
    with plt.rc_context(style):
        figure, axes = plt.subplots(layout="constrained")
        lines = draw(axes, plot)
        if wide:
            figure.set_size_inches(9.4, 4.9)
            add_legend(axes, lines, loc="center left", bbox_to_anchor=(1.01, 0.5))
        else:
            rows = sum(line.get_label().count("\n") + 1 for line in lines)
            names, height = 0.16 * rows + 0.07 * len(lines) + 0.1, 3.0
            figure.set_size_inches(3.8, height + names)
            share = names / (height + names)
            figure.get_layout_engine().set(rect=(0, share, 1, 1 - share))
            add_legend(figure, lines, loc="lower left")
        if not page:
            axes.set_title(plot["title"], loc="left", fontsize=11, fontweight="bold")
        buffer = io.BytesIO()
        crop = None if page else "tight"
        figure.savefig(
            buffer, format=kind, dpi=dpi, bbox_inches=crop, transparent=page, metadata=metadata
        )
        plt.close(figure)
    return buffer.getvalue()


def page_style(style: str) -> str:
    """The style of an element with the page's font and colours."""
    style = re.sub(r"font: (?:\w+ )?([\d.]+px) [^;]*", r"font-size: \1", style)
    for colour, variable in VARIABLES.items():
        style = style.replace(colour, f"var(--{variable})")
    return style


def page_svg(plot: dict[str, Any], wide: bool) -> str:
    """The plot as an element of the page.

    The page holds a wide and a narrow drawing of each plot, and its style shows one of them. A
    single one, scaled, would have too small letters on a phone.
    """
    with warnings.catch_warnings():
        # The browser has fonts of its own for characters that Matplotlib's lacks.
        warnings.filterwarnings("ignore", "Glyph .* missing")
        text = picture(plot, "svg", wide=wide, page=True).decode()
    box = text[text.index("viewBox") : text.index(" xmlns=")]
    title = escape(f"{plot['title']}: {plot['y_label']} against {plot['x_label']}")
    root = ElementTree.fromstring(
        f'<svg class="plot {"wide" if wide else "narrow"}" {box} role="img" aria-label="{title}" '
        f'xmlns:xlink="{XLINK}">'
        # The head, left out, has a file's metadata, and a style for all elements.
        + text[text.index('<g id="figure_1">') :]
    )
    for i, s in enumerate(plot["series"]):
        markers = root.findall(f".//g[@id='series-{i}']//use")
        for marker, x, y in zip(markers, s["x"], s["y"], strict=True):
            ElementTree.SubElement(marker, "title").text = f"{s['label']}: " + minus(
                f"{x:.6g}, {y:.4g}"
            )
    for element in root.iter():
        if "style" in element.attrib:
            element.set("style", page_style(element.attrib["style"]))
        if link := element.attrib.pop(f"{{{XLINK}}}href", None):
            element.set("href", link)
        if not re.fullmatch("[mp][0-9a-f]{10}", element.get("id", "")):
            element.attrib.pop("id", None)
    return ElementTree.tostring(root, encoding="unicode")
