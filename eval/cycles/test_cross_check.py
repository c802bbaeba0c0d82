#!/usr/bin/python3
"""Tests the cross-check. Tests that need Blender are skipped where it is missing.

python3 eval/cycles/test_cross_check.py
"""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import cases  # noqa: E402
import compare  # noqa: E402
import cross_check  # noqa: E402
from both_renderers import cycles_bounces, missing_images  # noqa: E402
from in_folder import InFolder  # noqa: E402
from judgement import verdict  # noqa: E402

ROOT = HERE.parent.parent
VPL_RENDER = os.environ.get("VPL_RENDER", str(ROOT / "build/release/bin/vpl-render"))


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, str(HERE / "cross_check.py"), *arguments],
        capture_output=True,
        text=True,
        check=False,
    )


class Statistics(unittest.TestCase):
    def setUp(self) -> None:
        random = np.random.default_rng(7)
        self.a = 1.02 * random.gamma(4.0, 0.25, (4, 40, 36, 3))
        self.b = random.gamma(4.0, 0.25, (4, 40, 36, 3))

    def test_ratio_and_its_error(self) -> None:
        mean = compare.compare(self.a, self.b)["mean"]
        # Each image has 4 seeds x 1440 pixels x 3 channels with a standard deviation of 0.5.
        self.assertAlmostEqual(mean["error"], np.sqrt(2) * 0.5 / np.sqrt(4 * 1440 * 3), delta=2e-3)
        self.assertLess(abs(mean["ratio"] - 1.02), 3 * mean["error"])

    def test_a_local_difference_is_found_where_it_is(self) -> None:
        self.a[:, 16:24, 32:36] *= 2.0
        blocks = compare.compare(self.a, self.b)["blocks"]
        self.assertEqual((blocks["worst"]["x"], blocks["worst"]["y"]), (32, 16))
        self.assertAlmostEqual(blocks["worst"]["relative"], 1.04, delta=0.2)
        self.assertEqual(blocks["count"], 25)

    def test_black_blocks_do_not_dilute_the_errors(self) -> None:
        lit = compare.compare(self.a, self.b)["blocks"]
        dark = np.zeros((4, 40, 360, 3))
        wide = [np.concatenate([image, dark], axis=2) for image in (self.a, self.b)]
        blocks = compare.compare(*wide)["blocks"]
        for name in "mean_square_z", "root_mean_square_relative":
            self.assertAlmostEqual(blocks[name], lit[name], delta=0.15 * lit[name])
        self.assertEqual(compare.compare(dark, dark)["blocks"]["mean_square_z"], 0.0)

    def test_black_against_black_and_against_light(self) -> None:
        black = np.zeros_like(self.a)
        self.assertEqual(compare.compare(black, black)["mean"]["ratio"], 1.0)
        self.assertIsNone(compare.compare(self.a, black)["mean"]["ratio"])

    def test_one_seed_or_two_sizes_are_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "two seeds"):
            compare.compare(self.a[:1], self.b[:1])
        with self.assertRaisesRegex(ValueError, "sizes differ"):
            compare.compare(self.a, self.b[:, :, :30])

    def test_verdict(self) -> None:
        def of(ratio: float | None, error: float) -> str:
            return verdict({"mean": {"ratio": ratio, "error": error}}, 0.01)

        self.assertEqual(of(1.009, 0.001), "agrees")
        self.assertEqual(of(0.985, 0.001), "differs")
        self.assertEqual(of(1.012, 0.004), "differs")
        self.assertEqual(of(1.0, 0.006), "noisy")
        self.assertEqual(of(1.2, 0.02), "differs")
        self.assertEqual(of(None, 0.0), "differs")
        mean = {"mean": {"ratio": 1.05, "error": 0.001}}
        told = mean | {"expected": 1.048, "expected_error": 0.001}
        self.assertEqual(verdict(told, 0.01), "agrees")
        told = mean | {"expected": 1.048, "expected_error": 0.006}
        self.assertEqual(verdict(told, 0.01), "noisy")


