"""Makes a small report with known pixels, and a headless Chromium that shows it."""

from __future__ import annotations

import contextlib
import io
import json
import os
import subprocess
import sys
import unittest
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

from diagrams import DIAGRAMS

HERE = Path(__file__).resolve().parent
WIDTH, HEIGHT = 8, 6


@dataclass
class Made:
    returncode: int
    stderr: str


def run(script: str, *arguments: str | Path) -> Made:
    """Runs a script in a process of its own."""
    made = subprocess.run(
        [sys.executable, str(HERE / script), *map(str, arguments)], capture_output=True, text=True
    )
    return Made(made.returncode, made.stderr)


def call(main: Callable[[list[str]], int], *arguments: str | Path) -> Made:
    """Runs a script's main() in this process, as most of a process's time goes into its imports."""
    stderr = io.StringIO()
    with contextlib.redirect_stderr(stderr):
        code = main([str(a) for a in arguments])
    return Made(code, stderr.getvalue())


def write_exr(
    path: Path, pixels: npt.NDArray[Any], names: tuple[str, ...] = ("R", "G", "B")
) -> None:
    height, width, channels = pixels.shape
    spec = oiio.ImageSpec(width, height, channels, oiio.FLOAT)
    spec.channelnames = names
    target = oiio.ImageOutput.create(str(path))
    assert target and target.open(str(path), spec), oiio.geterror()
    target.write_image(pixels.astype(np.float32))
    target.close()


def write_png(path: Path, width: int, height: int, colour: tuple[int, int, int]) -> None:
    target = oiio.ImageOutput.create(str(path))
    target.open(str(path), oiio.ImageSpec(width, height, 3, oiio.UINT8))
    target.write_image(np.full((height, width, 3), colour, np.uint8))
    target.close()


def flat(r: float, g: float, b: float) -> npt.NDArray[Any]:
    return np.tile(np.array([r, g, b], np.float32), (HEIGHT, WIDTH, 1))


def wild() -> npt.NDArray[Any]:
    """Pixels with all kinds of values: zero, negative, tiny, huge."""
    values = np.random.default_rng(7).lognormal(0, 4, (HEIGHT, WIDTH, 3)).astype(np.float32)
    values[0, 0] = 0
    values[1, 2] = [-0.5, 1e-6, 2e5]
    return values


def images() -> dict[str, npt.NDArray[Any]]:
    full = flat(0.5, 0.5, 0.5)
    full[2, 3] = [0.0625, 0.125, 0.25]
    return {
        "reference": flat(0.25, 0.125, 0.0625),
        "a": flat(0.5, 0.25, 0.125),
        "b": flat(0.125, 0.0625, 0.03125),
        "wild": wild(),
        "reference-full": full,
        "a-full": full * 1.5,
    }


def views() -> list[dict[str, Any]]:
    """Two views, of which the second has no pictures."""

    def image(name: str, **layers: Any) -> dict[str, Any]:
        return {
            "id": name,
            "label": f"Image {name}",
            "caption": f"Caption of {name}.",
            "files": {"indirect": f"{name}.exr", **layers},
        }

    layers = [{"id": "indirect", "title": "Indirect light"}, {"id": "full", "title": "Full image"}]
    main: dict[str, Any] = {
        "id": "main",
        "title": "Main view",
        "note": "8x6 pixels",
        "reference": "reference",
        "exposure": 0,
        "contributions": "contributions.json",
        "layers": layers,
        "images": [
            image("reference", full={"file": "layers.exr", "layer": "full"}),
            image("a", full="a-full.exr"),
            {**image("b"), "numbers": "relMSE 0.5 of seven seeds"},
            image("wild"),
        ],
        "pictures": [
            {"id": "dots", "label": "Dots", "file": "dots.png", "caption": "VPLs."},
            {"id": "tall", "label": "Tall", "file": "tall.png"},
        ],
    }
    second = {**main, "id": "second", "title": "Second view", "first": "b", "pictures": []}
    del second["exposure"], second["contributions"]
    return [main, second]


