"""Renders the references: traced images in two independent halves, kept in eval/references/.

A half is the mean of renders of CHUNK samples a pixel with different seeds, so a stopped run
resumes and a stored half can take more samples. `key` hashes all that the image depends on:
content of the scene, film, samples, half, integrator. A stored reference whose key differs is
refused. `image` hashes the picture: after a stop between both files neither counts.
"""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import images, stage_runs
from .guard import guarded, output_guard
from .runner import Run, Runner
from .scene_files import digest, scene_key
from .settings import EVAL, ROOT, View

CHUNK = 2048  # samples a pixel of one render, at most
SMALL_WIDTH = 80  # pixels of the film for which settings.toml has the samples
FOLDER = EVAL / "references"
RECORD = output_guard.json_object(
    "the record of a reference", "key", "scene", "film", "spp", "half"
)


def path(view: View, film: str, half: str) -> Path:
    return FOLDER / f"{view.name}-{film}-{half}.exr"


def integrator_of(view: View, film: str) -> str:
    """The integrator of a reference: guided paths on large films, where plain ones take hours."""
    large = int(film.split("x")[0]) > SMALL_WIDTH
    return "guided" if large and view.reference_integrator == "path" else view.reference_integrator


def spp_of(view: View, film: str) -> int:
    """Samples a pixel of a half: as many in all on a large film; fewer where they are guided.

    A guided sample costs as much as some 16 to 30 plain ones.
    """
    width = max(int(film.split("x")[0]), SMALL_WIDTH)
    share = 1 / 16 if integrator_of(view, film) == "guided" else 1.0
    return math.ceil(share * view.reference_spp * (SMALL_WIDTH / width) ** 2)


def render_half(runner: Runner, view: View, film: str, spp: int, half: str) -> None:
    """Renders a half with at least `spp` samples a pixel.

    A stored half of the same scene and integrator is continued: its samples keep their weight. Its
    rounding to half floats costs 0.02 %.
    """
    target = path(view, film, half)
    stored = _stored(view, film, half)
    done = stored["spp"] if stored else 0
    if done >= spp:
        return
    chunk = math.ceil((spp - done) / math.ceil((spp - done) / CHUNK))
    # The seeds differ from those of the images that are judged.
    first_seed = stored["seeds"][1] + 2 if stored else 1000 + (half == "b")
    seeds = range(first_seed, first_seed + 2 * -(-(spp - done) // chunk), 2)
    sums = {
        layer: done * images.read(target, layer).astype(np.float64) if stored else 0.0
        for layer in ("", "indirect")
    }
    cpu_s = stored["cpu_s"] if stored else 0.0
    for seed in seeds:
        run = _render_chunk(runner, view, film, chunk, seed)
        cpu_s += run.cpu_s
        for layer in sums:
            sums[layer] = sums[layer] + chunk * images.read(run["image.exr"], layer).astype(
                np.float64
            )
    total = done + chunk * len(seeds)
    note = (
        f"bnvpl {integrator_of(view, film)}, {view.file}, {film}, {total} spp, half {half}"
    )
    images.write_half(target, {layer: sum_ / total for layer, sum_ in sums.items()}, note)
    record = {
        "key": reference_key(view, film, total, half),
        "scene": view.file,
        "film": film,
        "integrator": integrator_of(view, film),
        "spp": total,
        "half": half,
        "seeds": [stored["seeds"][0] if stored else first_seed, seeds[-1]],
        "cpu_s": round(cpu_s, 1),
        "image": digest(target.read_bytes()),
    }
    guarded(
        output_guard.write, target.with_suffix(".json"), json.dumps(record, indent=1) + "\n", RECORD
    )


def _guiding_vpls(runner: Runner, view: View, seed: int) -> Path:
    """VPLs that guide the paths of a reference. They change its noise, not its mean."""
    scene, count = ROOT / view.file, view.scene.vpls
    before = stage_runs.placed(runner, scene, "-n", 10 * count, "--seed", seed)
    vpls = stage_runs.kept(runner, before["candidates.vpl"], "-n", count)
    return stage_runs.estimated(runner, scene, vpls["vpls.vpl"], "--seed", seed)["lit.vpl"]


def _render_chunk(runner: Runner, view: View, film: str, spp: int, seed: int) -> Run:
    inputs = {"scene": ROOT / view.file}
    if integrator_of(view, film) == "guided":
        inputs["lit"] = _guiding_vpls(runner, view, seed)
    return runner.run(
        "vpl-render",
        [
            *(f"{{{name}}}" for name in inputs),
            "--size",
            film,
            "--integrator",
            integrator_of(view, film),
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
        inputs,
        ["image.exr"],
    )


def _stored(view: View, film: str, half: str) -> dict[str, Any] | None:
    """Record of a stored half, if its scene, integrator and picture match."""
    image = path(view, film, half)
    record_file = image.with_suffix(".json")
    if not (image.is_file() and record_file.is_file()):
        return None
    record: dict[str, Any] = json.loads(record_file.read_text())
    if record["key"] != reference_key(view, film, record["spp"], half):
        return None
    return record if record["image"] == digest(image.read_bytes()) else None


def reference_key(view: View, film: str, spp: int, half: str) -> str:
    """Key of a reference. It names the integrator only where that is not the path tracer."""
    what = [scene_key(ROOT / view.file), film, spp, half]
    if integrator_of(view, film) != "path":
        what.append(integrator_of(view, film))
    return digest(json.dumps(what).encode())


def require(view: View, film: str) -> dict[str, Any]:
    """Records of both halves. Ends the program where one is missing or has another key."""
    records = {}
    cure = f"eval/references.py --film-width {film.split('x')[0]} {view.name}"
    for half in "ab":
        file = path(view, film, half)
        if not (file.is_file() and file.with_suffix(".json").is_file()):
            raise SystemExit(f"eval: {file}: no such reference; make it with '{cure}'")
        record = _stored(view, film, half)
        if record is None:
            raise SystemExit(
                f"eval: {file}: made from another version of {view.file}, by another integrator, "
                f"or not to its end; run '{cure}'"
            )
        records[half] = record
    return records


def load(view: View, film: str, layer: str) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Both halves. They are not checked; require() does that once, as hashing a model is slow."""
    halves = [images.read(path(view, film, half), layer) for half in "ab"]
    return halves[0], halves[1]


def half_difference(halves: tuple[npt.NDArray[Any], npt.NDArray[Any]]) -> float:
    """RMS difference of the halves over the mean: twice the error of the mean of both."""
    a, b = (half.astype(np.float64) for half in halves)
    return float(np.sqrt(np.mean((a - b) ** 2)) / np.mean((a + b) / 2))
