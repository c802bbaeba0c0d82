#!/usr/bin/env python3
"""Compares VPLs at default options with path tracing at equal time, room by room, full image.

    export PBRT_SCENES=/folder/of/pbrt/scenes LIVING_ROOM_DIR=/folder
    export SPONZA_DIR=/folder VEACH_AJAR_DIR=/folder SUN_ROOM_DIR=/folder
    eval/rooms.py --also light guided spread-path cycles
    eval/rooms.py --path-length 6 --also unlit-path guided --no-table veach-ajar-pbrt bathroom

The last command measures under the conditions of published ratios. Each room is rendered by the
pipeline with two settings, by the path tracer with as many samples as fit in the CPU time of all
four stages, and by others on request. All are judged by two halves of a reference: means over its
mean, relMSE, RMSE / mean, SMAPE and FLIP.

The rows of each room replace those of an earlier run in docs/rooms.csv, from which rooms_page.py
makes a table and a picture of docs/results.md. Rooms whose files do not exist are left out, as are,
for Cycles, those that it cannot read (eval/cycles).
"""

import argparse
import sys
from pathlib import Path

import rooms_page
from bnvpl_eval import settings
from bnvpl_eval.runner import Runner
from evaluate import beginning
from room_images import VARIANTS, Rooms
from room_list import SCENES, chosen


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "rooms", nargs="*", help=", ".join(scene.id for scene in SCENES) + "; all unless given"
    )
    parser.add_argument(
        "--bin", type=Path, default=settings.ROOT / "build/release/bin", help="folder of the tools"
    )
    parser.add_argument("--cache", type=Path, default=settings.ROOT / "build/eval/cache")
    parser.add_argument(
        "--commit", help="of the tools in --bin; that of the working tree unless given"
    )
    parser.add_argument("--width", type=int, default=320, help="pixels")
    parser.add_argument(
        "--truth",
        choices=("vpl", "path"),
        default="vpl",
        help="who renders the reference: VPLs, 12k of them "
        "with seeds of their own, which have less noise, or the path tracer, which shares "
        "nothing with them",
    )
    parser.add_argument("--reference-spp", type=int, default=64, help="of each half")
    parser.add_argument(
        "--also",
        nargs="*",
        default=[],
        choices=("light", "guided", *VARIANTS, "cycles"),
        metavar="OTHER",
        help="light, guided, unlit-path (without light sampling), spread-path (its fireflies "
        "redistributed), cycles",
    )
    parser.add_argument(
        "--path-length",
        type=int,
        default=0,
        metavar="L",
        help="segments from the camera to a light, those at mirrors and glass not counted",
    )
    parser.add_argument(
        "--reference-bin",
        type=Path,
        metavar="FOLDER",
        help="tools that render the references, with --fireflies keep; --bin unless given",
    )
    parser.add_argument(
        "--references-only", action="store_true", help="render the references, and stop"
    )
    parser.add_argument(
        "--no-table", action="store_true", help="leave docs/rooms.csv and the pages as they are"
    )
    return parser.parse_args()


def main() -> int:
    arguments = parse_arguments()
    begin = beginning(arguments.commit)
    runner, references = (
        Runner(folder.resolve(), arguments.cache.resolve(), True, begin)
        for folder in (arguments.bin, arguments.reference_bin or arguments.bin)
    )
    rooms = Rooms(
        runner,
        references,
        arguments.width,
        arguments.reference_spp,
        arguments.truth,
        arguments.path_length,
    )
    made = {
        "tools": begin["commit"],
        "date": begin["date"],
        "width": arguments.width,
        "reference": f"2 x {arguments.reference_spp} spp, {arguments.truth}",
        "path_length": arguments.path_length,
    }
    for scene in chosen(arguments.rooms, "rooms"):
        if arguments.references_only:
            rooms.halves(scene)
            continue
        rows = rooms.rows(scene, arguments.also)
        for row in rows:
            print(" ".join(str(value) for value in row.values()), flush=True)
        if not arguments.no_table:
            rooms_page.add([{**row, **made} for row in rows])
    if not (arguments.no_table or arguments.references_only):
        rooms_page.write()
    return 0


if __name__ == "__main__":
    sys.exit(main())
