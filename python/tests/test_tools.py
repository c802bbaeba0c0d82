#!/usr/bin/python3
"""Tests of running the tools, and of reading their images.

test_tools.py BIN       # folder of the executables
"""

from __future__ import annotations

import os
import re
import signal
import time
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import OpenImageIO as oiio

from support import BIN, ROOT, SCENE, TestFiles, TestFolder, main

# isort: split
import bnvpl
from bnvpl import options, tools


class Running(TestFiles):
    def test_statistics(self) -> None:
        stats = bnvpl.run("vpl-estimate", SCENE, self.vpls, output=self.lit, photons="40k")
        self.assertEqual(stats["tool"], "vpl-estimate")
        self.assertAlmostEqual(
            stats["energy_W"]["deposited"], bnvpl.read_vpl(self.lit).flux.mean(1).sum(), places=6
        )
        kept = self.folder / "stats.json"
        bnvpl.run("vpl-estimate", SCENE, self.vpls, output=self.lit, photons="40k", stats=kept)
        self.assertIn('"vpl-estimate"', kept.read_text())

    def test_statistics_of_the_readme(self) -> None:
        c, v, lit = (self.folder / name for name in ("c.vpl", "v.vpl", "l.vpl"))
        image: dict[str, Any] = {"output": self.folder / "p.exr", "png": self.folder / "p.png"}
        made = {
            "vpl-place": bnvpl.run("vpl-place", SCENE, output=c, count=300),
            "vpl-eliminate": bnvpl.run("vpl-eliminate", c, output=v, count=30),
            "vpl-estimate": bnvpl.run("vpl-estimate", SCENE, v, output=lit, photons="20k"),
            "vpl-render": bnvpl.run("vpl-render", SCENE, lit, size="8x8", passes=2, **image),
        }
        text = (ROOT / "python/README.md").read_text()
        rows = dict(re.findall(r"^\| (all|`vpl-\w+`) \| (`.*) \|$", text, re.M))
        self.assertEqual(len(rows), 5)
        for tool, stats in made.items():
            told = re.findall(r"`(\w+)`", rows["all"] + rows[f"`{tool}`"])
            self.assertGreater(len(told), 8)
            self.assertLessEqual(set(told), stats.keys(), tool)

    def test_peak_memory_is_that_of_the_tool(self) -> None:
        ours = np.ones(40_000_000)  # 305 MiB, which a process inherits as its peak
        stats = bnvpl.run("vpl-inspect", "info", self.lit)
        self.assertLess(stats["peak_memory_MiB"], ours.nbytes / 2**20 / 2)

    def test_progress(self) -> None:
        steps: list[bnvpl.Progress] = []
        image = self.folder / "i.exr"
        given: dict[str, Any] = {"size": (16, 16), "spp": 4}
        bnvpl.run("vpl-render", SCENE, self.lit, output=image, progress=steps.append, **given)
        self.assertEqual((steps[-1].phase, steps[-1].share), ("samples", 1))
        self.assertEqual(steps[-1].done, 4 * 16 * 16)

    def test_what_progress_raises_ends_the_tool(self) -> None:
        def give_up(_: bnvpl.Progress) -> None:
            raise InterruptedError("enough")

        image = self.folder / "long.exr"
        for in_background in (False, True):
            before = signal.getsignal(signal.SIGINT)
            if in_background:
                signal.signal(signal.SIGINT, signal.SIG_IGN)
            begin = time.monotonic()
            with self.assertRaisesRegex(InterruptedError, "enough"):
                bnvpl.run(
                    "vpl-render", SCENE, output=image, integrator="path", spp="1M", progress=give_up
                )
            signal.signal(signal.SIGINT, before)
            self.assertLess(time.monotonic() - begin, 60)
            self.assertEqual(list(self.folder.glob("long*")), [])

    def test_a_tool_that_is_stopped_saves_its_work(self) -> None:
        def give_up(step: bnvpl.Progress) -> None:
            if step.done > 0:
                raise InterruptedError("enough")

        image, saved = self.folder / "long.exr", self.folder / "saved"
        paths = {"integrator": "path", "spp": 16384, "size": (64, 48), "threads": 1}
        for _ in range(2):  # the second goes on
            with self.assertRaisesRegex(InterruptedError, "enough"):
                bnvpl.run(
                    "vpl-render", SCENE, output=image, checkpoint=saved, progress=give_up, **paths
                )
            self.assertGreater(saved.stat().st_size, 0)
        self.assertEqual([p.name for p in self.folder.glob("*long*")], [])

    def test_commands_of_vpl_inspect(self) -> None:
        info = bnvpl.run("vpl-inspect", "info", self.lit)["info"]
        self.assertEqual((info["rows"], info["stage"]), (300, "lit"))
        scene = bnvpl.run("vpl-inspect", "scene", SCENE)["scene"]
        self.assertEqual(scene["hash"], bnvpl.scene_hash(SCENE))
        self.assertEqual(scene["hash"], bnvpl.read_vpl(self.lit).scene_hash)

    def test_an_estimate_of_the_cost(self) -> None:
        image = self.folder / "none.exr"
        need = bnvpl.run("vpl-render", SCENE, self.lit, output=image, size="8x8", estimate=True)
        self.assertGreater(need["memory_MiB"], 0)
        self.assertFalse(image.exists())
        notes = self.folder / "notes.txt"
        notes.write_text("mine")
        bnvpl.run(
            "vpl-render", SCENE, self.lit, output=image, size="8x8", estimate=True, stats=notes
        )
        self.assertEqual(notes.read_text(), "mine")

    def test_statistics_of_an_earlier_run_are_not_taken(self) -> None:
        stats = self.folder / "s.json"
        stats.write_text('{"tool": "vpl-place"}')
        self.assertIn("text", bnvpl.run("vpl-render", methods=True, stats=stats))

    def test_a_failure_has_code_message_and_command(self) -> None:
        with self.assertRaises(bnvpl.ToolError) as caught:
            bnvpl.run("vpl-estimate", SCENE, self.candidates, output=self.folder / "x.vpl")
        error = caught.exception
        self.assertEqual(error.code, 3)
        self.assertTrue(error.message.startswith(f"{self.candidates}: is of stage candidates"))
        self.assertIn("make it with vpl-eliminate", error.message)
        self.assertEqual(str(error), f"vpl-estimate: {error.message}")
        self.assertEqual(
            error.command[:3], [str(BIN / "vpl-estimate"), str(SCENE), str(self.candidates)]
        )
        self.assertFalse((self.folder / "x.vpl").exists())
        with self.assertRaises(bnvpl.ToolError) as caught:
            bnvpl.run("vpl-place", SCENE, output=self.folder / "x.vpl", count="many")
        self.assertEqual(caught.exception.code, 2)

    def test_what_compare_finds_is_code_5(self) -> None:
        for seed, name in ((1, "a.exr"), (2, "b.exr")):
            image = self.folder / name
            bnvpl.run("vpl-render", SCENE, self.lit, output=image, size="8x8", spp=1, seed=seed)
        files = self.folder / "a.exr", self.folder / "b.exr"
        self.assertGreater(bnvpl.run("vpl-inspect", "compare", *files)["compare"]["relmse"], 0)
        with self.assertRaises(bnvpl.ToolError) as caught:
            bnvpl.run("vpl-inspect", "compare", *files, max_relmse=1e-9)
        error = caught.exception
        self.assertEqual(error.code, 5)
        self.assertRegex(error.message, r"\ADIFFERENT: relMSE \S+ exceeds the limit 1e-09\Z")
        self.assertIn("SMAPE", error.text)
        with self.assertRaises(bnvpl.ToolError) as caught:
            bnvpl.run("vpl-inspect", "compare", *files, max_relmse=1e-9, json=True)
        self.assertEqual(str(caught.exception), "vpl-inspect: exit code 5")

    def test_what_a_tool_only_prints(self) -> None:
        self.assertIn("tilecuts", bnvpl.run("vpl-render", methods=True)["text"])
        self.assertRegex(bnvpl.run("vpl-render", version=True)["text"], r"\Avpl-render [\d.]+")

    def test_warnings_of_tools_are_warnings(self) -> None:
        scene = self.folder / "odd.obj"
        odd = self.folder / "scene.toml"
        scene.write_text((SCENE.parent / "cornell.obj").read_text() + "\nnonsense 1 2\n")
        (self.folder / "cornell.mtl").write_text((SCENE.parent / "cornell.mtl").read_text())
        odd.write_text(SCENE.read_text().replace("cornell.obj", "odd.obj"))
        with self.assertWarnsRegex(bnvpl.ToolWarning, "nonsense"):
            bnvpl.run("vpl-place", odd, output=self.folder / "odd.vpl", count=10)

    def test_an_unknown_keyword_names_the_nearest(self) -> None:
        for tool, name, near in (
            ("vpl-estimate", "photon", "did you mean photons"),
            ("vpl-render", "max_cuts", "did you mean max_cut"),
            ("vpl-merge", "zzz", "see vpl-merge --help"),
        ):
            with self.assertRaisesRegex(TypeError, f"{tool} has no option {name}; {near}"):
                bnvpl.run(tool, SCENE, **{name: 1})  # type: ignore[arg-type]
        with self.assertRaisesRegex(TypeError, "vpl-inspect has no option photons"):
            bnvpl.run("vpl-inspect", "info", self.lit, photons=1)


