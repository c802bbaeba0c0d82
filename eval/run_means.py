#!/usr/bin/env python3
"""Compares the means of several runs of the pipeline with the mean of guided paths, room by room.

    export PBRT_SCENES=/folder/of/pbrt/scenes LIVING_ROOM_DIR=/folder
    export SPONZA_DIR=/folder VEACH_AJAR_DIR=/folder SUN_ROOM_DIR=/folder
    eval/run_means.py --runs 10 cornell veach-door

VPLs are placed and eliminated once with the options of --preset; each run estimates and renders
them with a seed of its own. Means are those of indirect light over the film. Rooms without files
are left out.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from bnvpl_eval import images, settings
from bnvpl_eval import stage_runs as runs
from bnvpl_eval.runner import Runner
from evaluate import beginning
from gallery import Scene
from room_images import SETTINGS
from room_list import SCENES, chosen


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ids = ", ".join(scene.id for scene in SCENES)
    parser.add_argument("rooms", nargs="*", help=f"{ids}; all unless given")
    parser.add_argument("--bin", type=Path, default=settings.ROOT / "build/release/bin")
    parser.add_argument(
        "--commit", help="of the tools in --bin; that of the working tree unless given"
    )
    parser.add_argument("--cache", type=Path, default=settings.ROOT / "build/eval/cache")
    parser.add_argument("--preset", choices=sorted(SETTINGS), default="default")
    parser.add_argument("--width", type=int, default=160, help="pixels")
    parser.add_argument("--runs", type=int, default=10, help="seeds of estimate and render")
    parser.add_argument("--spp", type=int, default=8, help="samples a pixel of a run")
    parser.add_argument("--guided-runs", type=int, default=3, help="images of guided paths")
    parser.add_argument("--guided-spp", type=int, default=32, help="samples a pixel of each")
    return parser.parse_args()


def means(tools: Runner, scene: Scene, given: argparse.Namespace) -> tuple[list[float], ...]:
    """Means of the indirect light by VPLs, and by guided paths."""
    place, eliminate, estimate, (_, _, *render) = SETTINGS[given.preset]  # without its --spp
    placed = runs.placed(tools, scene.path, *scene.options, *place)["candidates.vpl"]
    kept = runs.kept(tools, placed, *eliminate)["vpls.vpl"]

    def mean(seed: int, spp: int, *options: str) -> float:
        lit = runs.estimated(tools, scene.path, kept, *estimate, "--seed", seed)["lit.vpl"]
        film = [*scene.options, "--size", scene.film(given.width), "--only", "indirect"]
        more = ["--spp", spp, "--seed", seed, *options]
        image = runs.rendered(tools, scene.path, lit, *film, *more)["image.exr"]
        return float(images.read(image).mean())

    ours = [mean(1 + seed, given.spp, *render) for seed in range(given.runs)]
    guided = [
        mean(101 + seed, given.guided_spp, "--integrator", "guided")
        for seed in range(given.guided_runs)
    ]
    return ours, guided


def main() -> int:
    given = parse_arguments()
    rooms = chosen(given.rooms, "run_means")
    if given.runs < 2 or given.guided_runs < 2:
        sys.exit("run_means: a deviation needs two runs; raise --runs and --guided-runs")
    tools = Runner(given.bin.resolve(), given.cache.resolve(), True, beginning(given.commit))
    print("| room | mean | least and largest | deviation of a run | standard error of guided |")
    print("|---|---|---|---|---|", flush=True)
    for scene in rooms:
        ours, guided = (np.array(found) for found in means(tools, scene, given))
        ratio = ours / guided.mean()
        error = guided.std(ddof=1) / guided.mean() / len(guided) ** 0.5
        print(
            f"| {scene.title} | {ratio.mean():.3f} | {ratio.min():.3f}, {ratio.max():.3f} "
            f"| {100 * ratio.std(ddof=1):.2f} % | {100 * error:.2f} % |",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
