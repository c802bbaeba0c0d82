#!/usr/bin/python3
"""Cross-checks the path tracer of vpl-render with Blender's Cycles on the CPU.

    eval/cycles/cross_check.py                   all cases
    eval/cycles/cross_check.py cornell u-shape   two of them
    eval/cycles/cross_check.py --list
    eval/cycles/cross_check.py --table --results eval/cycles/results.json

Both render each view with several seeds. The ratio of the image means is printed with its standard
error. Exit codes: 0 if all means agree within --tolerance; 2 for wrong options; 3 if Blender,
vpl-render or an input is missing or fails; 5 if a mean differs by more, or is too noisy to tell.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import platform
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import compare
import walk
from both_renderers import ToolError, render_cycles, render_ours, require_program, samples
from cases import CASES, Case, View, prepare
from judgement import table, verdict
from outputs import RESULTS, output_guard
from scene_source import SceneError

ROOT = Path(__file__).resolve().parents[2]
SCENE_FILES = {".toml", ".obj", ".mtl", ".glb", ".gltf", ".pbrt", ".hdr"}
WALKS = 64  # number of batches of walk.py
EXIT_OK, EXIT_USAGE, EXIT_INPUT, EXIT_DIFFERENT = 0, 2, 3, 5


def parse_arguments(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="cross_check.py",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("cases", nargs="*", metavar="CASE", help="default: all")
    parser.add_argument("--list", action="store_true", help="print the cases and stop")
    parser.add_argument(
        "--table", action="store_true", help="print --results as a Markdown table and stop"
    )
    parser.add_argument(
        "--out",
        type=Path,
        default=ROOT / "out" / "cycles",
        help="folder for images (default out/cycles)",
    )
    parser.add_argument(
        "--results",
        type=Path,
        help="JSON to write; cases already in it stay (default OUT/results.json)",
    )
    parser.add_argument("--blender", default="blender", help="program (default blender)")
    parser.add_argument(
        "--vpl-render",
        default=str(ROOT / "build/release/bin/vpl-render"),
        help="program (default build/release/bin/vpl-render)",
    )
    parser.add_argument("--effort", type=float, default=1.0, help="factor on samples (default 1)")
    parser.add_argument(
        "--tolerance",
        type=float,
        default=0.01,
        help="allowed difference of the means (default 0.01)",
    )
    parser.add_argument("--threads", type=int, default=2, help="default 2")
    parser.add_argument(
        "--reuse",
        action="store_true",
        help="keep images of an earlier run of the same programs and scene, samples and seeds",
    )
    parser.add_argument(
        "--encoded-textures",
        action="store_true",
        help="Cycles filters textures before decoding them, as it does by itself",
    )
    options = parser.parse_args(arguments)
    names = [case.name for case in CASES]
    for name in options.cases:
        if name not in names:
            parser.error(f"no case '{name}'; use {', '.join(names)}")
    if options.effort <= 0 or options.tolerance <= 0 or options.threads < 1:
        parser.error("--effort, --tolerance and --threads must be positive")
    options.results = options.results or options.out / "results.json"
    return options


def made_by(scene: Path, case: Case, options: argparse.Namespace) -> str:
    """What the images of a case depend on, but for samples and seeds, which their names tell."""
    digest = hashlib.sha256(repr(case).encode())
    for program in options.vpl_render, options.blender:
        digest.update(first_line([program, "--version"]).encode())
    made = sorted(file for file in scene.parent.iterdir() if file.suffix in SCENE_FILES)
    for file in [*made, *Path(__file__).parent.glob("*.py"), *meshes_of(scene)]:
        digest.update(file.read_bytes())
    return digest.hexdigest()


def meshes_of(scene: Path) -> list[Path]:
    """Files outside its folder that a prepared scene names."""
    if scene.suffix != ".toml":
        return [scene]
    names = re.findall(r'^(?:file|materials) = "(.*)"$', scene.read_text(), re.MULTILINE)
    return [Path(name) for name in names if Path(name).is_file()]


def drop_others(folder: Path, made: str) -> None:
    """Removes the images of a folder unless they were made by the same."""
    mark = folder / "made_by.txt"
    if not (mark.is_file() and mark.read_text() == made):
        for image in folder.glob("*.exr"):
            if re.match(r"(ours|cycles)", image.name):
                image.unlink()
    mark.write_text(made)


def check(case: Case, options: argparse.Namespace) -> dict[str, Any]:
    folder = options.out / case.name
    scene = prepare(case, ROOT / "scenes", folder)
    drop_others(folder, made_by(scene, case, options))
    ours, our_seconds = render_ours(case, scene, options)
    cycles, cycles_seconds = render_cycles(case, scene, options)
    spp, cycles_spp = samples(case, options)
    result: dict[str, Any] = {
        "scene": case.scene,
        "note": case.note,
        "size": list(case.size),
        "seeds": case.seeds,
        "spp": spp,
        "cycles_spp": cycles_spp,
        "views": {},
        # null if nothing was rendered, with --reuse
        "time_s": round(our_seconds, 1) or None,
        "cycles_time_s": round(cycles_seconds, 1) or None,
    }
    for view in case.views:
        figures = compare.compare(ours[view], cycles[view])
        if case.model or case.name == "gltf-normal-map":
            figures["expected"], figures["expected_error"] = walk.expected_ratio(
                case.model, max(2, round(WALKS * options.effort))
            )
        figures["verdict"] = verdict(figures, options.tolerance)
        result["views"][view.name] = figures
        report(case, view, figures)
        compare.write_picture(
            folder / f"{view.name}.png", f"{case.name}, {view.name}", ours[view], cycles[view]
        )
    return result


def report(case: Case, view: View, figures: dict[str, Any]) -> None:
    mean, blocks = figures["mean"], figures["blocks"]
    ratio = "-" if mean["ratio"] is None else f"{mean['ratio']:.4f} +- {mean['error']:.4f}"
    if "expected" in figures:
        ratio += f" (expected {figures['expected']:.4f} +- {figures['expected_error']:.4f})"
    print(
        f"{case.name:15} {view.name:12} ours {mean['ours']:.5g}  Cycles {mean['cycles']:.5g}  "
        f"ratio {ratio}  blocks z^2 {blocks['mean_square_z']:.2f}  {figures['verdict']}",
        flush=True,
    )


def first_line(command: list[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return (done.stdout.splitlines() or [""])[0].strip()


def describe_run(options: argparse.Namespace) -> dict[str, Any]:
    git = ["git", "-C", str(ROOT)]
    parts = (
        "core formats images scene scenes spatial tools/common tools/render transport eval/cycles"
    ).split()
    changed = first_line([*git, "status", "--porcelain", "--", *parts]) != ""
    cpu = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())
    return {
        "commit": first_line([*git, "rev-parse", "--short=10", "HEAD"]),
        "sources_changed": changed,
        "blender": first_line([options.blender, "--version"]),
        "vpl_render": first_line([options.vpl_render, "--version"]),
        "cpu": cpu[1] if cpu else platform.machine(),
        "threads": options.threads,
        "effort": options.effort,
        "tolerance": options.tolerance,
        "encoded_textures": options.encoded_textures,
    }


def write_results(path: Path, runs: dict[str, Any]) -> None:
    output_guard.write(
        path, json.dumps(runs, indent=1, sort_keys=True) + "\n", RESULTS, "--results"
    )


def main(arguments: list[str]) -> int:
    options = parse_arguments(arguments)
    chosen = [case for case in CASES if not options.cases or case.name in options.cases]
    if options.list:
        for case in CASES:
            print(f"{case.name:15} {case.scene:24} {' '.join(v.name for v in case.views)}")
        return EXIT_OK
    if options.table:
        print(table(json.loads(options.results.read_text())))
        return EXIT_OK
    options.blender = require_program(
        options.blender, "apt-get install --no-install-recommends blender, or name it by --blender"
    )
    options.vpl_render = require_program(options.vpl_render, "build it, or name it by --vpl-render")
    output_guard.check(options.results, RESULTS, "--results")
    options.out.mkdir(parents=True, exist_ok=True)
    results = json.loads(options.results.read_text()) if options.results.is_file() else {}
    about = describe_run(options)
    good = True
    for case in chosen:
        results[case.name] = {"run": about} | check(case, options)
        write_results(options.results, results)
        good &= all(v["verdict"] == "agrees" for v in results[case.name]["views"].values())
    return EXIT_OK if good else EXIT_DIFFERENT


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except (SceneError, ToolError, output_guard.Refused, OSError, ValueError) as problem:
        print(f"cross_check.py: {problem}", file=sys.stderr)
        sys.exit(EXIT_INPUT)
