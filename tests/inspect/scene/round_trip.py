#!/usr/bin/env python3
"""Tests that a scene written by `vpl-inspect scene --to-toml` looks like the original.

    tests/inspect/scene/round_trip.py build/release/bin SCENE...   # --size 48x32 --seeds 12 detect more

Path traces both scenes through each camera. Where an image of twice the samples is not the same up to
rounding, the seeds 1 to n follow. The differences at a pixel, one for each seed, are samples of a
distribution whose mean is 0 where both agree; Student's t tests that. So are those of blocks of 2
x 2, 4 x 4, ... pixels up to the whole image, whose mean must also lie within three standard
errors. Scenes that cannot be read are named and skipped.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

SIGNIFICANCE = 1e-5  # significance level of all t values of an image together
ROUNDING = 1e-3  # relative error of a block's mean, as coordinates and colours become text


def run(*command: object) -> str:
    """Runs a command. Returns its error, or an empty text."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    lines = done.stderr.strip().splitlines() or [f"exit code {done.returncode}"]
    return lines[-1] if done.returncode else ""


def pixels(file: Path) -> npt.NDArray[Any]:
    image = oiio.ImageInput.open(str(file))
    names = list(image.spec().channelnames)
    values = image.read_image(oiio.FLOAT)
    image.close()
    result: npt.NDArray[Any] = values[:, :, [names.index(c) for c in "RGB"]].astype(np.float64)
    return result


def blocks(images: npt.NDArray[Any], side: int) -> npt.NDArray[Any]:
    """Means over blocks of side x side pixels of each image. Incomplete blocks are left out."""
    n, height, width, channels = images.shape
    rows, columns = max(1, height // side), max(1, width // side)
    cut = images[:, : rows * min(side, height), : columns * min(side, width)]
    result: npt.NDArray[Any] = cut.reshape(
        n, rows, cut.shape[1] // rows, columns, cut.shape[2] // columns, channels
    ).mean(axis=(2, 4))
    return result


def student(a: npt.NDArray[Any], b: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Student's t of each mean difference, whose standard error is at least that of rounding."""
    error = (a - b).std(axis=0, ddof=1) / math.sqrt(len(a))
    scale = 0.5 * (a + b).mean(axis=0)
    result: npt.NDArray[Any] = (a - b).mean(axis=0) / np.maximum(error, ROUNDING * scale + 1e-30)
    return result


def difference(a: npt.NDArray[Any], b: npt.NDArray[Any]) -> str:
    """How the expectations of two sets of images differ, or an empty text if they do not."""
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        return "values that are not finite"
    whole = student(a.mean(axis=(1, 2)), b.mean(axis=(1, 2)))
    if np.abs(whole).max() > 3:
        return (
            f"the means differ by {np.abs(whole).max():.1f} standard errors: {a.mean():.6g} "
            f"became {b.mean():.6g}"
        )
    ts, side = [], 1
    while side <= max(a.shape[1:3]):
        ts.append(student(blocks(a, side), blocks(b, side)).ravel())
        side *= 2
    t = np.abs(np.concatenate(ts))
    freedom = len(a) - 1  # Wallace's normal deviate for Student's t
    z = (
        (8 * freedom + 1)
        / (8 * freedom + 3)
        * math.sqrt(freedom * math.log1p(t.max() ** 2 / freedom))
    )
    p = -math.expm1(t.size * math.log1p(-min(math.erfc(z / math.sqrt(2)), 1 - 1e-16)))  # Sidak
    return f"t = {t.max():.3g} among {t.size}, p = {p:.2g}" if p < SIGNIFICANCE else ""


def compare(
    options: argparse.Namespace, scene: Path, copy: Path, first: list[Any], second: list[Any]
) -> str:
    out = copy.parent.parent / "image.exr"

    def traced(spp: int, seed: int) -> list[npt.NDArray[Any]] | str:
        """Images of both scenes, or the problem."""
        images = []
        for file, view in zip((scene, copy), (first, second), strict=True):
            command = [options.bin / "vpl-render", file, *view, "-o", out, "--integrator", "path"]
            command += ["--spp", spp, "--size", options.size, "--seed", seed, "--quiet"]
            if problem := run(*command):
                return problem
            images.append(pixels(out))
        return images

    # Most copies are the same scene down to rounding, whose images of a seed are the same.
    same = traced(2 * options.spp, 1)
    if isinstance(same, str):
        return same
    if np.allclose(same[0], same[1], rtol=ROUNDING, atol=1e-9):
        return ""
    pairs = []
    for seed in range(1, options.seeds + 1):
        pair = traced(options.spp, seed)
        if isinstance(pair, str):
            return pair
        pairs.append(pair)
    firsts, seconds = zip(*pairs, strict=True)
    return difference(np.stack(firsts), np.stack(seconds))


def check(options: argparse.Namespace, scene: Path) -> str | None:
    """How the copy of a scene differs; an empty text if it does not, None if it was skipped."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "copy"
        described = subprocess.run(
            [str(options.bin / "vpl-inspect"), "scene", "--json", str(scene)],
            capture_output=True,
            text=True,
        )
        if described.returncode:
            print(f"passed over: {(described.stderr.strip().splitlines() or ['?'])[-1]}")
            return None
        problem = run(options.bin / "vpl-inspect", "scene", scene, "--to-toml", copy)
        if problem:
            return problem
        views: list[tuple[list[Any], list[Any]]] = [([], [])]
        for i in range(1, min(options.cameras, len(json.loads(described.stdout)["cameras"]))):
            views.append((["--camera", i], ["--view", copy / f"view-{i}.toml"]))
        for first, second in views:
            problem = compare(options, scene, copy / "scene.toml", first, second)
            if problem:
                return f"{' '.join(map(str, first))} {problem}".strip()
    return ""


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("bin", type=Path, help="folder of the tools")
    parser.add_argument("scenes", type=Path, nargs="+")
    parser.add_argument("--size", default="16x12", help="pixels")
    parser.add_argument("--seeds", type=int, default=8)
    parser.add_argument("--spp", type=int, default=8)
    parser.add_argument("--cameras", type=int, default=3, help="at most so many of a scene")
    options = parser.parse_args()
    different = 0
    for scene in options.scenes:
        problem = check(options, scene)
        if problem is None:
            continue
        print(f"{scene}: {'DIFFERENT: ' + problem if problem else 'the same'}", flush=True)
        different += bool(problem)
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
