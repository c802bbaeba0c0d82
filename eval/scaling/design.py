"""Lists the runs to which the cost model is fitted, and those that it predicts as a check."""

from typing import Any

from cost import Counts

# Triangles of the subdivided U-shape. The fitted runs span two orders of magnitude.
FEW, SOME, MANY, BETWEEN = 9_000, 100_000, 600_000, 300_000


Run = tuple[str, dict[str, int]]


def film(width: int) -> int:
    return width * (width * 3 // 4)


def place(n: int, shards: int = 1) -> Run:
    return "place", dict(candidates=n, shards=shards)


def eliminate(n: int, v: int) -> Run:
    return "eliminate", dict(candidates=n, vpls=v)


def estimate(v: int, photons: int, shards: int = 1, threads: int = 1) -> Run:
    return "estimate", dict(vpls=v, photons=photons, shards=shards, threads=threads)


def render(v: int, width: int, spp: int, shards: int = 1) -> Run:
    return "render", dict(vpls=v, pixels=film(width), spp=spp, shards=shards)


def merge(kind: str, shards: int, **counts: int) -> Run:
    return f"merge-{kind}", dict(shards=shards, **counts)


K, M = 1000, 1000_000

# Rows (scene, triangles, runs).
# fmt: off
FITTED: list[tuple[str, int, list[Run]]] = [
    ("u-shape", FEW, [
        place(1 * K), place(200 * K), place(800 * K), place(2 * M), place(2 * M, 16),
        eliminate(50 * K, 2 * K), eliminate(200 * K, 5 * K), eliminate(200 * K, 40 * K),
        eliminate(800 * K, 20 * K),
        eliminate(800 * K, 100 * K),
        estimate(1 * K, 1 * M), estimate(1 * K, 4 * M), estimate(4 * K, 1 * M),
        estimate(4 * K, 4 * M),
        estimate(20 * K, 4 * M), estimate(20 * K, 8 * M), estimate(4 * K, 4 * M, 16),
        estimate(20 * K, 4 * M, threads=2), estimate(40 * K, 4 * M, threads=2),
        estimate(20 * K, 8 * M, 16),
        render(1 * K, 80, 1), render(1 * K, 160, 1), render(1 * K, 160, 8), render(4 * K, 80, 1),
        render(4 * K, 160, 4),
        render(4 * K, 240, 1), render(20 * K, 80, 1), render(20 * K, 160, 1),
        render(20 * K, 160, 8),
        render(60 * K, 80, 1), render(60 * K, 240, 4), render(4 * K, 240, 4, 4),
        render(4 * K, 240, 4, 32),
        render(20 * K, 240, 4, 16), render(1 * K, 640, 8, 1000), render(4 * K, 640, 1, 300),
        render(4 * K, 960, 4, 500),
        render(20 * K, 480, 16, 800),
        *(merge("place", n, candidates=c) for c in (100 * K, 800 * K) for n in (4, 32)),
        *(merge("estimate", n, vpls=v, photons=200 * v) for v in (1 * K, 8 * K) for n in (4, 16)),
        *(merge("render", n, pixels=film(w),
        spp=1, vpls=1 * K) for w in (80, 480) for n in (4, 32)),
    ]),
    ("u-shape", SOME, [place(1 * K), place(800 * K), estimate(4 * K, 2 * M),
    render(4 * K, 160, 4)]),
    ("u-shape", MANY, [
        place(1 * K), place(200 * K), place(2 * M), estimate(4 * K, 1 * M), estimate(4 * K, 4 * M),
        estimate(4 * K, 4 * M, 16),
        render(4 * K, 80, 1), render(4 * K, 160, 8), render(20 * K, 160, 4),
        render(4 * K, 640, 4, 1000),
        merge("estimate", 4, vpls=1 * K, photons=200 * K),
    ]),
]

CHECKED: list[tuple[str, int, list[Run]]] = [
    ("u-shape", FEW, [
        place(4 * M), eliminate(400 * K, 10 * K), eliminate(1600 * K, 40 * K),
        eliminate(600 * K, 5 * K), estimate(2 * K, 6 * M), estimate(40 * K, 16 * M),
        render(2 * K, 320, 8), render(100 * K, 200, 4),
        merge("place", 16, candidates=2 * M), merge("estimate", 8, vpls=4 * K, photons=800 * K),
        merge("render", 16, pixels=film(320), spp=1, vpls=1 * K),
    ]),
    ("u-shape", BETWEEN, [
        place(3 * M), place(3 * M, 6), estimate(10 * K, 6 * M), estimate(10 * K, 6 * M, 8),
        render(10 * K, 200, 6),
        render(10 * K, 320, 2, 8), render(10 * K, 1280, 4, 500), render(10 * K, 640, 24, 1000),
    ]),
]
# fmt: on

# Predictions for other scenes, without the time of loading, are scaled by one short run of the
# stage in that scene.
SCALED_BY = [
    place(800 * K),
    eliminate(100 * K, 2500),
    estimate(4 * K, 2 * M),
    render(4 * K, 160, 4),
]
OTHER_RUNS = [
    place(2 * M),
    eliminate(400 * K, 10 * K),
    estimate(8 * K, 4 * M),
    render(8 * K, 240, 4),
]
OTHERS = [("cornell", 50_000), ("size", 200_000)]


def counts(triangles: int, given: dict[str, Any]) -> Counts:
    return Counts(triangles=triangles, **given)
