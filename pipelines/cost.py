"""What a task takes: CPU seconds, memory and the size of its file, by counts; the model behind farm.py.

A figure of a stage is a sum of terms, each a rate times a function of counts. bench/cost_model.py fits the rates to
measured runs and writes cost_model.json; here are the terms, and what evaluates them.
"""

import dataclasses
import json
import math
import pathlib
import re

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
    shards: int = 1  # a task does one part of so many; a merge reads so many files

    @property
    def share(self):
        return 1 / self.shards


def count(text):
    """Of 3k, 10M or 1G. Raises ValueError."""
    match = re.fullmatch(r"(\d+(?:\.\d+)?)([kMG]?)", text)
    if not match:
        raise ValueError(f"'{text}' is no count such as 3k, 10M or 1G")
    return float(match[1]) * {"": 1, "k": 1e3, "M": 1e6, "G": 1e9}[match[2]]


def with_shards(whole, stage, shards):
    """Counts of one task of a stage, or of its merge, where {stage: count} shards are wanted."""
    return dataclasses.replace(whole, shards=shards.get(stage.removeprefix("merge-"), 1))


def depth(n):
    """Levels of a tree over n things."""
    return math.log2(max(2, n))


def pairs(c):
    """Candidates times competitors of each, in the steps of stepsFor() (tools/eliminate/elimination)."""
    steps = [max(1.0, c.vpls)]
    while (each := c.candidates / steps[-1]) > 60 and each * c.candidates > 2**22:
        steps.append(30 * steps[-1])
    left = [c.candidates, *reversed(steps[1:])]
    return sum(before**2 / kept for before, kept in zip(left, reversed(steps)))


def pilots(c):
    """Samples by which --allocate finds its marginal cost, the same of any film that has so many tiles."""
    return 4 * min(c.pixels, 48 * 64)


# {stage: {figure: {term: function of counts}}}. What is multiplied by the share is divided among shards; the rest is
# what every shard does again.
TERMS = {
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
    """Predicts by rates, {stage: {figure: {term: rate}}}."""

    def __init__(self, rates):
        self.rates = rates

    def predict(self, stage, figure, counts):
        terms = TERMS[stage][figure]
        return sum(rate * terms[name](counts) for name, rate in self.rates[stage][figure].items())

    def setup_s(self, stage, counts):
        """CPU seconds before the work: of a stage in shards, those that each shard takes again."""
        if stage not in DIVIDED:
            return self.loading_s(stage, counts)
        return self.predict(stage, "cpu_s", dataclasses.replace(counts, shards=10**15))

    def loading_s(self, stage, counts):
        """CPU seconds of starting and reading the scene."""
        rates = self.rates[stage]["cpu_s"]
        return rates.get("start", 0) + rates.get("triangles", 0) * counts.triangles


def load(file=MODEL):
    return Model(json.loads(pathlib.Path(file).read_text())["rates"])
