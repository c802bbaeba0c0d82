#!/usr/bin/env python3
r"""Simulates how long a sequence takes on a farm with the graph of generate_ninja.py or submit.py.

    eval/scaling/farm.py --frames 1000 --size 3840x2160 --vpls 100k --photons 1G --spp 64 \
        --nodes 1,10,100,1000
    eval/scaling/farm.py ... --nodes 1000 --failure-hours 500 --svg farm.svg

cost_model.json predicts the cost of each task, and a random factor scatters its time. The output
depends only on the options and the seed.
"""

import argparse
import math
import pathlib
import re
import sys
import tempfile
from typing import Any

sys.dont_write_bytecode = True
sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "pipelines"))
import cost  # noqa: E402
import farm_graph  # noqa: E402
import farm_picture  # noqa: E402
import farm_schedule  # noqa: E402
import output_guard  # noqa: E402
import stage_options  # noqa: E402
import stages  # noqa: E402

KINDS = ("place", "eliminate", "estimate", "render", "merge")


def count(text: str) -> float:
    try:
        return cost.count(text)
    except ValueError as problem:
        raise argparse.ArgumentTypeError(str(problem)) from None


def count_option(name: str, text: str) -> float:
    """The count that an option names. Ends the program if it is none."""
    try:
        return cost.count(text)
    except ValueError as problem:
        stage_options.refuse(f"{name}: {problem}")


def positive(text: str) -> float:
    value = count(text)
    if value <= 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not above 0")
    return value


def node_counts(text: str) -> list[int]:
    chosen = sorted({int(count(word)) for word in text.split(",")})
    if chosen[0] < 1:
        raise argparse.ArgumentTypeError(f"'{text}': a farm has one node at least")
    return chosen


def film(text: str) -> int:
    if not (match := re.fullmatch(r"([1-9]\d*)x([1-9]\d*)", text)):
        raise argparse.ArgumentTypeError(f"'{text}' is no size such as 3840x2160")
    return int(match[1]) * int(match[2])


def add_farm(p: argparse.ArgumentParser) -> None:
    """Options of the images and of the nodes that make them."""
    p.add_argument("--frames", type=int, default=1, help="images of the one scene (default 1)")
    p.add_argument(
        "--size",
        type=film,
        default="1920x1080",
        metavar="WxH",
        help="of an image (default %(default)s)",
    )
    p.add_argument("--triangles", type=count, default="1M", help="default %(default)s")
    p.add_argument(
        "--nodes",
        type=node_counts,
        default="100",
        metavar="N,...",
        help="farms to compare (default 100)",
    )
    p.add_argument("--cores", type=int, default=16, help="of a node (default 16)")
    p.add_argument(
        "--cpus",
        action=stage_options.PerStage,
        stages=KINDS,
        pattern=r"[1-9]\d*",
        what="a count from 1",
        default=dict.fromkeys(KINDS, "4") | {"merge": "1"},
        help="of a task; default 4, and merge=1",
    )


def add_times(p: argparse.ArgumentParser) -> None:
    """Options of what tasks take, by themselves and through failures."""
    p.add_argument(
        "--scale",
        action=stage_options.PerStage,
        stages=KINDS[:4],
        pattern=r"\d+(\.\d+)?",
        what="a factor",
        default={},
        help="of a stage but for loading, where the scene is not like the model's; default 1",
    )
    p.add_argument(
        "--efficiency",
        type=positive,
        default=0.95,
        help="of a tool's threads (default %(default)s)",
    )
    p.add_argument(
        "--scatter", type=count, default="0.1", help="of times, as a share (default %(default)s)"
    )
    p.add_argument(
        "--start", type=count, default="1", metavar="S", help="seconds to start a task (default 1)"
    )
    p.add_argument(
        "--checkpoint-every", type=positive, default="60", metavar="S", help="default 60"
    )
    p.add_argument(
        "--failure-hours",
        type=positive,
        default=math.inf,
        metavar="H",
        help="mean time of a node between failures (default: none fail)",
    )
    p.add_argument(
        "--repair",
        type=count,
        default="600",
        metavar="S",
        help="until a failed node is back (default 600)",
    )
    p.add_argument(
        "--order",
        choices=("stages", "files"),
        default="stages",
        help="a task waits for whole stages, as with Slurm, or for its files, as with ninja "
        "(default stages)",
    )


