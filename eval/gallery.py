#!/usr/bin/env python3
"""Makes the gallery of docs/results.md: scenes of other programs, lit by three integrators.

    PBRT_SCENES=/folder/of/pbrt/scenes eval/gallery.py

Renders each scene by the path tracer, the light tracer and VPLs and compares their means. Where an
author's render exists, means of blocks are compared with it. Writes docs/images/gallery-*.jpg,
docs/images/author-*.jpg and the table 'gallery' of docs/lab/evaluation.md. Scenes whose folder does
not exist are left out.
"""

import argparse
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

import results_page
import write_docs
from bnvpl_eval import images, output, settings, stage_runs
from bnvpl_eval.runner import Run, Runner
from evaluate import beginning

WIDTH = 960  # width of the gallery's pictures in pixels
BLOCKS = 8  # blocks along each side in the comparison with an author's render


@dataclass(frozen=True)
class Scene:
    id: str
    title: str
    file: str  # path below PBRT_SCENES, or below the project's folder
    aspect: tuple[int, int] = (16, 9)
    options: tuple[str, ...] = ()
    author: str = ""
    pictures: tuple[str, ...] = ("gallery",)  # and "author": beside the author's render

    @property
    def path(self) -> Path:
        folder = (
            settings.ROOT
            if self.file.startswith("scenes/")
            else Path(os.environ.get("PBRT_SCENES", "/nowhere"))
        )
        return folder / self.file

    def film(self, width: int) -> str:
        return f"{width}x{width * self.aspect[1] // self.aspect[0]}"


SCENES = (
    Scene(
        "living-room",
        "The Grey & White Room (Wig42)",
        "living-room/living-room.pbrt",
        author="TungstenRender.exr",
        pictures=("gallery", "author"),
    ),
    Scene(
        "bathroom",
        "Contemporary Bathroom (Mareck)",
        "bathroom/bathroom.pbrt",
        aspect=(1, 1),
        author="TungstenRender.exr",
        pictures=("gallery", "author"),
    ),
    Scene(
        "veach-ajar-pbrt",
        "Veach, Ajar (Bitterli)",
        "veach-ajar/veach-ajar.pbrt",
        author="TungstenRender.exr",
    ),
    Scene("veach-mis", "Veach's plates", "veach-mis/veach-mis.pbrt", aspect=(4, 3)),
    Scene(
        "material-testball",
        "Material test ball (Bitterli)",
        "material-testball/material-testball.pbrt",
    ),
    Scene(
        "gltf-room",
        "Room in glTF (ours)",
        "scenes/gltf-room/room.glb",
        options=("--camera", "Room"),
        pictures=(),  # the README shows it
    ),
)


