"""Tests that stored references are used only if their scene and integrator match the request."""

import dataclasses
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any, cast
from unittest import mock

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from bnvpl_eval import images, references, settings  # noqa: E402
from bnvpl_eval.runner import Runner  # noqa: E402

FILM = "4x3"


class FakeRun(dict[str, Path]):
    cpu_s = 1.5


class FakeRunner:
    """Renders grey images whose value is their seed."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.asked: list[tuple[str, int, int]] = []

    def run(self, tool: str, arguments: list[Any], _inputs: object, _outputs: object) -> FakeRun:
        options = dict(zip(arguments[1::2], arguments[2::2], strict=False))
        self.asked.append((options["--integrator"], options["--spp"], options["--seed"]))
        file = self.folder / f"{options['--seed']}.exr"
        grey = np.full((3, 4, 3), float(options["--seed"]), np.float32)
        images.write_half(file, {"": grey, "indirect": grey}, "test")
        return FakeRun({"image.exr": file})


class References(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.runner = FakeRunner(Path(folder.name))
        stored = Path(folder.name) / "stored"
        stored.mkdir()
        patch = mock.patch.object(references, "FOLDER", stored)
        patch.start()
        self.addCleanup(patch.stop)
        self.view = settings.load()[0][0].views[0]

    def render(self, view: settings.View, spp: int) -> None:
        for half in "ab":
            references.render_half(cast(Runner, self.runner), view, FILM, spp, half)

    def test_halves_have_seeds_of_their_own_and_take_more_samples(self) -> None:
        self.render(self.view, 2 * references.CHUNK)
        self.assertEqual([seed for _, _, seed in self.runner.asked], [1000, 1002, 1001, 1003])
        a, b = references.load(self.view, FILM, "indirect")
        self.assertAlmostEqual(float(a.mean()), 1001, delta=0.5)
        self.assertAlmostEqual(float(b.mean()), 1002, delta=0.5)
        self.render(self.view, 2 * references.CHUNK)  # exists already
        self.assertEqual(len(self.runner.asked), 4)
        self.render(self.view, 4 * references.CHUNK)  # continues the stored half
        self.assertEqual([seed for _, _, seed in self.runner.asked[4:]], [1004, 1006, 1005, 1007])
        self.assertAlmostEqual(
            float(references.load(self.view, FILM, "indirect")[0].mean()), 1003, delta=0.5
        )
        record = references.require(self.view, FILM)["a"]
        self.assertEqual(
            (record["spp"], record["seeds"], record["cpu_s"]),
            (4 * references.CHUNK, [1000, 1006], 6.0),
        )

    def test_larger_films_take_fewer_samples_a_pixel(self) -> None:
        films = ("40x30", "80x60", "240x180")
        for integrator, last in (("path", ("guided", 29)), ("light", ("light", 456))):
            view = dataclasses.replace(
                self.view, reference_spp=4096, reference_integrator=integrator
            )
            self.assertEqual(
                [(references.integrator_of(view, f), references.spp_of(view, f)) for f in films],
                [(integrator, 4096), (integrator, 4096), last],
            )

    def test_a_half_has_chunks_of_equal_size(self) -> None:
        self.render(self.view, 2 * references.CHUNK + 1)
        self.assertEqual({spp for _, spp, _ in self.runner.asked}, {1366})

    def test_another_integrator_begins_anew(self) -> None:
        path = dataclasses.replace(self.view, reference_integrator="path")
        light = dataclasses.replace(self.view, reference_integrator="light")
        self.render(path, 8)
        with self.assertRaisesRegex(SystemExit, "references.py --film-width 4 u-shape-main"):
            references.require(light, FILM)
        self.render(light, 8)
        self.assertEqual(self.runner.asked[2:], [("light", 8, 1000), ("light", 8, 1001)])
        self.assertEqual(references.require(light, FILM)["b"]["integrator"], "light")

    def test_a_stop_between_picture_and_record_begins_anew(self) -> None:
        self.render(self.view, 8)
        file = references.path(self.view, FILM, "a")
        record = file.with_suffix(".json")
        before = record.read_text()
        self.render(self.view, 16)
        record.write_text(before)  # as if the new record had not been written
        with self.assertRaisesRegex(SystemExit, "not to its end"):
            references.require(self.view, FILM)
        asked = len(self.runner.asked)
        self.render(self.view, 16)
        self.assertEqual(self.runner.asked[asked:], [("light", 16, 1000)])
        self.assertEqual(references.require(self.view, FILM)["a"]["spp"], 16)
        record.unlink()
        with self.assertRaisesRegex(SystemExit, "no such reference"):
            references.require(self.view, FILM)

    def test_another_scene_is_refused_and_none_is_told(self) -> None:
        with self.assertRaisesRegex(SystemExit, "no such reference"):
            references.require(self.view, FILM)
        self.render(self.view, 8)
        other = dataclasses.replace(self.view, file="scenes/cornell/scene.toml")
        with self.assertRaisesRegex(SystemExit, "another version"):
            references.require(other, FILM)

    def test_the_stored_ones_are_those_of_the_settings(self) -> None:
        mock.patch.stopall()
        scenes, table = settings.load()
        stored = table["size"]["standard"]["scenes"]
        for scene in (scene for scene in scenes if scene.id in stored):
            for view in scene.views if scene.available else []:
                for record in references.require(view, scene.film(80)).values():
                    self.assertGreaterEqual(record["spp"], view.reference_spp)


if __name__ == "__main__":
    unittest.main()
