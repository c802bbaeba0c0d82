#!/usr/bin/python3
"""Fits pipelines/cost_model.json, the cost of each stage, to runs, and checks it on other runs.

    eval/scaling/cost_model.py              measure, fit, check; about ten minutes of one core
    eval/scaling/cost_model.py --once       the same without repeats
    eval/scaling/cost_model.py --keep F     keep measurements in F, repeat none that it has
    eval/scaling/cost_model.py --table      print the tables of README.md from cost_model.json

CPU seconds are user and system time, of one thread but where a run names more. Runs are repeated
two to eight times, until the two least agree within 4 %; the least counts. design.py lists the
runs.
"""

import argparse
import dataclasses
import json
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "bench"), str(ROOT / "pipelines")]
import cost  # noqa: E402
import cost_tables  # noqa: E402
import design  # noqa: E402
import fit  # noqa: E402
import measure  # noqa: E402
import output_guard  # noqa: E402
import scenes  # noqa: E402
import size  # noqa: E402

Row = dict[str, Any]
KEYS = ("build", "role", "scene", "triangles", "stage", "counts")  # what tells runs apart


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    file: Path
    triangles: int


def make_scene(name: str, triangles: int, folder: Path) -> Scene:
    here = folder / f"{name}-{triangles}"
    if name == "size":  # the room of size.py, which has no walls, and a point light
        here.mkdir()
        file = size.Size(argparse.Namespace(bin=None, most=1.0, cpu=True), here).room(
            triangles, 0, 1
        )
        with open(here / "size.obj") as obj:
            made = sum(line.startswith("f ") for line in obj)
    else:
        file, made = scenes.cut_scene(ROOT / f"scenes/{name}/scene.toml", here, triangles)
    return Scene(here.name, file, made)


def same_run(a: Row, b: Row) -> bool:
    return all(a.get(key) == b[key] for key in KEYS)


def build_of(bin_folder: Path) -> str:
    """The version and build of the tools."""
    command = [str(bin_folder / "vpl-render"), "--version"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def measure_all(
    bin_folder: Path, had: list[Row], once: bool, keep: Callable[[list[Row]], None]
) -> list[Row]:
    """Measures all runs that `had` lacks. Returns one row a run, with its figures.

    Each round measures every run that still needs a repeat, so repeats lie apart in time. keep()
    gets the rows that are done after each of them.
    """
    build = build_of(bin_folder)
    with tempfile.TemporaryDirectory(prefix="bnvpl-cost-") as name:
        bench, known, runs, rows = measure.Bench(bin_folder, Path(name)), {}, [], []
        groups = [
            ("fit", design.FITTED),
            ("check", design.CHECKED),
            ("scale", [(*scene, design.SCALED_BY) for scene in design.OTHERS]),
            ("other", [(*scene, design.OTHER_RUNS) for scene in design.OTHERS]),
        ]
        for role, (scene, triangles, chosen) in [
            (role, group) for role, members in groups for group in members
        ]:
            if (key := (scene, triangles)) not in known:
                known[key] = make_scene(scene, triangles, Path(name))
            for stage, given in chosen:
                row = {
                    "build": build,
                    "role": role,
                    "scene": scene,
                    "triangles": known[key].triangles,
                    "stage": stage,
                    "counts": given,
                }
                if found := [each for each in had if same_run(each, row)]:
                    rows += found
                else:
                    runs.append((known[key], measure.Repeated(row, once)))
        while wanted := [(scene, run) for scene, run in runs if run.wanted()]:
            for made, run in wanted:
                run.taken.append(bench.measure(made, run.row["stage"], counts_of(run.row)))
            print(
                f"{len(wanted)} runs of {len(runs)}, {bench.spent_s:.0f} CPU s so far",
                file=sys.stderr,
                flush=True,
            )
            keep(rows + [run.result() for _, run in runs if not run.wanted()])
        return rows + [run.result() for _, run in runs]


def counts_of(row: Row) -> cost.Counts:
    return design.counts(row["triangles"], row["counts"])


def fitted(rows: list[Row]) -> cost.Rates:
    """Rates {stage: {figure: {term: rate}}} of the model."""
    chosen = [row for row in rows if row["role"] == "fit"]
    return {
        stage: {
            figure: fit.rates(
                terms, [(counts_of(row), row[figure]) for row in chosen if row["stage"] == stage]
            )
            for figure, terms in figures.items()
        }
        for stage, figures in cost.TERMS.items()
    }


def scales(model: cost.Model, rows: list[Row]) -> dict[str, dict[str, float]]:
    """Ratio of measured to predicted time without loading: {scene: {stage: ratio}}."""
    found: dict[str, dict[str, float]] = {}
    for row in rows:
        if row["role"] == "scale":
            loading = model.loading_s(row["stage"], counts_of(row))
            work = model.predict(row["stage"], "cpu_s", counts_of(row)) - loading
            found.setdefault(row["scene"], {})[row["stage"]] = float(
                f"{max(0.0, row['cpu_s'] - loading) / work:.3g}"
            )
    return found


def checks(model: cost.Model, rows: list[Row]) -> list[Row]:
    """Measured and predicted figures of the runs to which the model was not fitted."""
    scale, found = scales(model, rows), []
    for row in rows:
        if row["role"] in ("check", "other"):
            stage, counts = row["stage"], counts_of(row)
            said = {figure: model.predict(stage, figure, counts) for figure in cost.TERMS[stage]}
            check = {key: row[key] for key in ("scene", "triangles", "stage", "counts")}
            check["figures"] = {
                figure: [row[figure], float(f"{value:.4g}")] for figure, value in said.items()
            }
            if row["role"] == "other":
                loading = model.loading_s(stage, counts)
                check["scaled_cpu_s"] = float(
                    f"{loading + scale[row['scene']][stage] * (said['cpu_s'] - loading):.4g}"
                )
            found.append(check)
    return found


ROWS = output_guard.json_kind(
    "runs of cost_model.py",
    lambda rows: (
        isinstance(rows, list)
        and all(isinstance(row, dict) and "role" in row and "stage" in row for row in rows)
    ),
)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    parser.add_argument("--keep", type=Path, metavar="F")
    parser.add_argument("--once", action="store_true", help="no repeats, on a quiet machine")
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    if not options.table:
        if options.keep:
            output_guard.or_exit(output_guard.check, options.keep, ROWS, "--keep")
        had = json.loads(options.keep.read_text()) if options.keep and options.keep.exists() else []

        def keep(rows: list[Row]) -> None:
            if options.keep:
                text = json.dumps(rows, indent=1) + "\n"
                output_guard.or_exit(output_guard.write, options.keep, text, ROWS, "--keep")

        rows = measure_all(options.bin.resolve(), had, options.once, keep)
        rates = fitted(rows)
        model = cost.Model(rates)
        cost.MODEL.write_text(
            json.dumps(
                {"rates": rates, "scales": scales(model, rows), "checks": checks(model, rows)},
                indent=1,
            )
            + "\n"
        )
    print(cost_tables.tables(json.loads(cost.MODEL.read_text())), end="")


if __name__ == "__main__":
    main()
