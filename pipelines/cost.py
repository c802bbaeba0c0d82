"""Predicts the cost of a task, in CPU seconds, memory and size of its file.

Each figure of a stage is a sum of terms. A term is a rate times a function of the counts.
eval/scaling/cost_model.py fits the rates to measured runs and writes cost_model.json. This module
defines the terms and evaluates them.
"""

import dataclasses
import json
import math
import pathlib
import re
from collections.abc import Callable

import output_guard
import tool_options

MODEL = pathlib.Path(__file__).resolve().parent / "cost_model.json"
DIVIDED = ("place", "estimate", "render")


@dataclasses.dataclass(frozen=True)
class Counts:
    triangles: float = 0
    candidates: float = 0
    vpls: float = 0
    photons: float = 0
    pixels: float = 0
    spp: float = 0
    shards: int = 1  # parts of the stage, of which a task does one and a merge reads all
    threads: int = 1  # threads of a task

    @property
    def share(self) -> float:
        return 1 / self.shards


def count(text: str) -> float:
    """Parses a count as the tools do, such as 3k, 10M or 1e9. Raises ValueError."""
    match = re.fullmatch(tool_options.FORMS["count"][0], text)
    if not match:
        raise ValueError(f"'{text}' is no count such as 3k, 10M or 1e9")
    return float(match[1]) * tool_options.SUFFIXES[match[2].lower()]


def with_shards(whole: Counts, stage: str, shards: dict[str, int]) -> Counts:
    """Counts of one task or merge of a stage, given the shards of each stage as {stage: count}."""
    return dataclasses.replace(whole, shards=shards.get(stage.removeprefix("merge-"), 1))


def depth(n: float) -> float:
    """Levels of a balanced binary tree with n leaves."""
    return math.log2(max(2, n))


# The constants of stepsFor().
MAX_PER_VPL, STEP_FACTOR, MAX_WORK = 24, 10, 2**18


def pairs(c: Counts) -> float:
    """Pairs of competing candidates, over the steps of stepsFor() (tools/eliminate/elimination)."""
    steps = [max(1.0, c.vpls)]
    while (each := c.candidates / steps[-1]) > MAX_PER_VPL and each * c.candidates > MAX_WORK:
        steps.append(STEP_FACTOR * steps[-1])
    left = [c.candidates, *reversed(steps[1:])]
    return sum(before**2 / kept for before, kept in zip(left, reversed(steps), strict=True))


def pilots(c: Counts) -> float:
    """Samples that --allocate spends on its marginal cost: all pixels of at most 48 tiles."""
    return 4 * min(c.pixels, 48 * 64)


