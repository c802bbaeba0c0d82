#!/usr/bin/env python3
"""Runs the comparison of gathers at its quick size, and checks what must hold at any size.

field_run.py BIN FOLDER
"""

import json
import subprocess
import sys
import unittest
from pathlib import Path
from typing import Any

EVAL = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(EVAL))
from bnvpl_eval import pipeline  # noqa: E402
from bnvpl_eval.runner import Runner  # noqa: E402

BIN, FOLDER = (Path(word) for word in sys.argv[1:3])


def python(script: str, *words: object) -> None:
    subprocess.run([sys.executable, EVAL / script, *map(str, words)], check=True)


class FieldRun(unittest.TestCase):
    rows: list[dict[str, Any]]
    gathers: list[str]

    @classmethod
    def setUpClass(cls) -> None:
        options = ("--bin", BIN, "--cache", FOLDER / "cache", "-o", FOLDER, "--quiet")
        python("evaluate.py", "--size", "field-quick", "--parts", "field", *options)
        python("report/make_report.py", FOLDER / "report.json", "-o", FOLDER / "report.html")
        cls.rows = json.loads((FOLDER / "results.json").read_text())["results"]
        runner = Runner(BIN, FOLDER / "cache", quiet=True)
        cls.gathers = pipeline.methods_of(runner, "vpl-render", "gather")

    def test_every_gather_has_a_row_for_each_count(self) -> None:
        found = {(r["gather"], r["vpls"]) for r in self.rows if r["at"] == "equal VPLs"}
        self.assertEqual(found, {(g, n) for g in self.gathers for n in (25, 50)})

    def test_all_vpls_are_the_common_limit(self) -> None:
        """No gather has another mean than that of all VPLs, by more than its own noise."""
        rows = [r for r in self.rows if r["at"] == "equal VPLs" and r["vpls"] == 50]
        means = {r["gather"]: r["mean_ratio"] for r in rows}
        for gather, mean in means.items():
            self.assertAlmostEqual(mean / means["all"], 1.0, delta=0.1, msg=gather)

    def test_kinds_of_light_stand_beside_compensations(self) -> None:
        at_time = {(r["gather"], r["compensate"]) for r in self.rows if r["at"] == "equal time"}
        self.assertLessEqual({("tilecuts", "near-field"), ("tilecuts", "spherical")}, at_time)
        self.assertNotIn(("tilecuts", "yuksel"), at_time)  # it is not among this size's kinds

    def test_measures_are_there(self) -> None:
        for row in self.rows:
            for key in ("relmse", "rmse_over_mean", "smape", "flip", "bias_over_mean"):
                self.assertIsNotNone(row.get(key), f"{row['gather']}: {key}")
            self.assertGreater(row["shadow_rays"], 0, row["gather"])
            self.assertGreater(row["render_peak_mib"], 1, row["gather"])

    def test_the_page_has_what_the_rows_name(self) -> None:
        report = json.loads((FOLDER / "report.json").read_text())
        images = {i["id"] for s in report["scenes"] for v in s["views"] for i in v["images"]}
        pictures = [r["picture"] for r in report["tables"][0]["rows"] if r["picture"]]
        self.assertGreaterEqual(len(pictures), len(self.gathers) // 2)
        self.assertLessEqual({p["image"] for p in pictures}, images)
        texts = {r["name"]: r["text"] for r in report["tables"][1]["rows"]}
        self.assertLess({*self.gathers, "near-field", "spherical"}, set(texts))
        self.assertTrue(all(len(text) > 40 for text in texts.values()))
        self.assertEqual([r["diagram"] for r in report["tables"][1]["rows"]], list(texts))
        page = (FOLDER / "report.html").read_text()
        self.assertEqual(page.count('<svg class="diagram"'), len(texts))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