def tables() -> list[dict[str, Any]]:
    return [
        {
            "id": "sum",
            "title": "Summary",
            "columns": [
                {"key": "set", "label": "Set"},
                {"key": "rmse", "label": "RMSE", "better": "low", "unit": "W"},
                {"key": "ratio", "label": "Ratio", "better": "one", "decimals": 3},
                {"key": "rays", "label": "Rays/s", "better": "high"},
            ]
            + [{"key": f"extra{i}", "label": f"A column that takes room {i}"} for i in range(4)],
            "rows": [
                {"group": "One", "set": "p", "rmse": 0.2, "ratio": 0.9, "rays": 10},
                {
                    "group": "One",
                    "set": "q",
                    "rmse": {"value": 0.1, "error": 0.013},
                    "ratio": 1.25,
                    "rays": 30,
                },
                {"group": "One", "set": "r", "rmse": 0.05, "ratio": 1, "unjudged": True},
                {"group": "Two", "set": "p", "rmse": None, "ratio": 2, "rays": 5},
                {"group": "Two", "set": "q", "rmse": 123456.0, "ratio": 1.01, "rays": 5},
            ],
        },
        {
            "id": "field",
            "title": "Field",
            "columns": [
                {"key": "scene", "label": "Scene"},
                {"key": "gather", "label": "Gather"},
                {"key": "rmse", "label": "RMSE", "better": "low"},
                {"key": "rays", "label": "Rays", "better": "low"},
            ],
            "filters": ["scene", "gather"],
            "rows": [
                {
                    "group": scene,
                    "scene": scene,
                    "gather": gather,
                    "rmse": rmse,
                    "rays": 7,
                    "picture": {"scene": "room", "view": view, "image": gather},
                }
                for scene, view, gather, rmse in (
                    ("North", "main", "a", 0.02),
                    ("North", "main", "b", {"value": 0.1, "error": 0.01}),
                    ("South", "second", "a", 0.004),
                    ("South", "second", "wild", None),
                )
            ],
        },
        {
            "id": "diagrams",
            "title": "Diagrams",
            "columns": [{"key": "gather", "label": "Gather"}, {"key": "text", "label": "Text"}],
            "rows": [
                {"gather": name, "text": "What it does, in many words. " * 9, "diagram": name}
                for name in DIAGRAMS
            ],
        },
    ]


def plots() -> list[dict[str, Any]]:
    return [
        {
            "id": "conv",
            "title": "Convergence",
            "caption": "Caption.",
            "x_label": "VPLs",
            "y_label": "relMSE",
            "x_log": True,
            "y_log": True,
            "series": [
                {
                    "label": f"series {i}",
                    "x": [750, 3000, 48000],
                    "y": [0.1 * (i + 1), 0.02, 0.001 * (i + 1)],
                    "slope": -1.02 + 0.1 * i,
                    "error": [0.01, 0.03, 0.0001],
                    "dash": i == 1,
                }
                for i in range(8)
            ],
        },
        {
            "id": "lin",
            "title": "Linear",
            "x_label": "radius",
            "y_label": "RMSE",
            "series": [{"label": "only", "x": [1, 2, 3], "y": [0.3, 0.1, 0.2]}],
        },
    ]


def report() -> dict[str, Any]:
    return {
        "title": "A report <of> tests",
        "lead": "First & last.\n\nSecond paragraph.",
        "provenance": {"commit": "0123abc", "options": {"spp": 8}},
        "tables": tables(),
        "scenes": [{"id": "room", "title": "Room", "views": views()}],
        "plots": plots(),
    }


def contributions() -> dict[str, Any]:
    """Three VPLs on a film of 4x3 pixels: in sight, behind a surface, and outside the film.

    The first lights the left column alone, the second all of it, the third all but the last pixel.
    """
    rows, shares = [], []
    for i in range(12):
        listed = [(1, 0.75 if i % 4 else 0.25)] + ([(2, 0.125)] if i < 11 else [])
        listed += [] if i % 4 else [(0, 0.5)]
        listed.sort(key=lambda entry: -entry[1])
        rows.append([row for row, _ in listed])
        shares.append([share for _, share in listed])
    return {
        "format": "bnvpl.contributions",
        "version": 1,
        "scene": "0123456789abcdef",
        "clamp_r_max": 2.0,
        "width": 4,
        "height": 3,
        "rows": {
            "x": [0.25, 0.75, None],
            "y": [0.5, 0.5, None],
            "in_sight": [True, False, False],
            "radiance": [0.125, 0.75, 0.125],
        },
        "pixels": {"radiance": [2.0] * 12, "rows": rows, "shares": shares},
    }


def write_report(folder: Path, change: dict[str, Any] | None = None) -> Path:
    for name, pixels in images().items():
        write_exr(folder / f"{name}.exr", pixels)
    full = images()["reference-full"]
    write_exr(
        folder / "layers.exr",
        np.concatenate([full * 9, full], axis=2),
        ("R", "G", "B", "full.R", "full.G", "full.B"),
    )
    write_png(folder / "dots.png", WIDTH // 2, HEIGHT // 2, (10, 200, 30))
    write_png(folder / "tall.png", WIDTH, HEIGHT + 26, (1, 2, 3))
    (folder / "contributions.json").write_text(json.dumps(contributions()), encoding="utf-8")
    path = folder / "report.json"
    path.write_text(json.dumps({**report(), **(change or {})}), encoding="utf-8")
    return path


def browser() -> webdriver.Chrome:
    for program in ("/usr/bin/chromium", "/usr/bin/chromedriver"):
        if not Path(program).exists():
            raise unittest.SkipTest(f"{program} is missing; install chromium and chromium-driver")
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    arguments = ["--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars"]
    if os.geteuid() == 0:
        arguments.append("--no-sandbox")
    for argument in arguments:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def to_srgb8(linear: npt.ArrayLike, ev: float = 0.0) -> list[int]:
    """The encoding of formats/image/tonemap.h."""
    v = np.clip(np.asarray(linear, np.float64) * 2.0**ev, 0, 1)
    encoded = np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)
    return [int(x) for x in np.floor(encoded * 255 + 0.5)]