class ToolsThatDoNotStart(TestFolder):
    def test_their_message_is_that_of_the_error(self) -> None:
        tool = self.folder / "vpl-render"
        tool.write_text("#!/bin/sh\necho 'libembree3.so: not found' >&2\nexit 127\n")
        tool.chmod(0o755)
        found = mock.patch.dict(os.environ, BNVPL_BIN=str(self.folder))
        missing = self.assertRaisesRegex(bnvpl.ToolError, "libembree3.so: not found")
        with found, missing as failed:
            bnvpl.run("vpl-render", SCENE)
        self.assertEqual(failed.exception.code, 127)


class Keywords(unittest.TestCase):
    def setUp(self) -> None:
        self.spec = options.spec_of(str(BIN / "vpl-render"))

    def words(self, *positional: object, **given: object) -> str:
        return " ".join(options.words_of("vpl-render", self.spec, positional, given))

    def test_options(self) -> None:
        self.assertEqual(self.words(o=Path("x.exr"), spp=np.int64(3)), "--output x.exr --spp 3")
        self.assertEqual(self.words(max_cut=9, adaptive=False), "--max-cut 9 --adaptive off")
        self.assertEqual(self.words(size=(80, 60), layers=["N", "Z"]), "--size 80x60 --layers N,Z")
        defined = {"A": "b", "C": Path("d")}
        self.assertEqual(self.words(define=defined), "--define A=b --define C=d")
        self.assertEqual(self.words(quiet=True, estimate=False, png=None), "--quiet")
        self.assertEqual(self.words(size=np.array([8, 6]), spp=np.array(3)), "--size 8x6 --spp 3")
        given = {"quiet": np.bool_(True), "adaptive": np.bool_(False), "estimate": np.bool_(False)}
        self.assertEqual(self.words(**given), "--quiet --adaptive off")
        with self.assertRaisesRegex(TypeError, "size is an array of 2 dimensions, not of one"):
            self.words(size=np.array([[8, 6]]))
        with self.assertRaisesRegex(TypeError, "quiet is a flag: True or False, not 3"):
            self.words(quiet=3)
        with self.assertRaisesRegex(TypeError, r"seed has one value, not \[1, 2\]"):
            self.words(seed=[1, 2])

    def test_inputs(self) -> None:
        self.assertEqual(self.words("s.toml", "l.vpl", spp=1), "s.toml l.vpl --spp 1")
        self.assertEqual(self.words(lit="l.vpl", scene="s.toml"), "s.toml l.vpl")
        self.assertEqual(self.words(Path("s.toml"), lit="l.vpl"), "s.toml l.vpl")
        merge = options.spec_of(str(BIN / "vpl-merge"))
        given = {"shards": ["1.shard", "2.shard"]}
        self.assertEqual(options.words_of("vpl-merge", merge, [], given), given["shards"])

    def test_every_tool_tells_its_options(self) -> None:
        for tool in ("place", "eliminate", "estimate", "render", "merge", "inspect"):
            known = options.spec_of(str(BIN / f"vpl-{tool}")).options
            self.assertLessEqual({"threads", "quiet", "stats", "progress"}, known.keys(), tool)
        compare = options.spec_of(str(BIN / "vpl-inspect"), "compare")
        self.assertLessEqual({"max_relmse", "threads"}, compare.options.keys())