# {stage: {figure: {term: function of counts}}}. Terms with the factor `share` are divided among
# the shards. Every shard repeats the work of the others.
Rates = dict[str, dict[str, dict[str, float]]]
TERMS: dict[str, dict[str, dict[str, Callable[[Counts], float]]]] = {
    "place": {
        "cpu_s": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "candidates": lambda c: c.candidates * c.share,
            "candidates log2(triangles)": lambda c: c.candidates * c.share * depth(c.triangles),
            "candidates sqrt(triangles)": lambda c: c.candidates * c.share * math.sqrt(c.triangles),
        },
        "memory_MiB": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "candidates": lambda c: c.candidates * c.share,
        },
        "file_bytes": {"candidates": lambda c: c.candidates * c.share},
    },
    "eliminate": {
        "cpu_s": {
            "start": lambda c: 1,
            "candidates": lambda c: c.candidates,
            "candidates log2(candidates)": lambda c: c.candidates * depth(c.candidates),
            "pairs": pairs,
            "VPLs": lambda c: c.vpls,
        },
        "memory_MiB": {
            "start": lambda c: 1,
            "candidates": lambda c: c.candidates,
            "VPLs": lambda c: c.vpls,
        },
        "file_bytes": {"VPLs": lambda c: c.vpls},
    },
    "estimate": {
        "cpu_s": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "VPLs": lambda c: c.vpls,
            "photons, pilots": lambda c: c.photons,
            "photons": lambda c: c.photons * c.share,
            "photons log2(triangles)": lambda c: c.photons * c.share * depth(c.triangles),
            "photons sqrt(triangles)": lambda c: c.photons * c.share * math.sqrt(c.triangles),
        },
        "memory_MiB": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "VPLs": lambda c: c.vpls,
            "VPLs x further threads": lambda c: c.vpls * (c.threads - 1),
        },
        "file_bytes": {
            "VPLs": lambda c: c.vpls if c.shards == 1 else 0,
            "VPLs, in shards": lambda c: c.vpls if c.shards > 1 else 0,
        },
    },
    "render": {
        "cpu_s": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "VPLs": lambda c: c.vpls,
            "sqrt(VPLs)": lambda c: math.sqrt(c.vpls),
            "pixels, of the whole film": lambda c: c.pixels,
            "pilots": pilots,
            "pilots log2(VPLs)": lambda c: pilots(c) * depth(c.vpls),
            "pixels": lambda c: c.pixels * c.share,
            "pixels log2(VPLs)": lambda c: c.pixels * c.share * depth(c.vpls),
            "pixels sqrt(VPLs)": lambda c: c.pixels * c.share * math.sqrt(c.vpls),
            "samples": lambda c: c.pixels * c.spp * c.share,
            "samples log2(VPLs)": lambda c: c.pixels * c.spp * c.share * depth(c.vpls),
            "samples log2(triangles)": lambda c: c.pixels * c.spp * c.share * depth(c.triangles),
            "samples sqrt(triangles)": lambda c: (
                c.pixels * c.spp * c.share * math.sqrt(c.triangles)
            ),
        },
        "memory_MiB": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "VPLs": lambda c: c.vpls,
            "pixels, of the whole film": lambda c: c.pixels,
            "pixels": lambda c: c.pixels * c.share,
        },
        "file_bytes": {
            "pixels": lambda c: c.pixels if c.shards == 1 else 0,
            "pixels, in shards": lambda c: c.pixels * c.share if c.shards > 1 else 0,
        },
    },
    "merge-place": {
        "cpu_s": {
            "start": lambda c: 1,
            "candidates": lambda c: c.candidates,
            "shards": lambda c: c.shards,
        },
        "memory_MiB": {"start": lambda c: 1, "candidates": lambda c: c.candidates},
    },
    "merge-estimate": {
        "cpu_s": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "VPLs": lambda c: c.vpls,
            "VPLs x shards": lambda c: c.vpls * c.shards,
        },
        "memory_MiB": {
            "start": lambda c: 1,
            "triangles": lambda c: c.triangles,
            "VPLs": lambda c: c.vpls,
        },
    },
    "merge-render": {
        "cpu_s": {"start": lambda c: 1, "pixels": lambda c: c.pixels, "shards": lambda c: c.shards},
        "memory_MiB": {"start": lambda c: 1, "pixels": lambda c: c.pixels},
    },
}


class Model:
    """Predicts figures from the rates {stage: {figure: {term: rate}}}."""

    def __init__(self, rates: Rates) -> None:
        self.rates = rates

    def predict(self, stage: str, figure: str, counts: Counts) -> float:
        terms = TERMS[stage][figure]
        return sum(rate * terms[name](counts) for name, rate in self.rates[stage][figure].items())

    def setup_s(self, stage: str, counts: Counts) -> float:
        """CPU seconds before the work starts. Each shard of a stage spends them again."""
        if stage not in DIVIDED:
            return self.loading_s(stage, counts)
        return self.predict(stage, "cpu_s", dataclasses.replace(counts, shards=10**15))

    def loading_s(self, stage: str, counts: Counts) -> float:
        """CPU seconds of starting and reading the scene."""
        rates = self.rates[stage]["cpu_s"]
        return rates.get("start", 0) + rates.get("triangles", 0) * counts.triangles


def load(file: pathlib.Path = MODEL) -> Model:
    """Raises output_guard.Refused if the file is no cost model."""
    try:
        rates = json.loads(pathlib.Path(file).read_text())["rates"]
        known = rates.keys() >= TERMS.keys()
    except (ValueError, KeyError, TypeError, AttributeError):
        known = False
    if not known:
        raise output_guard.Refused(
            f"{file}: is no cost model such as pipelines/cost_model.json; name another file"
        )
    return Model(rates)
