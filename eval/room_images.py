"""Renders rooms with VPLs, and with others at equal time, and measures the images."""

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

sys.path.append(str(Path(__file__).resolve().parents[1] / "pipelines"))
import gallery
import stage_options
from bnvpl_eval import images, settings, stage_runs
from bnvpl_eval.equal_samples import fitting_spp
from bnvpl_eval.runner import Run, Runner


def options_of(counts: dict[str, Any]) -> tuple[list[Any], list[Any], list[Any], list[Any]]:
    """Options of the four stages for the counts of a preset of the pipelines."""
    return (
        ["-n", counts["CANDIDATES"]],
        ["-n", counts["VPLS"]],
        ["--photons", counts["PHOTONS"], *counts["ESTIMATE"].split()],
        ["--spp", counts["SPP"], *counts["RENDER"].split()],
    )


PRESETS = {name: options_of(counts) for name, counts in stage_options.presets().items()}
SETTINGS = {name: PRESETS[name] for name in ("draft", "default")}
# Names for integrators with options.
VARIANTS = {
    "unlit-path": ["path", "--light-sampling", "off"],
    "spread-path": ["path", "--fireflies", "redistribute"],
}
MAX_SPP = 1 << 16  # samples a pixel in the time of ours, at most
# Mean over the reference's mean, and four measures of error.
COLUMNS = ("mean", "relmse", "rmse", "smape", "flip")
CYCLES = settings.ROOT / "eval/cycles/render_cycles.py"


