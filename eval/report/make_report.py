#!/usr/bin/python3
"""Makes one self-contained HTML page of report.json and the images that it names.

    make_report.py report.json -o report.html

The format of report.json is in README.md beside this file. Equal input gives equal bytes.
Exit codes: 0 done, 2 wrong options, 3 bad or missing input, 4 output cannot be written.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from html_page import page_html
from report_json import ReportError, load

EXIT_INPUT = 3
EXIT_OUTPUT = 4


def write_whole(path: Path, data: bytes) -> None:
    """The old file or the whole new one, never half of it."""
    partial = path.with_name(path.name + ".partial")
    try:
        partial.write_bytes(data)
        os.replace(partial, path)
    except OSError:
        partial.unlink(missing_ok=True)
        raise


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("report", type=Path, help="what to show (.json)")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the page (.html)")
    parser.add_argument("--quiet", action="store_true", help="no line about the page's size")
    options = parser.parse_args(arguments)
    try:
        page = page_html(load(options.report)).encode()
    except ReportError as e:
        print(f"make_report.py: {e}", file=sys.stderr)
        return EXIT_INPUT
    try:
        write_whole(options.output, page)
    except OSError as e:
        print(f"make_report.py: {options.output}: {e.strerror}; choose another place",
              file=sys.stderr)
        return EXIT_OUTPUT
    if not options.quiet:
        print(f"make_report.py: {options.output}: {len(page) / 2**20:.1f} MiB", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
