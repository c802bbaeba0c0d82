#!/usr/bin/env python3
"""Runs the quick size through the real tools and checks what must hold at any size.

quick_run.py BIN FOLDER
"""

import csv
import itertools
import json
import subprocess
import sys
import unittest
from pathlib import Path
from typing import Any

EVAL = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(EVAL / "report"))
from page_case import PageCase  # noqa: E402
from test_support import WIDTH, browser  # noqa: E402

sys.path.insert(0, str(EVAL))
from bnvpl_eval.parts.gather import GATHERS  # noqa: E402
from bnvpl_eval.pipeline import METHODS  # noqa: E402

PARTS = {
    "methods",
    "scatter",
    "gather",
    "gather-equal-time",
    "claims",
    "equal-time",
    "convergence",
    "sensitivity",
}
TABLES = {
    "methods",
    "scatter",
    "gather",
    "claims",
    "equal-time",
    "energy",
    "references",
    "sensitivity",
}
PLOTS = {"convergence-vpls-u-shape", "convergence-time-u-shape"}
IMAGES = {"reference", *METHODS, "path"}
OVERLAYS = {
    "dots-random",
    "dots-uniform",
    "dots-local",
    "cut",
    "cut-lightcuts",
}
BIN, FOLDER = (Path(word) for word in sys.argv[1:3])


def setUpModule() -> None:
    subprocess.run(
        [
            sys.executable,
            EVAL / "evaluate.py",
            "--quick",
            "--bin",
            BIN,
            "--cache",
            FOLDER / "cache",
            "-o",
            FOLDER,
            "--quiet",
        ],
        check=True,
    )
    subprocess.run(
        [
            sys.executable,
            EVAL / "report/make_report.py",
            FOLDER / "report.json",
            "-o",
            FOLDER / "report.html",
        ],
        check=True,
    )