@dataclass
class Rooms:
    runner: Runner
    references: Runner  # runs the tools that render references; another build is allowed
    width: int
    reference_spp: int
    truth: str = "vpl"  # method that renders the reference
    path_length: int = 0  # maximum number of segments from camera to light; 0 for no limit

    def bounces(self) -> list[Any]:
        """Option for the bounces of a path, which exclude the first surface and the light."""
        return ["--max-bounces", self.path_length - 2] if self.path_length else []

    def render(
        self,
        scene: gallery.Scene,
        options: list[Any],
        lit: Path | None = None,
        by: Runner | None = None,
    ) -> Run:
        tools = by or self.runner
        size = ("--size", scene.film(self.width), *options, "--layers", "direct,indirect")
        return stage_runs.rendered(tools, scene.path, lit, *scene.options, *size)

    def lit(
        self, scene: gallery.Scene, setting: tuple[Any, ...], by: Runner | None = None
    ) -> tuple[Path, float]:
        """Lit VPLs, and CPU seconds of the stages before render."""
        (place, eliminate, estimate, _), tools = setting, by or self.runner
        placed = stage_runs.placed(tools, scene.path, *scene.options, *place)
        kept = stage_runs.kept(tools, placed["candidates.vpl"], *eliminate)
        more = (*estimate, *self.bounces())
        lit = stage_runs.estimated(tools, scene.path, kept["vpls.vpl"], *more)
        return lit["lit.vpl"], sum(run.cpu_s for run in (placed, kept, lit))

    def ours(self, scene: gallery.Scene, setting: str) -> tuple[Path, float]:
        """The image of the pipeline, and CPU seconds of all stages."""
        lit, before_s = self.lit(scene, SETTINGS[setting])
        shown = self.render(scene, SETTINGS[setting][3], lit)
        return shown["image.exr"], before_s + shown.cpu_s

    def timed(self, scene: gallery.Scene, other: str, seconds: float) -> tuple[Path, int, float]:
        """The image of another integrator, with the samples a pixel that fit in `seconds`.

        With these, and the CPU seconds that they took.
        """
        spp = fitting_spp(lambda spp: self.by_samples(scene, other, spp)[1], 4, seconds, MAX_SPP)
        image, cpu_s = self.by_samples(scene, other, max(1, spp))
        return image, max(1, spp), cpu_s

    def by_samples(self, scene: gallery.Scene, other: str, spp: int) -> tuple[Path, float]:
        """The image of another integrator, and CPU seconds of all its stages."""
        sampled = ["--spp", spp, "--seed", 2, *self.bounces()]
        if other == "guided":
            lit, before_s = self.lit(scene, PRESETS["guided"])
            run = self.render(scene, ["--integrator", "guided", *sampled], lit)
            return run["image.exr"], before_s + run.cpu_s
        if other == "cycles":
            # Its import of the scene is a program of ours, and slow: it does not count.
            run = self.by_cycles(scene, spp)
            return run["image.exr"], json.loads(run["stats.json"].read_text())["render_cpu_s"]
        run = self.render(scene, ["--integrator", *VARIANTS.get(other, [other]), *sampled])
        return run["image.exr"], run.cpu_s

    def cycles_reads(self, scene: gallery.Scene) -> bool:
        if scene.path.suffix != ".toml":
            return False
        try:
            self.by_cycles(scene, 4)
        except SystemExit as problem:
            print(
                f"rooms: {scene.title} without Cycles: {str(problem).splitlines()[-1]}",
                file=sys.stderr,
            )
            return False
        return True

    def by_cycles(self, scene: gallery.Scene, spp: int) -> Run:
        bounces = self.path_length - 2 if self.path_length else 32
        blender = Runner(Path("/usr/bin"), self.runner.cache, quiet=True)
        return blender.run(
            "blender",
            [
                "-b",
                "--factory-startup",
                "--python-exit-code",
                3,
                "--python",
                "{script}",
                "--",
                "{scene}",
                "--size",
                scene.film(self.width),
                "--bounces",
                bounces,
                "--spp",
                spp,
                "--output",
                "@image.exr",
                "--stats",
                "@stats.json",
            ],
            # Its programs; and ours, since times of different days are not compared.
            {"script": CYCLES, "scene": scene.path, "ours": self.runner.bin / "vpl-render"}
            | {file.name: file for file in sorted(CYCLES.parent.glob("*.py"))},
            ["image.exr", "stats.json"],
        )

    def halves(self, scene: gallery.Scene) -> list[Path]:
        return [self.half(scene, seed) for seed in (101, 102)]

    def half(self, scene: gallery.Scene, seed: int) -> Path:
        sampled = ["--spp", self.reference_spp, "--seed", seed]
        if self.truth == "path":
            options = ["--integrator", "path", *sampled, *self.bounces()]
            return self.render(scene, options, by=self.references)["image.exr"]
        lit, _ = self.lit(
            scene,
            (["-n", "240k", "--seed", seed], ["-n", "12k"], ["--seed", seed], []),
            self.references,
        )
        return self.render(scene, [*sampled, "--fireflies", "keep"], lit, self.references)[
            "image.exr"
        ]

    def measures(
        self, scene: gallery.Scene, image: Path, layer: str = ""
    ) -> npt.NDArray[Any] | None:
        """Values for COLUMNS, or None where the layer has no light."""
        halves = self.halves(scene)
        truth = np.mean([images.read(half, layer) for half in halves])
        if not truth > 0:
            return None
        run = self.runner.run(
            "vpl-inspect",
            [
                "compare",
                "{image}",
                "{a}",
                "--second-half",
                "{b}",
                "--json",
                *(["--layer", layer] if layer else []),
            ],
            {"image": image, "a": halves[0], "b": halves[1]},
            [],
        )
        of = json.loads(run["log.txt"].read_text())
        return np.array(
            [
                images.read(image, layer).mean() / truth,
                of["relmse"],
                of["rmse"] / truth,
                of["smape"],
                of["flip"],
            ]
        )

    def rows(self, scene: gallery.Scene, also: list[str]) -> list[dict[str, Any]]:
        rows = []
        direct, all_light = (
            np.mean([images.read(half, layer) for half in self.halves(scene)])
            for layer in ("direct", "")
        )
        for name in SETTINGS:
            image, seconds = self.ours(scene, name)
            others = {
                other: self.timed(scene, other, seconds)
                for other in ("path", *also)
                if other != "cycles" or self.cycles_reads(scene)
            }
            for layer in ("", "direct", "indirect"):
                ours = self.measures(scene, image, layer)
                for other, (picture, spp, its_cpu_s) in others.items():
                    # The image of Cycles has one layer.
                    theirs = (
                        None
                        if ours is None or other == "cycles" and layer
                        else self.measures(scene, picture, layer)
                    )
                    if ours is not None and theirs is not None:
                        rows.append(
                            {
                                "room": scene.title,
                                "setting": name,
                                "light": layer or "full",
                                "beside": other,
                                "cpu_s": f"{seconds:.0f}",
                                "its_spp": spp,
                                "its_cpu_s": f"{its_cpu_s:.1f}",
                                "indirect_share": f"{1 - direct / all_light:.2f}",
                                **{
                                    column: f"{value:.4g}"
                                    for column, value in zip(COLUMNS, ours, strict=True)
                                },
                                **{
                                    f"its_{column}": f"{value:.4g}"
                                    for column, value in zip(COLUMNS, theirs, strict=True)
                                },
                            }
                        )
        return rows
