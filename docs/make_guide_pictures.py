#!/usr/bin/env python3
"""Renders the pictures of docs/guide.md: each artefact beside its cure, from the tools themselves.

docs/make_guide_pictures.py [--bin build/release/bin] [NAME ...]    # 15 minutes on two cores
docs/make_guide_pictures.py --check NAME                 # whether a picture is as the tools make it
docs/make_guide_pictures.py --table                      # the table of docs/images/README.md
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy.typing as npt

ROOT = Path(__file__).resolve().parents[1]
LABEL = 14  # pixels
LABEL_ROWS = 3 * LABEL  # at the bottom of a picture
MAX_DIFFERENCE = 0.5  # mean over a picture, steps of 255, for --check


@dataclass
class Case:
    """A scene, its film, and the options of the four stages for each of two pictures."""

    scene: str
    size: str
    exposure: float
    labels: tuple[str, str]
    left: tuple[str, str, str, str]
    right: tuple[str, str, str, str]
    crop: tuple[int, ...] = ()  # x, y, width, height
    zoom: int = 1  # magnification, by nearest neighbour


CASES = {
    "blotches": Case(
        "scenes/u-shape/scene.toml",
        "320x240",
        6,
        ("1,500 VPLs, 30k photons", "3,000 VPLs, 4M photons"),
        ("-n 15k", "-n 1500", "--photons 30k", "--spp 8"),
        ("-n 60k", "-n 3k", "--photons 4M", "--spp 8"),
        (100, 120, 220, 120),
        2,
    ),
    "arcs": Case(
        "scenes/veach-door/scene.toml",
        "640x360",
        1.5,
        ("500 VPLs, lightcuts, 10 %", "12,000 VPLs, tilecuts"),
        (
            "-n 20k",
            "-n 500",
            "--photons 4M",
            "--gather lightcuts --error 0.1 --spp 8 --only indirect",
        ),
        ("-n 240k", "-n 12k", "--photons 10M", "--spp 16 --only indirect"),
        (300, 0, 340, 360),
    ),
    "dark-corners": Case(
        "scenes/cornell/scene.toml",
        "240x240",
        1.5,
        ("without compensation", "near-field rays"),
        ("-n 12k", "-n 300", "--photons 2M", "--compensate none --spp 32 --only indirect"),
        ("-n 12k", "-n 300", "--photons 2M", "--spp 32 --only indirect"),
        (40, 125, 150, 100),
        3,
    ),
    "leaks": Case(
        "scenes/u-shape/scene.toml",
        "480x360",
        3,
        ("--method even", "the default"),
        (
            "-n 60k",
            "-n 3k",
            "--photons 2M --method even --emit-points 0",
            "--compensate none --spp 16",
        ),
        ("-n 60k", "-n 3k", "--photons 2M", "--spp 16"),
    ),
    "fireflies": Case(
        "scenes/veach-door/table.toml",
        "320x180",
        2.5,
        ("fireflies kept", "redistributed"),
        ("-n 60k", "-n 3k", "--photons 2M", "--spp 8 --fireflies keep"),
        ("-n 60k", "-n 3k", "--photons 2M", "--spp 8"),
        (100, 70, 140, 90),
        3,
    ),
    "gloss": Case(
        "scenes/gltf-room/room.glb",
        "320x180",
        1.2,
        ("fireflies kept", "redistributed"),
        ("-n 120k --camera Room", "-n 3k", "", "--camera Room --fireflies keep"),
        ("-n 120k --camera Room", "-n 3k", "", "--camera Room"),
        (0, 40, 140, 90),
        3,
    ),
    "direct-noise": Case(
        "scenes/cornell/scene.toml",
        "480x480",
        0,
        ("1 sample a pixel", "64 samples"),
        (
            "-n 12k",
            "-n 300",
            "--photons 200k",
            "--spp 1 --direct-samples 1 --near-field-rays 1 --only direct",
        ),
        (
            "-n 12k",
            "-n 300",
            "--photons 200k",
            "--spp 64 --direct-samples 1 --near-field-rays 1 --only direct",
        ),
        (0, 190, 400, 290),
    ),
}


def table() -> Iterator[str]:
    yield "| picture | scene, film | crop: x, y, width, height | both | left | right |"
    yield "|---|---|---|---|---|---|"
    for name, case in CASES.items():
        both, left, right = [], [], []
        stages = ("place", "eliminate", "estimate", "render")
        for tool, before, after in zip(stages, case.left, case.right, strict=True):
            if before != after:
                left.append(f"`{tool} {before}`")
                right.append(f"`{tool} {after}`")
            elif before:
                both.append(f"`{tool} {before}`")
        options = " | ".join("; ".join(column) for column in (both, left, right))
        crop = ", ".join(map(str, case.crop)) or "none"
        yield f"| `guide-{name}.png` | `{case.scene}`, {case.size} | {crop} | {options} |"


def run(tools: Path, folder: Path, tool: str, *words: object) -> None:
    # The same bytes on every processor, for --check.
    everywhere = ["--processor", "any", "--quiet"]
    subprocess.run([tools / tool, *map(str, words), *everywhere], cwd=folder, check=True)


def render(tools: Path, case: Case, options: Iterable[str], folder: Path, to: str) -> None:
    scene = ROOT / case.scene
    place, eliminate, estimate, image = (o.split() for o in options)
    run(tools, folder, "vpl-place", scene, "-o", "c.vpl", *place)
    run(tools, folder, "vpl-eliminate", "c.vpl", "-o", "v.vpl", *eliminate)
    run(tools, folder, "vpl-estimate", scene, "v.vpl", "-o", "l.vpl", *estimate)
    run(
        tools,
        folder,
        "vpl-render",
        scene,
        "l.vpl",
        "-o",
        f"{to}.exr",
        "--png",
        f"{to}.png",
        "--size",
        case.size,
        "--exposure",
        case.exposure,
        *image,
    )


def shown(file: Path, kind: Any) -> npt.NDArray[Any]:
    import OpenImageIO

    result: npt.NDArray[Any] = OpenImageIO.ImageBuf(str(file)).get_pixels(kind)[:, :, :3]
    return result


def labelled(pixels: npt.NDArray[Any], text: str) -> npt.NDArray[Any]:
    import numpy
    from PIL import Image

    sys.path.append(str(ROOT / "eval"))
    from picture_label import label

    image = Image.fromarray(pixels)
    label(image, 0, image.height, text, LABEL)
    return numpy.asarray(image)


def write(name: str, panels: Sequence[npt.NDArray[Any]]) -> None:
    import numpy
    import OpenImageIO

    gap = numpy.full((panels[0].shape[0], 8, 3), 255, numpy.uint8)
    row = [x for p in panels for x in (gap, p)][1:]
    whole = numpy.ascontiguousarray(numpy.hstack(row))
    out = OpenImageIO.ImageBuf(
        OpenImageIO.ImageSpec(whole.shape[1], whole.shape[0], 3, OpenImageIO.UINT8)
    )
    out.set_pixels(OpenImageIO.ROI(), whole)
    file = ROOT / "docs/images" / f"guide-{name}.png"
    if not out.write(str(file)):
        sys.exit(f"{file}: {out.geterror()}")
    print(f"docs/images/guide-{name}.png", flush=True)


def panel(case: Case, side: str, tools: Path, folder: Path) -> npt.NDArray[Any]:
    import numpy
    import OpenImageIO

    render(tools, case, case.left if side == "left" else case.right, folder, side)
    pixels = shown(folder / f"{side}.png", OpenImageIO.UINT8)
    if case.crop:
        x, y, width, height = case.crop
        pixels = pixels[y : y + height, x : x + width]
    result: npt.NDArray[Any] = numpy.repeat(numpy.repeat(pixels, case.zoom, 0), case.zoom, 1)
    return result


def difference(name: str, tools: Path, folder: Path) -> float:
    """The mean difference, in 8-bit steps, of a picture's right side and what the tools make.

    The rows of the label are left out.
    """
    import OpenImageIO

    now = panel(CASES[name], "right", tools, folder)[:-LABEL_ROWS]
    kept = shown(ROOT / "docs/images" / f"guide-{name}.png", OpenImageIO.UINT8)[:-LABEL_ROWS]
    return float(abs(kept[:, -now.shape[1] :].astype(float) - now).mean())


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"some of {', '.join(CASES)}")
    parser.add_argument(
        "--bin", default=ROOT / "build/release/bin", type=Path, help="folder of the executables"
    )
    parser.add_argument("--table", action="store_true", help="print the recipes instead")
    parser.add_argument(
        "--check", action="store_true", help="compare the pictures' right sides with the tools'"
    )
    options = parser.parse_args()
    if unknown := [name for name in options.names if name not in CASES]:
        parser.error(f"no picture '{unknown[0]}'; use {', '.join(CASES)}")
    if options.table:
        print("\n".join(table()))
        return
    for name in options.names or CASES:
        with tempfile.TemporaryDirectory(prefix="bnvpl-guide.") as folder:
            tools, place = options.bin.resolve(), Path(folder)
            if not options.check:
                case = CASES[name]
                sides = zip(("left", "right"), case.labels, strict=True)
                panels = [labelled(panel(case, side, tools, place), text) for side, text in sides]
                write(name, panels)
            elif (found := difference(name, tools, place)) > MAX_DIFFERENCE:
                sys.exit(
                    f"docs/images/guide-{name}.png: differs by {found:.2f} steps of 255 from what "
                    "the tools make; look at both, and run docs/make_guide_pictures.py"
                )


if __name__ == "__main__":
    main()