def refuse_what_is_wrong(p: argparse.ArgumentParser, options: argparse.Namespace) -> None:
    if options.frames < 1:
        p.error(f"--frames {options.frames} is not 1 or more")
    if options.views or options.place_views:
        p.error("--views and --place-views are files; --frames says how many there are")
    if options.quality != "default" or any(
        getattr(options, f"{stage}_flags") for stage in KINDS[:4]
    ):
        p.error(
            "the cost model is of the tools' default options; leave out --quality and flags, and "
            "give counts and --scale"
        )
    widest = max(map(int, options.cpus.values()))
    if widest > options.cores:
        p.error(
            f"--cpus: a task of {widest} cores does not fit on a node of {options.cores}; raise "
            "--cores"
        )


def arguments(words: list[str]) -> argparse.Namespace:
    p = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    stage_options.add_arguments(p)
    p.set_defaults(bin="bin")  # no tool runs, so any name will do
    add_farm(p)
    add_times(p)
    p.add_argument(
        "--chance", type=int, default=1, metavar="SEED", help="of scatter and failures (default 1)"
    )
    p.add_argument(
        "--model", type=pathlib.Path, default=cost.MODEL, help="default pipelines/cost_model.json"
    )
    p.add_argument(
        "--svg",
        type=pathlib.Path,
        help="picture: wall time over nodes, and what runs when on the largest farm",
    )
    options = p.parse_args(words)
    refuse_what_is_wrong(p, options)
    stage_options.complete(options)
    if options.svg:
        output_guard.or_exit(output_guard.check, *picture_of(options))
    return options


def picture_of(
    options: argparse.Namespace,
) -> tuple[pathlib.Path, output_guard.Kind, str, dict[str, pathlib.Path]]:
    return options.svg, output_guard.SVG, "--svg", {"--model": options.model}


def tasks_of(options: argparse.Namespace) -> list[stages.Task]:
    """Tasks of stages.py, with one view a frame. The views are empty files, as none is read."""
    with tempfile.TemporaryDirectory(prefix="bnvpl-farm-") as folder:
        if options.frames > 1:
            options.views = [f"{folder}/{frame:06d}.toml" for frame in range(1, options.frames + 1)]
            for view in options.views:
                pathlib.Path(view).touch()
        return stages.tasks_of("film/scene.toml", options)


def jobs_of(options: argparse.Namespace) -> list[farm_graph.Job]:
    conditions = farm_graph.Conditions(
        {kind: int(n) for kind, n in options.cpus.items()},
        options.efficiency,
        options.scatter,
        {kind: float(f) for kind, f in options.scale.items()},
        options.chance,
    )
    whole = cost.Counts(
        options.triangles,
        count_option("--candidates", options.candidates),
        count_option("--vpls", options.vpls),
        count_option("--photons", options.photons),
        options.size,
        count_option("--spp", options.spp),
    )
    return farm_graph.jobs_of(
        tasks_of(options),
        options.order,
        cost.load(options.model),
        whole,
        options.shards,
        conditions,
    )


def farm_of(options: argparse.Namespace, nodes: int) -> farm_schedule.Farm:
    return farm_schedule.Farm(
        nodes,
        options.cores,
        options.start,
        options.checkpoint_every,
        options.failure_hours * 3600,
        options.repair,
        options.chance,
    )


def time_text(s: float) -> str:
    for unit, size in (("d", 86400), ("h", 3600), ("min", 60)):
        if s >= 2 * size:
            return f"{s / size:.1f} {unit}"
    return f"{s:.1f} s"


def size_text(n: float) -> str:
    if n == 0:
        return "-"
    for unit, size in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6)):
        if n >= size:
            return f"{n / size:.1f} {unit}"
    return f"{n / 1e3:.1f} kB"


