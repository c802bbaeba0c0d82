#!/usr/bin/python3
"""Compares 1,000 lamps with ten of the same power: CPU seconds of vpl-render, noise of two seeds.

    bench/lamps.py                   # a minute
    bench/lamps.py --lamps 10,100,10000

The scene is a room of 10 x 3 x 10 m with four shelves, which hide lamps from most places.
bench/RESULTS.md has the figures.
"""

import argparse
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT, DEPTH = 10.0, 3.0, 10.0  # size of the room, in m
LAMP_M2 = 1.6  # total area of the lamps


Corner = tuple[float, float, float]


def quads(lamps: int) -> Iterator[tuple[str, tuple[Corner, ...]]]:
    """Yields the material and the four corners of each quad of the room."""
    w, h, d = WIDTH, HEIGHT, DEPTH
    walls = [
        ((0, 0, 0), (0, 0, d), (w, 0, d), (w, 0, 0)),
        ((0, h, 0), (w, h, 0), (w, h, d), (0, h, d)),
        ((0, 0, 0), (w, 0, 0), (w, h, 0), (0, h, 0)),
        ((0, 0, d), (0, h, d), (w, h, d), (w, 0, d)),
        ((0, 0, 0), (0, h, 0), (0, h, d), (0, 0, d)),
        ((w, 0, 0), (w, 0, d), (w, h, d), (w, h, 0)),
    ]
    for x in (2.0, 4.0, 6.0, 8.0):
        walls.append(((x, 0, 2), (x, 0, 8), (x, 2.2, 8), (x, 2.2, 2)))
        walls.append(((x + 0.05, 0, 2), (x + 0.05, 2.2, 2), (x + 0.05, 2.2, 8), (x + 0.05, 0, 8)))
    yield from (("white", wall) for wall in walls)
    draw, half = random.Random(1), 0.5 * math.sqrt(LAMP_M2 / lamps)
    for k in range(lamps):
        x, y, z = draw.uniform(0.5, w - 0.5), h - 0.01, draw.uniform(0.5, d - 0.5)
        yield (
            f"lamp{k}",
            (
                (x - half, y, z - half),
                (x + half, y, z - half),
                (x + half, y, z + half),
                (x - half, y, z + half),
            ),
        )


def write_room(folder: Path, lamps: int) -> Path:
    rows, vertices = ["mtllib room.mtl"], 0
    for material, corners in quads(lamps):
        rows += [f"v {x:g} {y:g} {z:g}" for x, y, z in corners]
        rows += [f"usemtl {material}", "f " + " ".join(str(vertices + k) for k in (1, 2, 3, 4))]
        vertices += 4
    (folder / "room.obj").write_text("\n".join(rows) + "\n")
    lamp = "".join(f"newmtl lamp{k}\nKd 0 0 0\nKe 10 10 10\n" for k in range(lamps))
    (folder / "room.mtl").write_text("newmtl white\nKd 0.7 0.7 0.7\n" + lamp)
    scene = folder / "room.toml"
    scene.write_text(
        "[film]\nwidth = 160\nheight = 120\n[camera]\nposition = [0.5, 1.6, 0.5]\nforward = "
        "[1.0, -0.1, 1.0]\n"
        'up = [0.0, 1.0, 0.0]\nvertical_fov_deg = 60\n[[mesh]]\nfile = "room.obj"\n'
    )
    return scene


def run(*command: object) -> float:
    """Runs a tool. Returns its CPU seconds."""
    process = subprocess.Popen([str(word) for word in command] + ["--quiet"])
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"lamps: {command[0]} failed")
    seconds: float = usage.ru_utime + usage.ru_stime
    return seconds


def measure(tools: Path, folder: Path, lamps: int) -> dict[str, tuple[float, float]]:
    """CPU seconds and RMSE of one image over its mean, for each of two values of --only."""
    scene, lit = write_room(folder, lamps), folder / "lit.vpl"
    run(tools / "vpl-place", scene, "-n", "30k", "-o", folder / "candidates.vpl")
    run(tools / "vpl-eliminate", folder / "candidates.vpl", "-n", "1500", "-o", folder / "vpls.vpl")
    run(tools / "vpl-estimate", scene, folder / "vpls.vpl", "--photons", "1M", "-o", lit)
    found = {}
    for only in ("direct", "all"):
        images = [folder / f"{seed}.exr" for seed in (1, 2)]
        spent = min(
            run(tools / "vpl-render", scene, lit, "--only", only, "--seed", seed, "-o", image)
            for seed, image in enumerate(images, 1)
        )
        compared = json.loads(
            subprocess.run(
                [tools / "vpl-inspect", "compare", *images, "--json"],
                check=True,
                text=True,
                stdout=subprocess.PIPE,
            ).stdout
        )
        found[only] = spent, compared["rmse_over_mean"] / math.sqrt(2.0)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    parser.add_argument("--lamps", default="10,1000")
    options = parser.parse_args()
    first: dict[str, tuple[float, float]] | None = None
    for lamps in (int(count) for count in options.lamps.split(",")):
        with tempfile.TemporaryDirectory(prefix="bnvpl-lamps-") as name:
            found = measure(options.bin.resolve(), Path(name), lamps)
        first = first or found
        print(
            f"{lamps} lamps: "
            + "; ".join(
                f"{only} {spent:.2f} CPU s ({spent / first[only][0]:.2f} times), noise / mean "
                f"{noise:.4f}"
                for only, (spent, noise) in found.items()
            ),
            flush=True,
        )


if __name__ == "__main__":
    main()
