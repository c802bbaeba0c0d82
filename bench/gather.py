#!/usr/bin/python3
"""Measures the time of the gathers at equal error, against the number of VPLs.

    bench/gather.py --scenes u-shape,sponza --counts 1000,10000,100000 --plot growth.png

The error is relMSE against the sum over all VPLs for the same samples, up to --most-all VPLs.
Beyond that the reference is tile cuts with a twelfth of the default error. The time is CPU time
minus that of the same render without indirect light. The time of tile cuts is interpolated between
two settings to the error that Lightcuts has at 2 %.
"""

import argparse
import json
import math
import os
import resource
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "eval"))
from bnvpl_eval import images, statistics  # noqa: E402
from bnvpl_eval.guard import output_guard  # noqa: E402
from bnvpl_eval.scene_files import digest  # noqa: E402

FIGURES = output_guard.json_kind(
    "figures of gather.py",
    lambda rows: (
        isinstance(rows, list)
        and all(isinstance(row, dict) and "lightcuts_s" in row for row in rows)
    ),
)

TILE_ERRORS = [0.025, 0.05, 0.1, 0.2, 0.4]


def run(command: list[Any]) -> float:
    """Runs a tool. Returns its CPU seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"gather.py: {done.stderr.strip()}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Bench:
    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.work: Path = options.work
        self.bin: Path = options.bin
        options.work.mkdir(parents=True, exist_ok=True)
        tools = ("vpl-place", "vpl-eliminate", "vpl-estimate")
        # Files of another build may differ.
        self.build = digest(b"".join((options.bin / tool).read_bytes() for tool in tools))

    def lit(self, scene: str, count: int) -> Path:
        toml = ROOT / "scenes" / scene / "scene.toml"
        made = f"{scene}.{count}.{self.options.photons}.{self.build}"
        parts = [self.work / f"{made}.{stage}.vpl" for stage in ("c", "v", "l")]
        if not parts[2].is_file():
            run([self.bin / "vpl-place", toml, "-n", 10 * count, "-o", parts[0], "--quiet"])
            run([self.bin / "vpl-eliminate", parts[0], "-n", count, "-o", parts[1], "--quiet"])
            run(
                [
                    self.bin / "vpl-estimate",
                    toml,
                    parts[1],
                    "--photons",
                    self.options.photons,
                    "-o",
                    parts[2],
                    "--quiet",
                ]
            )
            parts[0].unlink()
        return parts[2]

    def render(self, scene: str, count: int, *extra: object) -> tuple[npt.NDArray[Any], float]:
        image = self.options.work / "image.exr"
        seconds = run(
            [
                self.bin / "vpl-render",
                ROOT / "scenes" / scene / "scene.toml",
                self.lit(scene, count),
                "-o",
                image,
                "--size",
                self.options.size,
                "--spp",
                self.options.spp,
                "--compensate",
                "none",
                "--fireflies",
                "keep",
                "--quiet",
                *extra,
            ]
        )
        return images.read(image), seconds

    def measure(self, scene: str, count: int) -> dict[str, Any]:
        exact = count <= self.options.most_all
        how: list[object] = ["--gather", "all"]
        if not exact:
            how = ["--error", 0.004, "--max-cut", 100000]
        reference, all_s = self.render(scene, count, "--only", "indirect", *how)
        _, idle_s = self.render(
            scene, count, "--only", "direct", "--direct-samples", 1, "--light-rays", 1
        )

        def judged(*words: object) -> tuple[float, float]:
            image, seconds = self.render(scene, count, "--only", "indirect", *words)
            relmse = statistics.summarise([image], (reference, reference))["relmse"]
            return relmse, max(1e-3, seconds - idle_s)

        error, lightcuts_s = judged("--gather", "lightcuts")
        tiles = [judged("--gather", "tilecuts", "--error", e) for e in TILE_ERRORS]
        logs = sorted((math.log(e), math.log(s)) for e, s in tiles)
        equal_s = math.exp(np.interp(math.log(error), [x for x, _ in logs], [y for _, y in logs]))
        default = tiles[TILE_ERRORS.index(0.05)]
        return {
            "scene": scene,
            "vpls": count,
            "relmse": error,
            "lightcuts_s": lightcuts_s,
            "tilecuts_s": equal_s,
            "ratio": lightcuts_s / equal_s,
            "all_s": all_s - idle_s if exact else None,
            "default_relmse": default[0],
            "default_s": default[1],
        }


def plot(rows: list[dict[str, Any]], path: Path) -> None:
    figure, axes = plt.subplots(figsize=(6.4, 4.8))
    for number, scene in enumerate(dict.fromkeys(row["scene"] for row in rows)):
        mine = [row for row in rows if row["scene"] == scene]
        colour = f"C{number}"
        axes.loglog(
            [r["vpls"] for r in mine],
            [r["lightcuts_s"] for r in mine],
            "o--",
            color=colour,
            label=f"{scene}: Lightcuts at 2 %",
        )
        axes.loglog(
            [r["vpls"] for r in mine],
            [r["tilecuts_s"] for r in mine],
            "o-",
            color=colour,
            label=f"{scene}: tile cuts, equal error",
        )
        every = [r for r in mine if r["all_s"]]
        axes.loglog(
            [r["vpls"] for r in every],
            [r["all_s"] for r in every],
            "o:",
            color=colour,
            label=f"{scene}: all VPLs",
        )
    axes.set_xlabel("VPLs")
    axes.set_ylabel("CPU seconds of the gather")
    axes.grid(True, which="both", alpha=0.3)
    # The legend stands below the plot.
    axes.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncol=2)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--scenes", default="u-shape,veach-door,sponza,veach-ajar")
    parser.add_argument("--counts", default="3000,100000")
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--spp", type=int, default=8)
    parser.add_argument("--photons", type=int, default=2_000_000)
    parser.add_argument(
        "--most-all", type=int, default=10_000, help="VPLs that are summed one by one"
    )
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    parser.add_argument(
        "--work", type=Path, default=ROOT / "build/bench-gather", help="folder for files"
    )
    parser.add_argument("--plot", type=Path, help="PNG to write")
    parser.add_argument("--json", type=Path, help="figures to write")
    options = parser.parse_args()
    for file, kind, option in (
        (options.json, FIGURES, "--json"),
        (options.plot, output_guard.PNG, "--plot"),
    ):
        if file:
            output_guard.or_exit(output_guard.check, file, kind, option)
    for name in options.scenes.split(","):
        variable = {"sponza": "SPONZA_DIR", "veach-ajar": "VEACH_AJAR_DIR"}.get(name)
        if variable and variable not in os.environ:
            sys.exit(f"gather.py: {name} needs {variable}; set it (scenes/README.md)")
    bench, rows = Bench(options), []
    print(
        "| scene | VPLs | relMSE of Lightcuts at 2 % | Lightcuts, CPU s | tile cuts at that "
        "error | ratio | all VPLs "
        "| tile cuts at 0.05: relMSE, CPU s |\n|---|---|---|---|---|---|---|---|"
    )
    for scene in options.scenes.split(","):
        for count in options.counts.split(","):
            r = bench.measure(scene, int(count))
            rows.append(r)
            every = f"{r['all_s']:.1f}" if r["all_s"] else ""
            print(
                f"| {scene} | {r['vpls']} | {r['relmse']:.2e} | {r['lightcuts_s']:.2f} | "
                f"{r['tilecuts_s']:.2f} "
                f"| {r['ratio']:.1f}x | {every} | {r['default_relmse']:.2e}, "
                f"{r['default_s']:.2f} |",
                flush=True,
            )
    if options.json:
        output_guard.or_exit(
            output_guard.write, options.json, json.dumps(rows, indent=1) + "\n", FIGURES, "--json"
        )
    if options.plot:
        output_guard.or_exit(
            output_guard.replace,
            options.plot,
            output_guard.PNG,
            lambda partial: plot(rows, partial),
            "--plot",
        )


if __name__ == "__main__":
    main()
