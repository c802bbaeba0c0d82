"""The references: images traced path by path in two independent halves, kept in eval/references/.

A half is the mean of renders of CHUNK samples a pixel with different seeds: a stopped run goes on where it
was, and a stored half takes more samples. `key` names what the image depends on (scene content, film, samples, half,
integrator); a stored reference whose key differs is refused.
"""

import json
from pathlib import Path

import numpy as np

from . import images
from .guard import guarded, output_guard
from .runner import Runner, digest, scene_key
from .settings import EVAL, ROOT, View

CHUNK = 2048  # spp of one render
FOLDER = EVAL / "references"
RECORD = output_guard.json_object(
    "the record of a reference", "key", "scene", "film", "spp", "half"
)


def path(view: View, film: str, half: str) -> Path:
    return FOLDER / f"{view.name}-{film}-{half}.exr"


def render_half(runner: Runner, view: View, film: str, spp: int, half: str) -> None:
    """At least `spp` samples a pixel. A stored half of the same scene and integrator is gone on with, not begun anew: its
    samples keep their weight (that it was rounded to half floats costs 0.02 %)."""
    target = path(view, film, half)
    stored = _stored(view, film, half)
    done = stored["spp"] if stored else 0
    if done >= spp:
        return
    chunk = min(spp - done, CHUNK)
    first_seed = (
        stored["seeds"][1] + 2 if stored else 1000 + (half == "b")
    )  # away from the seeds that are judged
    seeds = range(first_seed, first_seed + 2 * -(-(spp - done) // chunk), 2)
    sums = {
        layer: done * images.read(target, layer).astype(np.float64) if stored else 0.0
        for layer in ("", "indirect")
    }
    cpu_s = stored["cpu_s"] if stored else 0.0
    for seed in seeds:
        run = runner.run(
            "vpl-render",
            [
                "{scene}",
                "--size",
                film,
                "--integrator",
                view.reference_integrator,
                "--spp",
                chunk,
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
        cpu_s += run.cpu_s
        for layer in sums:
            sums[layer] = sums[layer] + chunk * images.read(run["image.exr"], layer).astype(
                np.float64
            )
    total = done + chunk * len(seeds)
    note = (
        f"bnvpl {view.reference_integrator} tracer, {view.file}, {film}, {total} spp, half {half}"
    )
    images.write_half(target, {layer: sum_ / total for layer, sum_ in sums.items()}, note)
    record = {
        "key": reference_key(view, film, total, half),
        "scene": view.file,
        "film": film,
        "integrator": view.reference_integrator,
        "spp": total,
        "half": half,
        "seeds": [stored["seeds"][0] if stored else first_seed, seeds[-1]],
        "cpu_s": round(cpu_s, 1),
    }
    guarded(
        output_guard.write, target.with_suffix(".json"), json.dumps(record, indent=1) + "\n", RECORD
    )


def _stored(view: View, film: str, half: str) -> dict | None:
    """The record of a half that is there, if it is of this scene and integrator."""
    record_file = path(view, film, half).with_suffix(".json")
    if not record_file.is_file():
        return None
    record = json.loads(record_file.read_text())
    return record if record["key"] == reference_key(view, film, record["spp"], half) else None


def reference_key(view: View, film: str, spp: int, half: str) -> str:
    """The path tracer's, which is most scenes', goes unnamed."""
    what = [scene_key(ROOT / view.file), film, spp, half]
    if view.reference_integrator != "path":
        what.append(view.reference_integrator)
    return digest(json.dumps(what).encode())


def require(view: View, film: str) -> dict:
    """The records of both halves; ends the program where one is missing or made otherwise."""
    records = {}
    cure = f"eval/references.py --film-width {film.split('x')[0]} {view.name}"
    for half in "ab":
        file = path(view, film, half)
        if not file.is_file():
            raise SystemExit(f"eval: {file}: no such reference; make it with '{cure}'")
        records[half] = json.loads(file.with_suffix(".json").read_text())
        if records[half]["key"] != reference_key(view, film, records[half]["spp"], half):
            raise SystemExit(
                f"eval: {file}: made from another version of {view.file} or by another integrator; "
                f"run '{cure}'"
            )
    return records


def load(view: View, film: str, layer: str) -> tuple[np.ndarray, np.ndarray]:
    """Both halves. require() has looked at them: hashing a model for each image would take longer than reading it."""
    halves = [images.read(path(view, film, half), layer) for half in "ab"]
    return halves[0], halves[1]


def half_difference(halves: tuple[np.ndarray, np.ndarray]) -> float:
    """RMS of the difference of the halves over the mean. The mean of both has half of that as its error."""
    a, b = (half.astype(np.float64) for half in halves)
    return float(np.sqrt(np.mean((a - b) ** 2)) / np.mean((a + b) / 2))
