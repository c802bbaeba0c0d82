#!/usr/bin/python3
"""Draws one plot of report.json into a PNG or SVG file, for documents.

    plots.py report.json PLOT_ID -o convergence.png

Equal input gives equal bytes. Exit codes: 0 done, 2 wrong options, 3 bad or missing input, 4
output cannot be written.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from make_report import EXIT_INPUT, output_guard, write_output
from plot_figure import picture
from report_json import ReportError, load


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
