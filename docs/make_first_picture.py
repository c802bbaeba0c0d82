#!/usr/bin/env python3
"""Renders the first picture of the README: a room by the path tracer, by VPLs, and the VPLs.

    docs/make_first_picture.py [--bin build/release/bin]    # 22 CPU minutes

All parts are of one view with 1600 x 900 pixels. The path tracer gets the CPU time of all four
stages, and the picture says how long that was.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio
from PIL import Image, ImageDraw

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "eval"))
from picture_label import label  # noqa: E402 (after the path that it needs)

SCENE = ROOT / "scenes/gltf-room/room.glb"
PICTURE = ROOT / "docs/images/room.jpg"
WIDTH, HEIGHT = 1600, 900
SPP = "4"
EXPOSURE = "0"
LABEL = 24  # pixels


class Tools:
    def __init__(self, binaries: Path, folder: Path) -> None:
        self.binaries, self.folder = binaries, folder

    def run(self, tool: str, *words: str) -> float:
        """Runs a tool. Returns its CPU seconds."""
        before = os.times()
        subprocess.run([self.binaries / tool, *words, "--quiet"], cwd=self.folder, check=True)
        now = os.times()
        return (now.children_user - before.children_user) + (
            now.children_system - before.children_system
        )


def pixels_of(path: Path) -> npt.NDArray[np.uint8]:
    return np.asarray(oiio.ImageBuf(str(path)).get_pixels(oiio.UINT8))[:, :, :3]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    options = parser.parse_args()
    size = f"{WIDTH}x{HEIGHT}"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tools = Tools(options.bin.resolve(), folder)
        scene = str(SCENE)
        view = ("--camera", "Room")
        png = (*view, "--size", size, "--exposure", EXPOSURE, "--png")
        cpu_s = tools.run("vpl-place", scene, *view, "-o", "c.vpl", "-n", "120k")
        cpu_s += tools.run("vpl-eliminate", "c.vpl", "-o", "v.vpl", "-n", "3k")
        lit = ("v.vpl", "-o", "l.vpl", "--photons", "10M")
        cpu_s += tools.run("vpl-estimate", scene, *lit)
        ours = ("l.vpl", "-o", "ours.exr", *png, "ours.png", "--spp", SPP)
        cpu_s += tools.run("vpl-render", scene, *ours)
        path = ("--integrator", "path", "-o", "path.exr", *png, "path.png")
        pilot_s = tools.run("vpl-render", scene, *path, "--spp", "4")
        spp = max(1, round(4 * cpu_s / pilot_s))
        path_s = tools.run("vpl-render", scene, *path, "--spp", str(spp))
        dots = ("v.vpl", "--scene", scene, *view, "-o", "dots.png", "--size", size, "--dot", "7")
        tools.run("vpl-inspect", "plot", *dots)
        parts = [pixels_of(folder / f"{part}.png") for part in ("path", "ours", "dots")]
    picture = np.concatenate(
        [part[:, k * WIDTH // 3 : (k + 1) * WIDTH // 3] for k, part in enumerate(parts)], axis=1
    )
    image = Image.fromarray(picture)
    draw = ImageDraw.Draw(image)
    for k in (1, 2):
        draw.line((k * WIDTH // 3, 0, k * WIDTH // 3, HEIGHT), fill="white", width=2)
    label(image, 0, HEIGHT, f"path tracer, {path_s:.0f} CPU s", LABEL)
    label(image, WIDTH // 3, HEIGHT, f"bnvpl, {cpu_s:.0f} CPU s", LABEL)
    label(image, 2 * WIDTH // 3, HEIGHT, "its VPLs", LABEL)
    image.save(PICTURE, quality=92)
    print(f"{PICTURE}: path tracer {path_s:.1f} CPU s with {spp} spp, ours {cpu_s:.1f} CPU s")


if __name__ == "__main__":
    main()
