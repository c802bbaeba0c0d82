#!/usr/bin/env python3
"""Tests the cost model of the stages: its fit, its shards, its scenes and what is stored of it."""

import argparse
import json
import re
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path[:0] = [
    str(SOURCE / folder) for folder in ("pipelines", "pipelines/slurm", "eval/scaling")
]
import cost  # noqa: E402
import fit  # noqa: E402
import needs  # noqa: E402
import scenes  # noqa: E402


class ModelTest(unittest.TestCase):
    def test_rates_are_found_again(self) -> None:
        terms = cost.TERMS["render"]["cpu_s"]
        true = {"start": 0.1, "VPLs": 2e-5, "samples": 3e-6, "samples log2(VPLs)": 1e-6}
        model = cost.Model({"render": {"cpu_s": true}})
        some = [
            cost.Counts(1000, 0, v, 0, px, spp, n)
            for v in (1e3, 1e4, 1e5)
            for px in (5e3, 5e4)
            for spp in (1, 4, 16)
            for n in (1, 8)
        ]
        found = cost.Model(
            {
                "render": {
                    "cpu_s": fit.rates(
                        terms, [(c, model.predict("render", "cpu_s", c)) for c in some]
                    )
                }
            }
        )
        for counts in some + [cost.Counts(1000, 0, 3e4, 0, 1e6, 32, 1)]:
            self.assertAlmostEqual(
                found.predict("render", "cpu_s", counts) / model.predict("render", "cpu_s", counts),
                1,
                2,
            )

    def test_no_rate_is_negative(self) -> None:
        terms = {"one": lambda c: 1, "n": lambda c: c.vpls}
        runs = [(cost.Counts(vpls=v), 10 / v) for v in (1, 2, 5, 10)]
        self.assertTrue(all(rate >= 0 for rate in fit.rates(terms, runs).values()))

    def test_shards_share_the_work_and_repeat_the_set_up(self) -> None:
        model = cost.load()
        whole = cost.Counts(1e6, 4e6, 1e5, 1e9, 8e6, 16)
        part = cost.Counts(1e6, 4e6, 1e5, 1e9, 8e6, 16, shards=100)
        for stage in "place", "estimate":
            setup = model.setup_s(stage, whole)
            self.assertAlmostEqual(
                model.predict(stage, "cpu_s", part) - setup,
                (model.predict(stage, "cpu_s", whole) - setup) / 100,
                places=6,
            )

    def test_pairs_are_those_of_the_tools_steps(self) -> None:
        source = (SOURCE / "tools/eliminate/elimination/elimination.cpp").read_text()
        found = re.search(r"kMaxPerVpl = (\d+), kStepFactor = (\d+), kMaxWork = 0x1p(\d+);", source)
        assert found
        each, factor, work = (int(number) for number in found.groups())
        ours = cost.MAX_PER_VPL, cost.STEP_FACTOR, cost.MAX_WORK
        self.assertEqual(ours, (each, factor, 2**work))

    def test_jobs_get_the_memory_that_vpl_render_asks_for(self) -> None:
        source = (SOURCE / "tools/render/outputs.cpp").read_text()
        sums, fireflies = (
            int(re.search(pattern, source)[1])  # type: ignore[index]
            for pattern in (r"double bytes = (\d+);", r"Fireflies\(options\)\) bytes \+= (\d+);")
        )
        model = cost.load()
        for pixels in 1920 * 1080, 3840 * 2160:
            counts = cost.Counts(1e5, 1e6, 1e5, 1e7, pixels, 16)
            given = needs.memory_MiB(model.predict("render", "memory_MiB", counts))
            self.assertGreater(given, (sums + fireflies) * pixels / 2**20 + 64)

    def test_jobs_get_the_memory_that_vpl_estimate_asks_for(self) -> None:
        # memory_of_sums.h: the sums of photons of each thread, and their total.
        points = int(
            re.search(  # type: ignore[index]
                r'"emit-points", "(\d+)"', (SOURCE / "tools/estimate/emit_points.h").read_text()
            )[1]
        )
        sums = 104 + 32 * points
        model = cost.load()
        for threads in 1, 4, 16, 64:
            for vpls in 5e4, 1e6:
                counts = cost.Counts(1e4, 40 * vpls, vpls, 1e7, threads=threads)
                given = needs.memory_MiB(model.predict("estimate", "memory_MiB", counts))
                asked = vpls * (300 + (threads + 1) * sums) / 2**20
                self.assertGreater(given, asked, (threads, vpls))

    def test_films_of_views(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            view = Path(folder) / "view.toml"
            for text, film in (
                ("[camera]\n", "640x480"),
                ("[film]\nwidth = 100\n", "100x480"),
                ("[film]\nwidth = 100\nheight = 50\n", "100x50"),
            ):
                view.write_text(text)
                self.assertEqual(needs.film_of(str(view), "640x480"), film)
            view.write_text("[film\n")
            with self.assertRaises(SystemExit) as refused:
                needs.film_of(str(view), "640x480")
            self.assertRegex(str(refused.exception), f"{view}: .*; supply a TOML file")

    def test_the_film_is_that_of_the_camera_or_of_the_size(self) -> None:
        seen = {"cameras": [{"name": "Room", "film": "64x48"}, {"name": "a b", "film": "320x200"}]}
        for flags, pixels in (
            ("", 64 * 48),
            ("--camera 1", 320 * 200),
            ("--spp 4 --camera='a b'", 320 * 200),
            ("--camera 'a b' --size 10x20", 200),
            ("--camera Hall", 64 * 48),
        ):
            options = argparse.Namespace(render_flags=flags, views=[])
            self.assertEqual(needs.pixels_of(seen, options), pixels, flags)

    def test_scenes_are_cut_and_not_changed(self) -> None:
        def area(obj: Path) -> float:
            vertices, _, faces = scenes.faces_of(obj)
            return sum(
                scenes.area(vertices, [face[0], face[i], face[i + 1]])
                for _, face in faces
                for i in range(1, len(face) - 1)
            )

        with tempfile.TemporaryDirectory() as folder:
            file, made = scenes.cut_scene(SOURCE / "scenes/cornell/scene.toml", Path(folder), 5000)
            cut = file.parent / "cornell.obj"
            self.assertEqual(len(scenes.faces_of(cut)[2]), made)
            self.assertAlmostEqual(made / 5000, 1, delta=0.1)
            self.assertAlmostEqual(area(cut) / area(SOURCE / "scenes/cornell/cornell.obj"), 1, 5)

    def test_the_stored_model_has_all_stages_and_checks(self) -> None:
        stored = json.loads(cost.MODEL.read_text())
        self.assertEqual(stored["rates"].keys(), cost.TERMS.keys())
        for stage, figures in stored["rates"].items():
            for figure, rates in figures.items():
                self.assertTrue(rates.keys() <= cost.TERMS[stage][figure].keys())
        self.assertEqual({check["stage"] for check in stored["checks"]}, cost.TERMS.keys())


if __name__ == "__main__":
    unittest.main()