def print_stages(jobs: list[farm_graph.Job]) -> None:
    print(
        f"{'stage':15}{'tasks':>7}{'CPU hours':>11}{'longest task':>14}{'memory of one':>15}"
        f"{'files':>11}"
    )
    for stage in dict.fromkeys(job.stage for job in jobs):
        mine = [job for job in jobs if job.stage == stage and job.cores]
        print(
            f"{stage:15}{len(mine):7}{sum(job.cpu_s for job in mine) / 3600:11.2f}"
            f"{time_text(max(job.wall_s for job in mine)):>14}"
            f"{max(job.memory_mib for job in mine):11.0f} MiB"
            f"{size_text(sum(job.file_bytes for job in mine)):>11}"
        )


def print_path(jobs: list[farm_graph.Job], start_s: float) -> None:
    path = farm_graph.critical_path(jobs)
    total = sum(job.wall_s + start_s for job in path)
    print(
        f"\ncritical path: {time_text(total)}: "
        + ", ".join(f"{job.name} {time_text(job.wall_s)}" for job in path)
    )


def row_of(
    jobs: list[farm_graph.Job],
    farm: farm_schedule.Farm,
    outcome: farm_schedule.Outcome,
    cpu_s: float,
) -> dict[str, Any]:
    core_s = sum(jobs[a.job].cores * (a.end_s - a.begin_s) for a in outcome.attempts)
    once_s = sum(job.cores * (job.wall_s + farm.start_s) for job in jobs if job.cores)
    whole_s = farm.nodes * farm.cores * outcome.wall_s
    return {
        "nodes": farm.nodes,
        "wall_s": outcome.wall_s,
        "busy": core_s / whole_s,
        "cpu_share": cpu_s / whole_s,
        "failures": outcome.failures,
        "attempts": len(outcome.attempts),
        "lost_h": max(0.0, core_s - once_s) / 3600,
    }


def print_rows(rows: list[dict[str, Any]]) -> None:
    print(
        f"\n{'nodes':>6}{'wall time':>12}{'times faster':>14}{'cores taken':>13}{'CPU used':>10}"
        f"{'failures':>10}"
        f"{'attempts':>10}{'lost':>11}"
    )
    for row in rows:
        print(
            f"{row['nodes']:6}{time_text(row['wall_s']):>12}"
            f"{rows[0]['wall_s'] / row['wall_s']:14.1f}"
            f"{100 * row['busy']:11.0f} %{100 * row['cpu_share']:8.0f} %{row['failures']:10}"
            f"{row['attempts']:10}"
            f"{row['lost_h']:9.1f} h"
        )


def print_limit(rows: list[dict[str, Any]]) -> None:
    """Prints where scaling ends: the first farm on which tasks hold less than half of the cores."""
    for row in rows:
        if row["busy"] < 0.5:
            print(f"\nof {row['nodes']} nodes, half of the cores and more stand idle")
            return


def main(words: list[str]) -> None:
    options = arguments(words)
    jobs = jobs_of(options)
    print_stages(jobs)
    print_path(jobs, options.start)
    cpu_s = sum(job.cpu_s for job in jobs)
    rows: list[dict[str, Any]] = []
    for nodes in options.nodes:
        try:
            outcome = farm_schedule.simulate(jobs, farm_of(options, nodes))
        except ValueError as problem:
            stage_options.refuse(str(problem))
        rows.append(row_of(jobs, farm_of(options, nodes), outcome, cpu_s))
    print_rows(rows)
    print_limit(rows)
    if options.svg:
        limit_s = sum(job.wall_s + options.start for job in farm_graph.critical_path(jobs))
        file, *guard = picture_of(options)
        output_guard.or_exit(
            output_guard.write,
            file,
            farm_picture.svg(rows, limit_s, jobs, outcome, options.nodes[-1] * options.cores),
            *guard,
        )


if __name__ == "__main__":
    output_guard.run(main, sys.argv[1:])
