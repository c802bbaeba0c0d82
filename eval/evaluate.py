#!/usr/bin/env python3
"""Runs the comparisons of settings.toml through the tools and writes one report.

eval/evaluate.py --size standard
eval/evaluate.py --size quick --parts methods,gather
"""

import argparse
import datetime
import importlib
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

from bnvpl_eval import output, settings
from bnvpl_eval.ahead import run_ahead
from bnvpl_eval.context import Context
from bnvpl_eval.runner import Runner

# Parts run in this order, so that later ones may use the rows of earlier ones.
PARTS = [
    "methods",
    "scatter",
    "gather",
    "claims",
    "equal_time",
    "energy",
    "reference_quality",
    "convergence",
    "sensitivity",
    "pictures",
]
# These parts run only when they are named, with a size of their own.
ALONE = ["field"]
NEED_METHODS = {"energy", "reference_quality"}
JUDGE_NOTHING = {"pictures"}
NEED_MAIN_VIEWS = {"scatter", "gather", "claims", "convergence", "sensitivity"}


def processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def git(*words: str) -> str:
    """Output of git; empty where there is no git or no clone."""
    if shutil.which("git") is None:
        return ""
    done = subprocess.run(["git", "-C", str(settings.ROOT), *words], capture_output=True, text=True)
    return done.stdout.strip()


def commit() -> str:
    changed = git(
        "status",
        "--porcelain",
        "--untracked-files=no",
        "--",
        "core",
        "formats",
        "images",
        "scene",
        "spatial",
        "tools",
        "transport",
    )
    return (git("rev-parse", "--short", "HEAD") or "unknown") + (" with changes" if changed else "")


def beginning(given_commit: str | None, threads: int | None = None) -> dict[str, Any]:
    """The state at the beginning, as the working tree may have changed hours later."""
    return {
        "commit": given_commit or commit(),
        "processor": processor(),
        "threads": threads or len(os.sched_getaffinity(0)),
        "date": datetime.date.today().isoformat(),
    }


def provenance(size: str, runner: Runner) -> dict[str, Any]:
    return {
        **runner.provenance,
        "size": size,
        "runs": len(runner.runs),
        "commits of the runs": ", ".join(
            sorted({run.record.get("commit", "unknown") for run in runner.runs.values()})
        ),
        "CPU seconds": round(sum(run.cpu_s for run in runner.runs.values())),
        "peak memory MiB": max((run.record["peak_mib"] for run in runner.runs.values()), default=0),
    }


def arguments_of() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--size", default="standard", help="of settings.toml: quick, standard, full; field, ..."
    )
    parser.add_argument(
        "--quick", action="store_const", dest="size", const="quick", help="the same as --size quick"
    )
    parser.add_argument(
        "--parts",
        default=",".join(PARTS),
        help=f"some of {','.join(PARTS)}, or one of {','.join(ALONE)}",
    )
    parser.add_argument("--settings", type=Path, default=settings.EVAL / "settings.toml")
    parser.add_argument("--scenes", help="some of the size's scenes, by id")
    parser.add_argument("--views", help="some of main,second")
    parser.add_argument(
        "--bin", type=Path, default=settings.ROOT / "build/release/bin", help="folder of the tools"
    )
    parser.add_argument("-o", "--output", type=Path, help="folder; build/eval/SIZE unless given")
    parser.add_argument(
        "--cache",
        type=Path,
        default=settings.ROOT / "build/eval/cache",
        help="where runs are kept for the next time",
    )
    parser.add_argument(
        "--commit", help="of the tools in --bin; that of the working tree unless given"
    )
    parser.add_argument(
        "--jobs", type=int, default=1, help="scenes at a time, each on one processor; default 1"
    )
    parser.add_argument("--quiet", action="store_true")
    return parser.parse_args()


def main() -> int:
    arguments = arguments_of()
    scenes, table = settings.load(arguments.settings)
    if arguments.size not in table["size"]:
        raise SystemExit(
            f"eval: no size '{arguments.size}'; settings.toml has {', '.join(table['size'])}"
        )
    parts = arguments.parts.split(",")
    known = [*PARTS, *ALONE]
    if unknown := [part for part in parts if part not in known]:
        raise SystemExit(f"eval: no part '{unknown[0]}'; there are {', '.join(known)}")
    for part in ALONE:
        if (part in parts) != arguments.size.startswith(part) or (part in parts and len(parts) > 1):
            raise SystemExit(
                f"eval: part '{part}' runs alone, with sizes of its own; use make -C eval {part}"
            )
    for part in NEED_METHODS & set(parts):
        if "methods" not in parts:
            raise SystemExit(f"eval: part '{part}' reads the rows of 'methods'; name that part too")
    size = table["size"][arguments.size]
    if arguments.views:
        size["views"] = arguments.views.split(",")
    wanted = arguments.scenes.split(",") if arguments.scenes else size["scenes"]
    for kind, asked, there in (
        ("scene", wanted, {scene.id for scene in scenes}),
        ("view", size["views"], {view.id for scene in scenes for view in scene.views}),
    ):
        if unknown := [name for name in asked if name not in there]:
            raise SystemExit(
                f"eval: no {kind} '{unknown[0]}'; settings.toml has {', '.join(sorted(there))}"
            )
    if "main" not in size["views"] and (without := NEED_MAIN_VIEWS & set(parts)):
        raise SystemExit(
            f"eval: {', '.join(sorted(without))} have rows of main views alone; add 'main' to "
            "--views, or name other --parts"
        )
    chosen = []
    for scene in (scene for scene in scenes if scene.id in wanted):
        if scene.available:
            chosen.append(scene)
        else:
            print(
                f"eval: {scene.title} is left out: set {scene.define} to the model's folder",
                file=sys.stderr,
            )
    if not chosen:
        raise SystemExit(f"eval: none of the scenes '{','.join(wanted)}' is there")
    folder = (arguments.output or settings.ROOT / "build/eval" / arguments.size).resolve()
    output.check(folder)
    ahead = arguments.jobs > 1  # also of one scene, so that its times are those of one thread
    begin = beginning(arguments.commit, 1 if ahead else None)
    runner = Runner(arguments.bin.resolve(), arguments.cache.resolve(), arguments.quiet, begin)
    modules = [
        importlib.import_module(f"bnvpl_eval.parts.{part}") for part in known if part in parts
    ]
    context = Context(arguments.size, size, table, chosen, runner)
    if set(parts) - JUDGE_NOTHING:
        context.require_references()
    if ahead:
        arguments.commit = begin["commit"]
        run_ahead(Path(__file__), arguments, [scene.id for scene in chosen])
    for module in modules:
        module.run(context)
    report = output.write_all(context, folder, provenance(arguments.size, runner))
    print(f"eval: {len(runner.runs)} runs; {report}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
