#!/usr/bin/env python3
"""Equal time, the full image: how far VPLs at default options are ahead of path tracing, room by room.

  PBRT_SCENES=/folder/of/pbrt/scenes LIVING_ROOM_DIR=/folder/of/living-room eval/rooms.py

For each room: the pipeline with two settings, the path tracer with the samples that take the CPU time of all four
stages, and others if they are asked for (--also light, guided); against two path-traced halves of a reference. Writes
the table 'rooms' of docs/results.md: means over the reference's, and relMSE, RMSE, SMAPE and FLIP, ours / the path
tracer's. Rooms whose files are not there are left out.
"""

import argparse
import datetime
import json
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import gallery
import write_docs
from bnvpl_eval import images, output, settings
from bnvpl_eval.runner import Run, Runner
from evaluate import commit

OURS = tuple(gallery.Scene(name, title, f"scenes/{name}/scene.toml", aspect) for name, title, aspect in (
    ("cornell", "Cornell box", (1, 1)), ("u-shape", "U-shape", (4, 3)), ("veach-door", "Veach door", (16, 9))))


@dataclass(frozen=True)
class LivingRoom(gallery.Scene):
    @property
    def path(self) -> Path:
        return Path(os.environ.get("LIVING_ROOM_DIR", "/nowhere")) / self.file


SCENES = (*OURS, LivingRoom("living-room-diffuse", "Living room, diffuse", "scene.toml"), *gallery.SCENES)
SETTINGS = {  # options of the stages; those that are not named have their defaults
    "draft": (["-n", "15k"], ["-n", "1500"], ["--photons", "1M"], ["--spp", 4]),
    "default": ([], ["-n", "3k"], [], []),
}
# How far the mean is off, and four measures of error.
COLUMNS = ("mean", "relmse", "rmse", "smape", "flip")


@dataclass
class Rooms:
    runner: Runner
    references: Runner  # their tools may be those of an earlier build
    width: int
    reference_spp: int

    def render(self, scene: gallery.Scene, options: list, lit: Path | None = None, by: Runner | None = None) -> Run:
        inputs = {"scene": scene.path} | ({"lit": lit} if lit else {})
        return (by or self.runner).run("vpl-render", ["{scene}", *(["{lit}"] if lit else []), *scene.options, "--size",
                                              scene.film(self.width), *options, "--layers", "direct,indirect", "-o",
                                              "@image.exr", "--quiet"], inputs, ["image.exr"])

    def ours(self, scene: gallery.Scene, name: str, integrator: str = "vpl") -> tuple[Path, float]:
        """The image, and CPU seconds of all stages."""
        place, eliminate, estimate, render = SETTINGS[name]
        inputs = {"scene": scene.path}
        placed = self.runner.run("vpl-place", ["{scene}", *scene.options, *place, "-o", "@candidates.vpl", "--quiet"], inputs,
                                 ["candidates.vpl"])
        kept = self.runner.run("vpl-eliminate", ["{candidates}", *eliminate, "-o", "@vpls.vpl", "--quiet"],
                               {"candidates": placed["candidates.vpl"]}, ["vpls.vpl"])
        lit = self.runner.run("vpl-estimate", ["{scene}", "{vpls}", *estimate, "-o", "@lit.vpl", "--quiet"],
                              {**inputs, "vpls": kept["vpls.vpl"]}, ["lit.vpl"])
        shown = self.render(scene, ["--integrator", integrator, *render], lit["lit.vpl"])
        return shown["image.exr"], sum(run.cpu_s for run in (placed, kept, lit, shown))

    def timed(self, scene: gallery.Scene, integrator: str, seconds: float) -> tuple[Path, int]:
        """By an integrator without VPLs, with the samples that take as long."""
        of = lambda spp: self.render(scene, ["--integrator", integrator, "--spp", spp, "--seed", 2])
        few, more = of(4).cpu_s, of(20).cpu_s
        per_sample = max(1e-3, more - few) / 16
        spp = max(1, round((seconds - max(0.0, few - 4 * per_sample)) / per_sample))
        return of(spp)["image.exr"], spp

    def halves(self, scene: gallery.Scene) -> list[Path]:
        return [self.render(scene, ["--integrator", "path", "--spp", self.reference_spp, "--seed", seed],
                            by=self.references)["image.exr"] for seed in (101, 102)]

    def measures(self, scene: gallery.Scene, image: Path, layer: str = "") -> np.ndarray:
        halves = self.halves(scene)
        run = self.runner.run("vpl-inspect", ["compare", "{image}", "{a}", "--second-half", "{b}", "--json",
                                              *(["--layer", layer] if layer else [])],
                              {"image": image, "a": halves[0], "b": halves[1]}, [])
        of = json.loads(run["log.txt"].read_text())
        truth = np.mean([images.read(half, layer) for half in halves])
        return np.array([images.read(image, layer).mean() / truth, of["relmse"], of["rmse"] / truth, of["smape"], of["flip"]])

    def rows(self, scene: gallery.Scene, also: list[str]) -> list[str]:
        rows = []
        for name in SETTINGS:
            image, seconds = self.ours(scene, name)
            others = {"path": self.timed(scene, "path", seconds)[0]}
            for integrator in also:
                others[integrator] = (self.ours(scene, name, integrator)[0] if integrator == "guided"
                                      else self.timed(scene, integrator, seconds)[0])
            for layer in ("", "indirect"):
                ours = self.measures(scene, image, layer)
                for other, picture in others.items():
                    theirs = self.measures(scene, picture, layer)
                    rows.append("| " + " | ".join([scene.title, name, layer or "full", other, f"{seconds:.0f}",
                                                   f"{ours[0]:.3f}", f"{theirs[0]:.3f}"] +
                                                  [f"{a:.2g} / {b:.2g}" for a, b in zip(ours[1:], theirs[1:])]) + " |")
        return rows


