"""The state of an evaluation, which every part reads and adds to."""

import sys
from dataclasses import dataclass, field
from typing import Any

import numpy.typing as npt

from . import images, pipeline, references, statistics
from .pipeline import Configuration
from .runner import Run, Runner
from .settings import Scene, View


@dataclass
class Context:
    size_name: str
    size: dict[str, Any]  # [size.*] of settings.toml
    settings: dict[str, Any]
    scenes: list[Scene]  # scenes of this size whose models are available
    runner: Runner
    title: str = "Blue-noise virtual point lights: the evaluation"
    lead: str = (
        "VPLs from the light, random VPLs from the camera, the thesis' uniform blue noise, and "
        "ours at the local density of what lights the view; judged against two independent "
        "halves of a reference."
    )
    # Each configuration of each part is a row.
    results: list[dict[str, Any]] = field(default_factory=list)
    tables: list[dict[str, Any]] = field(default_factory=list)  # tables of the report
    plots: list[dict[str, Any]] = field(default_factory=list)
    # The pictures are grouped by the view's name.
    pictures: dict[str, dict[str, Any]] = field(default_factory=dict)

    def views(self, only: str = "") -> list[View]:
        return [
            view
            for scene in self.scenes
            for view in scene.views
            if view.id in self.size["views"] and (not only or view.id == only)
        ]

    def configuration(self, view: View, method: str, width: int = 0) -> Configuration:
        """A configuration on the small film, or on one of another width in pixels."""
        vpls = max(1, round(view.scene.vpls * self.size["scale"]))
        width = width or self.size["film_width"]
        return Configuration(
            method,
            vpls,
            self.size["photons"],
            vpls * self.size["candidates_per_vpl"],
            self.size["spp"],
            view.scene.film(width),
        )

    def require_references(self) -> None:
        """Ends the program if a reference is missing, before any run starts."""
        for view in self.views():
            references.require(view, view.scene.film(self.size["film_width"]))

    def seeds(self, view: View) -> range:
        return range(1, 1 + self.size["seeds" if view.id == "main" else "second_seeds"])

    def halves(
        self, view: View, layer: str = "indirect"
    ) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
        return references.load(view, view.scene.film(self.size["film_width"]), layer)

    def judge(
        self, part: str, view: View, c: Configuration, seeds: range, **labels: object
    ) -> dict[str, Any]:
        """Runs the configuration for all seeds and adds a row to the results.

        The row holds the errors of the indirect light and of the full image, and time and peak
        memory of every stage.
        """
        made = [pipeline.image(self.runner, view, c, seed) for seed in seeds]
        row = {
            "part": part,
            "view": view.name,
            "method": c.method,
            "vpls": c.vpls,
            "photons": c.photons,
            "candidates": c.candidates,
            "spp": c.spp,
            "film": c.film,
            "seed_numbers": " ".join(map(str, seeds)),
            **pipeline.options_of(c),
            **labels,
        }
        return self.add_row(row, view, made)

    def judge_path(
        self, part: str, view: View, film: str, spp: int, seeds: range
    ) -> dict[str, Any]:
        made = [pipeline.traced(self.runner, view, film, spp, seed) for seed in seeds]
        return self.add_row(
            {"part": part, "view": view.name, "method": "path", "spp": spp, "film": film},
            view,
            made,
        )

    def add_row(self, row: dict[str, Any], view: View, made: list[Any]) -> dict[str, Any]:
        files = [file for file, _ in made]
        row |= statistics.summarise(
            [images.read(file, "indirect") for file in files], self.halves(view)
        )
        full = statistics.summarise([images.read(file) for file in files], self.halves(view, ""))
        row |= {f"full_{key}": full[key] for key in ("mean_ratio", "rmse_over_mean", "relmse")}
        for stage in range(len(made[0][1])):
            runs: list[Run] = [runs[stage] for _, runs in made]
            tool = runs[0].record["tool"].removeprefix("vpl-")
            row[f"{tool}_cpu_s"] = sum(run.cpu_s for run in runs) / len(runs)
            row[f"{tool}_wall_s"] = sum(run.record["wall_s"] for run in runs) / len(runs)
            row[f"{tool}_peak_mib"] = max(run.record["peak_mib"] for run in runs)
        row["cpu_s"] = sum(value for key, value in row.items() if key.endswith("_cpu_s"))
        row["images"] = [str(file) for file in files]
        self.results.append(row)
        return row

    def say(self, text: str) -> None:
        if not self.runner.quiet:
            print(f"eval: {text}", file=sys.stderr, flush=True)