@dataclass
class Gallery:
    runner: Runner
    spp: int
    photons: str

    def lit(self, scene: Scene, seed: int) -> Run:
        more = (*scene.options, "-n", 120_000, "--seed", seed)
        placed = stage_runs.placed(self.runner, scene.path, *more)
        kept = stage_runs.kept(self.runner, placed["candidates.vpl"], "-n", 3000)
        more = ("--seed", seed, "--photons", self.photons)
        return stage_runs.estimated(self.runner, scene.path, kept["vpls.vpl"], *more)

    def image(self, scene: Scene, integrator: str, width: int, spp: int, seed: int) -> Path:
        lit = self.lit(scene, seed)["lit.vpl"] if integrator == "vpl" else None
        by = () if lit else ("--integrator", integrator)
        size = ("--size", scene.film(width), "--spp", spp, "--seed", seed)
        options = (*scene.options, *size, *by)
        return stage_runs.rendered(self.runner, scene.path, lit, *options)["image.exr"]

    def row(self, scene: Scene) -> str:
        shown = {
            name: [images.read(self.image(scene, name, 160, self.spp, seed)) for seed in (1, 2, 3)]
            for name in ("path", "light", "vpl")
        }
        means = {name: np.array([pixels.mean() for pixels in of]) for name, of in shown.items()}
        cells = [scene.title] + [ratio(means[name], means["path"]) for name in ("light", "vpl")]
        return (
            "| " + " | ".join([*cells, beside_author(scene, np.mean(shown["path"], axis=0))]) + " |"
        )

    def picture(self, scene: Scene, spp: int) -> None:
        if not scene.pictures:
            return
        pixels = images.read(self.image(scene, "vpl", WIDTH, spp, 1))
        save(write_docs.srgb(pixels, exposure(pixels)), f"gallery-{scene.id}")
        if "author" in scene.pictures:
            theirs = images.read(scene.path.parent / scene.author)
            size = (640 * scene.aspect[1] // scene.aspect[0], 640)
            save(
                write_docs.beside(
                    [
                        write_docs.srgb(resized(picture, size), exposure(theirs))
                        for picture in (pixels, theirs)
                    ]
                ),
                f"author-{scene.id}",
            )


def beside_author(scene: Scene, ours: npt.NDArray[Any]) -> str:
    """Ratios of blocks, ours over the author's: median, 10th and 90th percentile."""
    if not scene.author:
        return ""
    theirs = resized(images.read(scene.path.parent / scene.author), (ours.shape[0], ours.shape[1]))
    ratios = np.sort(blocks(ours) / np.maximum(blocks(theirs), 1e-6))
    low, middle, high = (
        ratios[len(ratios) // 10],
        ratios[len(ratios) // 2],
        ratios[-1 - len(ratios) // 10],
    )
    return f"{middle:.2f} ({low:.2f} to {high:.2f})"


def ratio(values: npt.NDArray[Any], to: npt.NDArray[Any]) -> str:
    error = np.hypot(values.std(ddof=1) / values.mean(), to.std(ddof=1) / to.mean()) / np.sqrt(
        len(values)
    )
    value = values.mean() / to.mean()
    return f"{value:.3f} ± {value * error:.3f}"


def exposure(pixels: npt.NDArray[Any]) -> float:
    """Scale that maps the logarithmic mean to middle grey, as vpl-render --exposure auto does."""
    luminance = pixels @ np.array([0.2126, 0.7152, 0.0722])
    result: float = 0.18 / np.exp(np.log(luminance[luminance > 0]).mean())
    return result


def blocks(pixels: npt.NDArray[Any]) -> npt.NDArray[Any]:
    height, width = (side // BLOCKS * BLOCKS for side in pixels.shape[:2])
    cut = pixels[:height, :width].mean(axis=2)
    result: npt.NDArray[Any] = (
        cut.reshape(BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS).mean(axis=(1, 3)).ravel()
    )
    return result


def resized(pixels: npt.NDArray[Any], shape: tuple[int, int]) -> npt.NDArray[Any]:
    """Resizes by a box filter to `shape` = (height, width)."""
    channels = [
        Image.fromarray(pixels[:, :, c]).resize((shape[1], shape[0]), Image.BOX) for c in range(3)
    ]
    return np.stack([np.asarray(channel) for channel in channels], axis=2)


def save(pixels: npt.NDArray[Any], name: str) -> None:
    output.save(
        write_docs.DOCS / "images" / f"{name}.jpg",
        output.output_guard.JPEG,
        lambda partial: Image.fromarray(pixels).save(partial, quality=90),
    )


def write_table(rows: list[str], begin: dict[str, Any]) -> None:
    path = write_docs.DOCS / "lab/evaluation.md"
    heads = (
        "| scene | light tracer / path tracer | VPLs / path tracer | blocks, path tracer / "
        "author's render |\n|---|---|---|---|"
    )
    made = f"<!-- tools of {begin['commit']}, {begin['date']} -->"
    text = "\n".join(["<!-- gallery -->", heads, *rows, "", made, "<!-- end -->"])
    output.write_page(
        path,
        re.sub(r"<!-- gallery -->.*?<!-- end -->", lambda _: text, path.read_text(), flags=re.S),
    )
    results_page.write()


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "scenes", nargs="*", help=", ".join(scene.id for scene in SCENES) + "; all unless given"
    )
    parser.add_argument(
        "--bin", type=Path, default=settings.ROOT / "build/release/bin", help="folder of the tools"
    )
    parser.add_argument(
        "--commit", help="of the tools in --bin; that of the working tree unless given"
    )
    parser.add_argument("--cache", type=Path, default=settings.ROOT / "build/eval/cache")
    parser.add_argument(
        "--spp", type=int, default=256, help="of the comparisons, each of three seeds"
    )
    parser.add_argument("--picture-spp", type=int, default=16, help="the default of vpl-render")
    parser.add_argument("--photons", default="4M")
    parser.add_argument(
        "--no-table", action="store_true", help="leave the pages, as without all scenes"
    )
    parser.add_argument("--pictures", action="store_true", help="make no comparisons and no table")
    arguments = parser.parse_args()
    if unknown := set(arguments.scenes) - {scene.id for scene in SCENES}:
        parser.error(f"no scene is named {', '.join(sorted(unknown))}")
    begin = beginning(arguments.commit)
    runner = Runner(arguments.bin.resolve(), arguments.cache.resolve(), provenance=begin)
    gallery = Gallery(runner, arguments.spp, arguments.photons)
    rows = []
    for scene in SCENES:
        if arguments.scenes and scene.id not in arguments.scenes:
            continue
        if not scene.path.is_file():
            print(
                f"gallery: {scene.title} is left out: {scene.path} is not there; set PBRT_SCENES",
                file=sys.stderr,
            )
            continue
        gallery.picture(scene, arguments.picture_spp)
        if arguments.pictures:
            continue
        rows.append(gallery.row(scene))
        print(rows[-1], flush=True)
    if len(rows) == len(SCENES) and not arguments.no_table:  # a part would replace the whole table
        write_table(rows, begin)
    return 0


if __name__ == "__main__":
    sys.exit(main())