class Finding(TestFolder):
    def test_the_folder_that_the_environment_names(self) -> None:
        self.assertEqual(bnvpl.find_tool("vpl-place"), str(BIN / "vpl-place"))
        missing = self.assertRaisesRegex(FileNotFoundError, "vpl-place: is not in the folder")
        with mock.patch.dict(os.environ, BNVPL_BIN=str(self.folder)), missing:
            bnvpl.find_tool("vpl-place")

    def test_the_path_and_then_the_build_of_the_checkout(self) -> None:
        with mock.patch.dict(os.environ, PATH=str(BIN)):
            del os.environ["BNVPL_BIN"]
            self.assertEqual(bnvpl.find_tool("vpl-place"), str(BIN / "vpl-place"))
            os.environ["PATH"] = "/nonexistent"
            with mock.patch.object(tools, "CHECKOUT_BIN", BIN):
                self.assertEqual(bnvpl.find_tool("vpl-place"), str(BIN / "vpl-place"))
            missing = self.assertRaisesRegex(FileNotFoundError, "is not in the PATH")
            with mock.patch.object(tools, "CHECKOUT_BIN", self.folder), missing:
                bnvpl.find_tool("vpl-place")


class Images(TestFiles):
    def test_layers(self) -> None:
        file = self.folder / "i.exr"
        bnvpl.run("vpl-render", SCENE, self.lit, output=file, size=(12, 10), spp=1, layers="all")
        image = bnvpl.read_exr(file)
        self.assertEqual(image["RGB"].shape, (10, 12, 3))
        self.assertEqual(image["Z"].shape, (10, 12))
        self.assertEqual(image["N"].shape, (10, 12, 3))
        # Cameras of this scene look along z, so the normals of what they see have z <= 0.
        self.assertLessEqual(image["N"][:, :, 2].max(), 0)
        np.testing.assert_allclose(
            image["direct"] + image["indirect"], image["RGB"], rtol=1e-3, atol=1e-3
        )
        # The left wall is red, the right one green: channels and columns are in order.
        left, right = image["albedo"][5, 2], image["albedo"][5, -3]
        self.assertGreater(left[0], left[1])
        self.assertGreater(right[1], right[0])
        self.assertEqual(image.provenance[-1]["tool"], "vpl-render")
        self.assertEqual((image.film, image.origin), ((12, 10), (0, 0)))
        with self.assertRaisesRegex(KeyError, "no layer albeda; the image has RGB"):
            image["albeda"]

    def test_half_floats_integers_and_a_crop(self) -> None:
        file = self.folder / "x.exr"
        spec = oiio.ImageSpec(3, 2, 5, oiio.HALF)
        spec.channelnames = ("R", "G", "B", "A", "id")
        spec.channelformats = (oiio.HALF, oiio.HALF, oiio.HALF, oiio.FLOAT, oiio.UINT)
        spec.x, spec.y, spec.full_width, spec.full_height = 4, 5, 20, 10
        pixels = np.arange(30, dtype=np.float32).reshape(2, 3, 5)
        pixels[:, :, 3], pixels[:, :, 4] = 0.1, 1  # 1 is the greatest integer
        out = oiio.ImageOutput.create(str(file))
        self.assertTrue(out.open(str(file), spec) and out.write_image(pixels))
        out.close()
        image = bnvpl.read_exr(file)
        self.assertEqual(image["RGB"][1, 2].tolist(), [25, 26, 27])
        self.assertEqual(image["A"][0, 0], np.float32(0.1))
        self.assertEqual((image["id"].dtype, image["id"][1, 1]), (np.uint32, 2**32 - 1))
        self.assertEqual((image.film, image.origin), ((20, 10), (4, 5)))

    def test_files_that_are_missing_or_no_images(self) -> None:
        with self.assertRaises(FileNotFoundError):
            bnvpl.read_exr(self.folder / "missing.exr")
        with self.assertRaisesRegex(ValueError, "lit.vpl: cannot be read as an image"):
            bnvpl.read_exr(self.lit)


if __name__ == "__main__":
    main()
