"""Runs the four stages for a configuration."""

import json
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .runner import Run, Runner
from .settings import ROOT, View

# Methods of the comparison, and the options that differ from the tools' defaults.
METHODS = {
    "light": "from the light (instant radiosity)",
    "rejection": "from the light, by rejection",
    "random": "random, from the camera",
    "uniform": "blue noise, uniform (thesis)",
    "local": "blue noise, local density (ours)",
    "paths": "ours, light gathered by paths",
    "even": "ours, but the thesis' scatter",
    "literal": "thesis to the letter",
}
ELIMINATE = {
    "random": ("--method", "random"),
    "rejection": ("--method", "rejection"),
    "uniform": ("--density", "uniform"),
    "local": (),
    "paths": (),
    "even": (),
    "literal": ("--density", "uniform"),
}
ESTIMATE = {
    "paths": ("--method", "paths"),
    "even": ("--method", "even"),
    "literal": ("--method", "even", "--emit-points", "0"),
}
REJECTION_CANDIDATES = 10  # VPLs from photons for each VPL that is kept
RENDER = {
    "literal": ("--compensate", "none", "--fireflies", "keep"),
}


@dataclass(frozen=True)
class Configuration:
    method: str
    vpls: int
    photons: int
    candidates: int  # count for methods that place from the camera
    spp: int
    film: str  # WIDTHxHEIGHT
    place: tuple[Any, ...] = ()
    eliminate: tuple[Any, ...] = ()
    estimate: tuple[Any, ...] = ()
    render: tuple[Any, ...] = ()

    def but(self, **changes: Any) -> "Configuration":
        return replace(self, **changes)


def sampled(c: Configuration, plan: dict[str, Any]) -> Configuration:
    """The configuration with the samples, near-field rays and error of a part of settings.toml."""
    return c.but(
        spp=plan["spp"],
        render=(*c.render, "--near-field-rays", plan["near_field_rays"], "--error", plan["error"]),
    )


def told(plan: dict[str, Any]) -> str:
    return (
        f"{plan['spp']} samples a pixel with {plan['near_field_rays']} near-field rays each and "
        "an error of cuts of "
        f"{plan['error']}"
    )


def options_of(c: Configuration) -> dict[str, str]:
    """Options of each stage besides counts, which tell configurations of one method apart."""
    methods: dict[str, Mapping[str, Any]] = {
        "place": {},
        "eliminate": ELIMINATE,
        "estimate": ESTIMATE,
        "render": RENDER,
    }
    return {
        f"{stage}_options": " ".join(map(str, (*method.get(c.method, ()), *getattr(c, stage))))
        for stage, method in methods.items()
    }


def methods_of(runner: Runner, tool: str, slot: str) -> list[str]:
    """The methods that a tool lists for one of its options."""
    spec = json.loads(
        subprocess.run([runner.bin / tool, "--help-json"], capture_output=True, check=True).stdout
    )
    return [m["name"] for s in spec["slots"] if s["name"] == slot for m in s["methods"]]


def shadow_rays(runner: Runner, view: View, c: Configuration, seed: int) -> float:
    """Shadow rays towards VPLs, a sample."""
    result: float = json.loads(image(runner, view, c, seed)[1][-1]["stats.json"].read_text())[
        "mean_shadow_rays"
    ]
    return result


def candidates(runner: Runner, view: View, c: Configuration, seed: int) -> Run:
    return runner.run(
        "vpl-place",
        [
            "{scene}",
            "-n",
            c.candidates,
            "--seed",
            seed,
            *c.place,
            "-o",
            "@candidates.vpl",
            "--quiet",
        ],
        {"scene": ROOT / view.file},
        ["candidates.vpl"],
    )


def lit_by_light(runner: Runner, view: View, c: Configuration, seed: int) -> tuple[Path, list[Run]]:
    """VPLs at vertices of paths from the lights."""
    scene = {"scene": ROOT / view.file}
    run = runner.run(
        "vpl-place",
        [
            "{scene}",
            "--method",
            "light",
            "-n",
            c.vpls,
            "--seed",
            seed,
            *c.place,
            "-o",
            "@lit.vpl",
            "--quiet",
        ],
        scene,
        ["lit.vpl"],
    )
    return run["lit.vpl"], [run]