def write_table(rows: list[str], arguments) -> None:
    path = write_docs.DOCS / "results.md"
    heads = ("| room | setting | light | beside | CPU s | mean | its mean | relMSE | RMSE / mean | SMAPE | FLIP |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|")
    made = (f"<!-- tools of {commit()}, {datetime.date.today().isoformat()}, {arguments.width} pixels wide, "
            f"2 x {arguments.reference_spp} spp -->")
    text = "\n".join(["<!-- rooms -->", heads, *rows, "", made, "<!-- end of rooms -->"])
    output.write_text(path, re.sub(r"<!-- rooms -->.*?<!-- end of rooms -->", lambda _: text, path.read_text(), flags=re.S))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rooms", nargs="*", help=", ".join(scene.id for scene in SCENES) + "; all unless given")
    parser.add_argument("--bin", type=Path, default=settings.ROOT / "build/release/bin", help="folder of the tools")
    parser.add_argument("--cache", type=Path, default=settings.ROOT / "build/eval/cache")
    parser.add_argument("--width", type=int, default=320, help="pixels")
    parser.add_argument("--reference-spp", type=int, default=2048, help="of each half")
    parser.add_argument("--also", nargs="*", default=[], metavar="INTEGRATOR", help="light, guided")
    parser.add_argument("--reference-bin", type=Path, metavar="FOLDER", help="tools that render the references; --bin unless given")
    parser.add_argument("--references-only", action="store_true", help="render the references, and stop")
    parser.add_argument("--no-table", action="store_true", help="leave docs/results.md as it is")
    arguments = parser.parse_args()
    runner, references = (Runner(folder.resolve(), arguments.cache.resolve(), quiet=True)
                          for folder in (arguments.bin, arguments.reference_bin or arguments.bin))
    rooms = Rooms(runner, references, arguments.width, arguments.reference_spp)
    rows = []
    for scene in SCENES:
        if arguments.rooms and scene.id not in arguments.rooms:
            continue
        if not scene.path.is_file():
            print(f"rooms: {scene.title} is left out: {scene.path} is not there", file=sys.stderr)
            continue
        if arguments.references_only:
            rooms.halves(scene)
            continue
        for row in rooms.rows(scene, arguments.also):
            rows.append(row)
            print(row, flush=True)
    if not (arguments.no_table or arguments.references_only):
        write_table(rows, arguments)
    return 0


if __name__ == "__main__":
    sys.exit(main())
