#!/usr/bin/python3
"""Makes one self-contained HTML page of report.json and the images that it names.

    make_report.py report.json -o report.html

The format of report.json is in README.md beside this file. Equal input gives equal bytes.
Exit codes: 0 done, 2 wrong options, 3 bad or missing input, 4 output cannot be written.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from html_page import page_html
from report_json import ReportError, load

sys.path.append(str(Path(__file__).resolve().parents[2] / "pipelines"))
import output_guard  # noqa: E402

__all__ = ["EXIT_INPUT", "EXIT_OUTPUT", "main", "output_guard", "write_output"]

EXIT_INPUT = 3
EXIT_OUTPUT = 4


def write_output(
    program: str, path: Path, data: bytes, kind: output_guard.Kind, report: Path
) -> int:
    """Writes the output. Returns the exit code, and prints the problem if there is one."""
    try:
        output_guard.write(path, data, kind, "-o", {"the report": report})
        return 0
    except output_guard.Refused as e:
        print(f"{program}: {e}", file=sys.stderr)
    except OSError as e:
        print(f"{program}: {path}: {e.strerror}; choose another place", file=sys.stderr)
    return EXIT_OUTPUT


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("report", type=Path, help="what to show (.json)")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the page (.html)")
    parser.add_argument("--quiet", action="store_true", help="no line about the page's size")
    options = parser.parse_args(arguments)
    try:
        page = page_html(load(options.report)).encode()
    except ReportError as e:
        print(f"make_report.py: {e}", file=sys.stderr)
        return EXIT_INPUT
    code = write_output("make_report.py", options.output, page, output_guard.HTML, options.report)
    if code == 0 and not options.quiet:
        print(f"make_report.py: {options.output}: {len(page) / 2**20:.1f} MiB", file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main())