def lit_by_rejection(
    runner: Runner, view: View, c: Configuration, seed: int
) -> tuple[Path, list[Run]]:
    """VPLs from the lights that Russian roulette keeps by their share of the image."""
    scene = {"scene": ROOT / view.file}
    placed = runner.run(
        "vpl-place",
        [
            "{scene}",
            "--method",
            "light",
            "-n",
            c.vpls * REJECTION_CANDIDATES,
            "--seed",
            seed,
            *c.place,
            "-o",
            "@all.vpl",
            "--quiet",
        ],
        scene,
        ["all.vpl"],
    )
    run = runner.run(
        "vpl-eliminate",
        [
            "{all}",
            "--scene",
            "{scene}",
            "--method",
            "rejection",
            "-n",
            c.vpls,
            "--seed",
            seed,
            *c.eliminate,
            "-o",
            "@lit.vpl",
            "--quiet",
        ],
        {**scene, "all": placed["all.vpl"]},
        ["lit.vpl"],
    )
    return run["lit.vpl"], [placed, run]


def lit_by_estimate(
    runner: Runner, view: View, c: Configuration, seed: int
) -> tuple[Path, list[Run]]:
    """VPLs that are placed, thinned out, and lit by vpl-estimate."""
    scene = {"scene": ROOT / view.file}
    placed = candidates(runner, view, c, seed)
    kept = runner.run(
        "vpl-eliminate",
        [
            "{candidates}",
            "-n",
            c.vpls,
            *ELIMINATE[c.method],
            *c.eliminate,
            *(("--seed", seed) if c.method == "random" else ()),
            "-o",
            "@vpls.vpl",
            "--quiet",
        ],
        {"candidates": placed["candidates.vpl"]},
        ["vpls.vpl"],
    )
    run = runner.run(
        "vpl-estimate",
        [
            "{scene}",
            "{vpls}",
            "--seed",
            seed,
            *(() if c.method == "paths" else ("--photons", c.photons)),
            *ESTIMATE.get(c.method, ()),
            *c.estimate,
            "-o",
            "@lit.vpl",
            "--stats",
            "@stats.json",
            "--quiet",
        ],
        {**scene, "vpls": kept["vpls.vpl"]},
        ["lit.vpl", "stats.json"],
    )
    return run["lit.vpl"], [placed, kept, run]


def lit(runner: Runner, view: View, c: Configuration, seed: int) -> tuple[Path, list[Run]]:
    """The lit VPLs, and the runs that made them."""
    if c.method == "light":
        return lit_by_light(runner, view, c, seed)
    if c.method == "rejection":
        return lit_by_rejection(runner, view, c, seed)
    return lit_by_estimate(runner, view, c, seed)


def image(runner: Runner, view: View, c: Configuration, seed: int) -> tuple[Path, list[Run]]:
    """The image with its layers direct and indirect, and the runs of all stages."""
    vpls, runs = lit(runner, view, c, seed)
    run = runner.run(
        "vpl-render",
        [
            "{scene}",
            "{lit}",
            "--size",
            c.film,
            "--spp",
            c.spp,
            "--seed",
            seed,
            *RENDER.get(c.method, ()),
            *c.render,
            "--layers",
            "direct,indirect,cutsize",
            "-o",
            "@image.exr",
            "--stats",
            "@stats.json",
            "--quiet",
        ],
        {"scene": ROOT / view.file, "lit": vpls},
        ["image.exr", "stats.json"],
    )
    return run["image.exr"], runs + [run]


def traced(
    runner: Runner, view: View, film: str, spp: int, seed: int, integrator: str = "path"
) -> tuple[Path, list[Run]]:
    run = runner.run(
        "vpl-render",
        [
            "{scene}",
            "--size",
            film,
            "--integrator",
            integrator,
            "--spp",
            spp,
            "--seed",
            seed,
            "--layers",
            "direct,indirect",
            "-o",
            "@image.exr",
            "--quiet",
        ],
        {"scene": ROOT / view.file},
        ["image.exr"],
    )
    return run["image.exr"], [run]