class CommandLine(InFolder):
    def test_indirect_needs_the_direct_picture(self) -> None:
        self.assertEqual(cycles_bounces((cases.INDIRECT,)), [0, 32])
        self.assertEqual(cycles_bounces((cases.View("all", 5),)), [5])

    def test_images_of_another_build_or_scene_are_not_reused(self) -> None:
        self.write("ours.all.16spp.1.exr", "")
        self.write("sky.exr", "")
        cross_check.drop_others(self.folder, "a")
        self.assertEqual([file.name for file in self.folder.glob("*.exr")], ["sky.exr"])
        self.write("ours.all.16spp.1.exr", "")
        cross_check.drop_others(self.folder, "a")
        self.assertTrue((self.folder / "ours.all.16spp.1.exr").is_file())
        cross_check.drop_others(self.folder, "b")
        self.assertFalse((self.folder / "ours.all.16spp.1.exr").is_file())

    def test_reuse_renders_only_what_is_missing(self) -> None:
        def path(bounces: int, seed: int) -> Path:
            return self.folder / f"{bounces}.{seed}"

        for name in ("0.1", "0.2", "1.1"):
            self.write(name, "")
        seeds = range(1, 4)
        self.assertEqual(
            missing_images([0, 1, 32], seeds, path, True),
            {(3,): [0], (2, 3): [1], (1, 2, 3): [32]},
        )
        self.assertEqual(missing_images([0, 1], seeds, path, False), {(1, 2, 3): [0, 1]})

    def assert_one_line(self, done: subprocess.CompletedProcess[str], code: int, said: str) -> None:
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn(said, done.stderr)

    def test_files_of_others_stay(self) -> None:
        """Files of others stay, even where OUT is the folder of the scenes."""
        scene = self.folder / "room-point" / "scene.toml"
        cases.prepare(
            next(case for case in cases.CASES if case.name == "room-point"),
            ROOT / "scenes",
            scene.parent,
        )
        cases.prepare(
            next(case for case in cases.CASES if case.name == "room-point"),
            ROOT / "scenes",
            scene.parent,
        )
        scene.write_text("[film]\nwidth = 8\n")
        fake = self.write("fake", "#!/bin/sh\nexit 0\n")
        fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
        words = (
            "room-point",
            "--blender",
            str(fake),
            "--vpl-render",
            str(fake),
            "--out",
            str(self.folder),
        )
        self.assert_one_line(
            command(*words), 3, "scene.toml: is not a scene that cross_check.py made"
        )
        self.assertEqual(scene.read_text(), "[film]\nwidth = 8\n")
        results = self.write("results.json", '{"asset": {"version": "2.0"}}')
        self.assert_one_line(
            command(*words),
            3,
            "results.json: is not results of cross_check.py, which --results would",
        )
        self.assertEqual(results.read_text(), '{"asset": {"version": "2.0"}}')

    def test_no_blender_is_one_line_and_code_3(self) -> None:
        done = command("cornell", "--blender", "no-such-blender", "--out", str(self.folder))
        self.assert_one_line(done, 3, "no-such-blender: no such program; apt-get install")

    def test_a_table_of_nothing_is_code_3(self) -> None:
        done = command("--table", "--out", str(self.folder))
        self.assert_one_line(done, 3, "results.json")

    def test_an_unknown_case_is_code_2(self) -> None:
        done = command("cornel")
        self.assertEqual(done.returncode, 2)
        self.assertIn("no case 'cornel'", done.stderr)

    def test_a_blender_that_writes_nothing_is_code_3(self) -> None:
        fake = self.write("fake", "#!/bin/sh\nexit 0\n")
        fake.chmod(fake.stat().st_mode | stat.S_IXUSR)
        if not Path(VPL_RENDER).is_file():
            self.skipTest("no vpl-render")
        done = command(
            "room-point",
            "--effort",
            "0.004",
            "--blender",
            str(fake),
            "--vpl-render",
            VPL_RENDER,
            "--out",
            str(self.folder / "out"),
        )
        self.assert_one_line(done, 3, "fake failed: exit code 0; all it said is in")
        self.assertFalse((self.folder / "out" / "results.json").exists())

    @unittest.skipUnless(shutil.which("blender") and Path(VPL_RENDER).is_file(), "no Blender")
    def test_a_small_cornell_box_agrees(self) -> None:
        done = command(
            "cornell",
            "--effort",
            "0.03",
            "--tolerance",
            "0.05",
            "--vpl-render",
            VPL_RENDER,
            "--out",
            str(self.folder),
        )
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("agrees"), 3)
        table = command("--table", "--out", str(self.folder)).stdout.splitlines()
        self.assertEqual(
            [row.split(" | ")[:2] for row in table[2:]],
            [["| cornell", v.name] for v in cases.CASES[0].views],
        )
        self.assertTrue((self.folder / "cornell" / "indirect-32.png").is_file())

    @unittest.skipUnless(shutil.which("blender") and Path(VPL_RENDER).is_file(), "no Blender")
    def test_flat_faces_of_a_mesh_with_normals_stay_flat(self) -> None:
        # Without explicit flat normals, the normals of the knobs make Cycles shade the walls of
        # that mesh as if round, with 12 % too much direct light. The mirror teapot shows light that
        # must count as direct.
        command(
            "veach-door", "--effort", "0.06", "--vpl-render", VPL_RENDER, "--out", str(self.folder)
        )
        results = json.loads((self.folder / "results.json").read_text())
        mean = results["veach-door"]["views"]["direct-0"]["mean"]
        self.assertLess(abs(mean["ratio"] - 1.0), 0.05)
        self.assertLess(mean["error"], 0.02)


if __name__ == "__main__":
    unittest.main()