class QuickRun(unittest.TestCase):
    results: dict[str, Any]

    @classmethod
    def setUpClass(cls) -> None:
        cls.results = json.loads((FOLDER / "results.json").read_text())

    def rows(self, part: str, **wanted: object) -> list[dict[str, Any]]:
        return [
            row
            for row in self.results["results"]
            if row["part"] == part and all(row.get(key) == value for key, value in wanted.items())
        ]

    def row(self, part: str, **wanted: object) -> dict[str, Any]:
        found = self.rows(part, **wanted)
        self.assertEqual(len(found), 1, (part, wanted))
        return found[0]

    def test_every_part_is_there(self) -> None:
        self.assertEqual({row["part"] for row in self.results["results"]}, PARTS)

    def test_thesis_scatter_is_too_bright(self) -> None:
        for view in ("u-shape-main", "veach-door-main"):
            ours, even, literal = (
                self.row("scatter", view=view, method=m)["mean_ratio"]
                for m in ("local", "even", "literal")
            )
            self.assertGreater(literal, 4 * ours)
            # Emission points lie in the lit part, so the factor is less here.
            self.assertGreater(even, 1.5 * ours)

    def test_energy_is_about_right_even_at_this_size(self) -> None:
        for row in self.rows("methods", method="local"):
            self.assertAlmostEqual(row["mean_ratio"], 1.0, delta=0.15)

    def test_runs_have_about_the_mean_of_guided_paths(self) -> None:
        few = "cornell --preset draft --runs 2 --guided-runs 2 --width 24 --spp 2 --guided-spp 8"
        tools = ("--bin", str(BIN), "--cache", str(FOLDER / "cache"))
        command = [sys.executable, str(EVAL / "run_means.py"), *tools, *few.split()]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        room, mean, extremes, deviation, error = done.stdout.splitlines()[-1].strip("| ").split("|")
        self.assertEqual(room.strip(), "Cornell box")
        least, largest = (float(value) for value in extremes.split(","))
        self.assertTrue(least <= float(mean) <= largest and least < largest, extremes)
        self.assertAlmostEqual(float(mean), 1.0, delta=0.08)
        for percent in (deviation, error):
            self.assertGreater(float(percent.split()[0]), 0.0)

    def test_blue_noise_is_better_than_light(self) -> None:
        for view in ("u-shape-main", "veach-door-main"):
            light, ours = (self.row("methods", view=view, method=m) for m in ("light", "local"))
            self.assertLess(ours["rmse_over_mean"], light["rmse_over_mean"])

    def test_cuts_are_close_to_all(self) -> None:
        for gather in ("lightcuts", "tilecuts"):
            row = self.row("gather", label=gather)
            self.assertLess(row["cut_rmse"], 0.1, gather)
            self.assertGreater(row["cut_rmse"], 0.0, gather)

    def test_every_gather_has_a_row(self) -> None:
        for part in ("gather", "gather-equal-time"):
            self.assertEqual({row["label"] for row in self.rows(part)}, set(GATHERS))
        for row in self.rows("gather"):
            self.assertGreaterEqual(row["equal_spp"], 1)
            self.assertGreater(row["equal_relmse"], 0.0)
            self.assertAlmostEqual(
                row["mean_ratio"],
                self.row("gather", view=row["view"], label="all")["mean_ratio"],
                delta=0.1,
            )

    def test_rejection_is_better_than_all_that_the_lights_send(self) -> None:
        for view in ("u-shape-main", "veach-door-main"):
            light, chosen = (
                self.row("methods", view=view, method=m) for m in ("light", "rejection")
            )
            self.assertLess(chosen["rmse_over_mean"], light["rmse_over_mean"])

    def test_claims_have_a_row_each(self) -> None:
        tables = {t["id"]: t for t in json.loads((FOLDER / "report.json").read_text())["tables"]}
        rows = tables["claims"]["rows"]
        self.assertEqual(len(rows), 8)
        self.assertEqual(
            {row["label"] for row in rows}, {"ward", "stochastic", "lightslice", "rejection"}
        )
        for row in rows:
            self.assertIn(row["holds"], ("yes", "no"))
            self.assertTrue(row["measured"])

    def test_rows_tell_their_options(self) -> None:
        for row in self.rows("sensitivity"):
            self.assertIn("--near-field-rays 4", row["render_options"])
        for row in self.rows("methods", method="uniform"):
            self.assertEqual(row["eliminate_options"], "--density uniform")
            self.assertEqual(row["seed_numbers"], "1 2")

    def test_flip_and_smape_are_of_all_seeds(self) -> None:
        for row in self.rows("methods"):
            for key in ("smape", "flip", "hdr_flip"):
                self.assertGreater(row[key], 0.0, key)
                self.assertGreater(row[f"{key}_error"], 0.0, key)  # two seeds, two images

    def test_dark_room(self) -> None:
        tables = {t["id"]: t for t in json.loads((FOLDER / "report.json").read_text())["tables"]}
        dark = {
            row["label"]: row["dark_room"]
            for row in tables["scatter"]["rows"]
            if row["dark_room"] is not None
        }
        self.assertEqual(dark["--method guarded"], 0.0)
        self.assertGreater(dark["--method even"], 0.0)

    def test_every_run_is_told(self) -> None:
        with (FOLDER / "runs.csv").open() as file:
            runs = list(csv.DictReader(file))
        self.assertEqual(len(runs), len(self.results["runs"]))
        for run in runs:
            self.assertGreater(float(run["peak_mib"]), 0)
            self.assertTrue(run["options"])
            self.assertIn(
                run["commit"], self.results["provenance"]["commits of the runs"].split(", ")
            )
        self.assertIn("commit", self.results["provenance"])

    def test_report_holds_the_pictures(self) -> None:
        page = (FOLDER / "report.html").read_text()
        self.assertGreater(len(page), 500_000)
        self.assertIn("U-shape", page)

    def test_report_has_everything(self) -> None:
        report = json.loads((FOLDER / "report.json").read_text())
        self.assertEqual({table["id"] for table in report["tables"]}, TABLES)
        self.assertEqual({plot["id"] for plot in report["plots"]}, PLOTS)
        views = [view for scene in report["scenes"] for view in scene["views"]]
        self.assertEqual(len(views), 2)
        for view in views:
            self.assertEqual({image["id"] for image in view["images"]}, IMAGES)
            self.assertLessEqual(OVERLAYS, {picture["id"] for picture in view["pictures"]})
            for image in view["images"]:
                self.assertEqual(
                    "relMSE" in image["numbers"],
                    image["id"] not in ("reference", "path"),
                    image["id"],
                )


class RealPage(PageCase):
    """Opens the report of the quick size in a browser, whose console stays silent."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.url = (FOLDER / "report.html").resolve().as_uri()
        cls.driver = browser()
        cls.addClassCleanup(cls.driver.quit)

    def test_views_can_be_compared(self) -> None:
        for index in range(2):
            self.viewer = self.reach(index)
            names = {
                n.get_attribute("textContent")
                for n in self.viewer.find_elements("css selector", ".list .name")
            }
            self.assertEqual(len(names), len(IMAGES) + len(OVERLAYS))
            # Each mode of the viewer shows another row of pixels through the middle.
            seen = [self.middle_row()]
            for key in ("e", "m", "m", "m", "^9", "f"):
                self.keys(key)
                seen.append(self.middle_row())
            for before, after in itertools.pairwise(seen):
                self.assertNotEqual(before, after)

    def middle_row(self) -> list[Any]:
        self.until(lambda: bool(self.viewer.get_attribute("aria-busy") == "false"))
        return self.colours([((k + 0.5) / 32 * WIDTH, 0.28 * WIDTH) for k in range(32)])

    def test_narrow_and_dark(self) -> None:
        self.open(400, "dark")
        self.assertLessEqual(self.js("return document.documentElement.scrollWidth"), 400)
        self.assertTrue(any(max(pixel) > 20 for pixel in self.middle_row()))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
