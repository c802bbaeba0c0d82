#!/usr/bin/env python3
"""Runs the quick size through the real tools and checks what must hold at any size: quick_run.py BIN FOLDER"""

import csv
import json
import subprocess
import sys
import unittest
from pathlib import Path

EVAL = Path(__file__).resolve().parents[1]
PARTS = {"methods", "scatter", "gather", "equal-time", "convergence", "sensitivity"}
BIN, FOLDER = (Path(word) for word in sys.argv[1:3])


class QuickRun(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        subprocess.run([sys.executable, EVAL / "evaluate.py", "--size", "quick", "--bin", BIN,
                        "--cache", FOLDER / "cache", "-o", FOLDER, "--quiet"], check=True)
        subprocess.run([sys.executable, EVAL / "report/make_report.py", FOLDER / "report.json",
                        "-o", FOLDER / "report.html"], check=True)
        cls.results = json.loads((FOLDER / "results.json").read_text())

    def rows(self, part: str, **wanted) -> list[dict]:
        return [row for row in self.results["results"]
                if row["part"] == part and all(row.get(key) == value for key, value in wanted.items())]

    def row(self, part: str, **wanted) -> dict:
        found = self.rows(part, **wanted)
        self.assertEqual(len(found), 1, (part, wanted))
        return found[0]

    def test_every_part_is_there(self):
        self.assertEqual({row["part"] for row in self.results["results"]}, PARTS)

    def test_thesis_scatter_is_too_bright(self):
        for view in ("u-shape-main", "veach-door-main"):
            guarded, even = (self.row("scatter", view=view, method=m) for m in ("local", "even"))
            self.assertGreater(even["mean_ratio"], 2 * guarded["mean_ratio"])

    def test_energy_is_about_right_even_at_this_size(self):
        for row in self.rows("methods", method="local"):
            self.assertAlmostEqual(row["mean_ratio"], 1.0, delta=0.15)

    def test_blue_noise_is_better_than_light(self):
        for view in ("u-shape-main", "veach-door-main"):
            light, ours = (self.row("methods", view=view, method=m) for m in ("light", "local"))
            self.assertLess(ours["rmse_over_mean"], light["rmse_over_mean"])

    def test_lightcuts_are_close_to_all(self):
        for row in self.rows("gather", label="lightcuts"):
            self.assertLess(row["cut_rmse"], 0.1)
            self.assertGreater(row["cut_rmse"], 0.0)

    def test_dark_room(self):
        tables = {t["id"]: t for t in json.loads((FOLDER / "report.json").read_text())["tables"]}
        dark = {row["label"]: row["dark_room"] for row in tables["scatter"]["rows"] if row["dark_room"] is not None}
        self.assertEqual(dark["--scatter guarded"], 0.0)
        self.assertGreater(dark["--scatter even"], 0.0)

    def test_every_run_is_told(self):
        with (FOLDER / "runs.csv").open() as file:
            runs = list(csv.DictReader(file))
        self.assertEqual(len(runs), len(self.results["runs"]))
        for run in runs:
            self.assertGreater(float(run["peak_mib"]), 0)
            self.assertTrue(run["options"])
        self.assertIn("commit", self.results["provenance"])

    def test_report_holds_the_pictures(self):
        page = (FOLDER / "report.html").read_text()
        self.assertGreater(len(page), 500_000)
        self.assertIn("U-shape", page)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
