#!/usr/bin/python3
"""Runs the benchmarks and compares them with the committed figures of bench/baseline.json.

    bench/compare.py                 run all, and print a table of now, then and their ratio
    bench/compare.py --filter place  run the benchmarks whose name matches a regular expression
    bench/compare.py --save          also write bench/baseline.json

A figure is the wall time per iteration, the least of --runs runs, since other load only adds to it.
Run it on a quiet machine, and compare ratios of one machine only. The scene is Sponza where
SPONZA_DIR is set, else the U-shape. Figures of the other scene are not compared.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
BASELINE = ROOT / "bench/baseline.json"
PROGRAMS = ["bench_stages", "bench_eliminate"]
NOTABLE = 0.1  # relative change above which a row is marked


def measure(folder: Path, name_filter: str, seconds: float) -> dict[str, float]:
    scene = "sponza" if "SPONZA_DIR" in os.environ else "u-shape"
    found = {}
    for program in PROGRAMS:
        if not (folder / program).is_file():
            sys.exit(
                f"compare.py: {folder / program}: no such program; build it: cmake --build "
                "--preset release"
            )
        done = subprocess.run(
            [
                folder / program,
                f"--benchmark_filter={name_filter}",
                "--benchmark_format=json",
                f"--benchmark_min_time={seconds}",
            ],
            capture_output=True,
            text=True,
        )
        if done.returncode != 0:
            sys.exit(f"compare.py: {program} failed: {done.stderr.strip()}")
        if not done.stdout.strip():
            continue  # no benchmark of this program matches the filter
        for row in json.loads(done.stdout)["benchmarks"]:
            where = f"{scene}: " if program == "bench_stages" else ""
            found[where + row["name"].replace("/process_time", "").replace("/real_time", "")] = row[
                "real_time"
            ]
    return found


def show(now: dict[str, float], then: dict[str, Any]) -> None:
    print(f"{'benchmark':52} {'now, ms':>10} {'then, ms':>10} {'ratio':>7}")
    for name, value in now.items():
        before = then.get("milliseconds", {}).get(name)
        ratio = f"{value / before:7.2f}" if before else "      -"
        mark = (
            ""
            if not before or abs(value / before - 1) < NOTABLE
            else " slower"
            if value > before
            else " faster"
        )
        print(f"{name:52} {value:10.1f} {before if before else float('nan'):10.1f} {ratio}{mark}")
    if then:
        print(f"then: commit {then['commit']} on {then['machine']}")


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--filter", default=".", help="regular expression on names")
    parser.add_argument(
        "--min-time", type=float, default=0.3, help="seconds for each (default 0.3)"
    )
    parser.add_argument(
        "--runs", type=int, default=3, help="of which the least time counts (default 3)"
    )
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    parser.add_argument("--save", action="store_true", help="write bench/baseline.json")
    options = parser.parse_args()
    if options.runs < 1:
        parser.error("--runs wants 1 or more")
    then = json.loads(BASELINE.read_text()) if BASELINE.is_file() else {}
    now: dict[str, float] = {}
    for _ in range(options.runs):
        for name, value in measure(options.bin, options.filter, options.min_time).items():
            now[name] = min(value, now.get(name, value))
    if not now:
        sys.exit(f"compare.py: no benchmark matches '{options.filter}'")
    show(now, then)
    if options.save:
        commit = subprocess.run(
            ["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True
        )
        BASELINE.write_text(
            json.dumps(
                {
                    "commit": commit.stdout.strip(),
                    "machine": f"{os.cpu_count()} cores, {platform.machine()}",
                    "milliseconds": then.get("milliseconds", {}) | now,
                },
                indent=1,
            )
            + "\n"
        )


if __name__ == "__main__":
    main()
