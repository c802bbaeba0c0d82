"""Runs the four stages for a configuration."""

import json
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .runner import Run, Runner
from .settings import ROOT, View
from .stage_runs import estimated, kept, kept_by_rejection, placed, rendered

# Methods of the comparison, and the options that differ from the tools' defaults.
METHODS = {
    "light": "from the light (instant radiosity)",
    "rejection": "from the light, by rejection",
    "random": "random, from the camera",
    "uniform": "blue noise, uniform (thesis)",
    "local": "blue noise, local density (ours)",
    "paths": "ours, light gathered by paths",
    "even": "ours, but the thesis' scatter",
    "literal": "thesis' scatter and sites",
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
    command = [str(runner.bin / tool), "--methods", "--json"]
    spec = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)
    return [m["name"] for s in spec["slots"] if s["name"] == slot for m in s["methods"]]


def shadow_rays(runner: Runner, view: View, c: Configuration, seed: int) -> float:
    """Shadow rays towards VPLs, a sample."""
    result: float = json.loads(image(runner, view, c, seed)[1][-1]["stats.json"].read_text())[
        "mean_shadow_rays"
    ]
    return result


def candidates(runner: Runner, view: View, c: Configuration, seed: int) -> Run:
    return placed(runner, ROOT / view.file, "-n", c.candidates, "--seed", seed, *c.place)


def from_lights(runner: Runner, view: View, count: int, c: Configuration, seed: int) -> Run:
    """VPLs at vertices of paths from the lights."""
    options = ("--method", "light", "-n", count, "--seed", seed, *c.place)
    return placed(runner, ROOT / view.file, *options, output="lit.vpl")


def lit_by_rejection(
    runner: Runner, view: View, c: Configuration, seed: int
) -> tuple[Path, list[Run]]:
    """VPLs from the lights that Russian roulette keeps by their share of the image."""
    vpls = from_lights(runner, view, c.vpls * REJECTION_CANDIDATES, c, seed)
    options = ("-n", c.vpls, "--seed", seed, *c.eliminate)
    run = kept_by_rejection(runner, vpls["lit.vpl"], ROOT / view.file, *options)
    return run["lit.vpl"], [vpls, run]


def lit_by_estimate(
    runner: Runner, view: View, c: Configuration, seed: int
) -> tuple[Path, list[Run]]:
    """VPLs that are placed, thinned out, and lit by vpl-estimate."""
    before = candidates(runner, view, c, seed)
    options = ("-n", c.vpls, *ELIMINATE[c.method], *c.eliminate)
    options += ("--seed", seed) if c.method == "random" else ()
    vpls = kept(runner, before["candidates.vpl"], *options)
    photons = () if c.method == "paths" else ("--photons", c.photons)
    options = ("--seed", seed, *photons, *ESTIMATE.get(c.method, ()), *c.estimate)
    run = estimated(runner, ROOT / view.file, vpls["vpls.vpl"], *options)
    return run["lit.vpl"], [before, vpls, run]


def lit(runner: Runner, view: View, c: Configuration, seed: int) -> tuple[Path, list[Run]]:
    """The lit VPLs, and the runs that made them."""
    if c.method == "light":
        run = from_lights(runner, view, c.vpls, c, seed)
        return run["lit.vpl"], [run]
    if c.method == "rejection":
        return lit_by_rejection(runner, view, c, seed)
    return lit_by_estimate(runner, view, c, seed)


def image(runner: Runner, view: View, c: Configuration, seed: int) -> tuple[Path, list[Run]]:
    """The image with its layers direct and indirect, and the runs of all stages."""
    vpls, runs = lit(runner, view, c, seed)
    options = ("--size", c.film, "--spp", c.spp, "--seed", seed)
    layers = ("--layers", "direct,indirect,cutsize")
    more = (*RENDER.get(c.method, ()), *c.render, *layers)
    run = rendered(runner, ROOT / view.file, vpls, *options, *more)
    return run["image.exr"], runs + [run]


def contributions(
    runner: Runner, view: View, c: Configuration, seed: int, film: str = ""
) -> Path:
    """The VPLs of the image that light each pixel most, on a film of 80 pixels unless given."""
    vpls, _ = lit(runner, view, c, seed)
    words = ["contributions", "{lit}", "--scene", "{scene}", "-o", "@contributions.json", "--quiet"]
    words += ["--size", film] if film else []
    inputs = {"lit": vpls, "scene": ROOT / view.file}
    return runner.run("vpl-inspect", words, inputs, ["contributions.json"])["contributions.json"]


def traced(
    runner: Runner, view: View, film: str, spp: int, seed: int, integrator: str = "path"
) -> tuple[Path, list[Run]]:
    options = ("--size", film, "--integrator", integrator, "--spp", spp, "--seed", seed)
    run = rendered(runner, ROOT / view.file, None, *options, "--layers", "direct,indirect")
    return run["image.exr"], [run]
