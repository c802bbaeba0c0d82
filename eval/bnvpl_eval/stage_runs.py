"""Runs of single stages. `options` are those of the tool beside its files."""

import sys
from pathlib import Path
from typing import Any

from .runner import Run, Runner
from .settings import ROOT

sys.path.append(str(ROOT / "pipelines"))
import commands  # noqa: E402


def placed(tools: Runner, scene: Path, *options: Any, output: str = "candidates.vpl") -> Run:
    words = commands.place("{scene}", f"@{output}", *options, "--quiet")
    return tools.run(words[0], words[1:], {"scene": scene}, [output])


def kept(tools: Runner, candidates: Path, *options: Any) -> Run:
    words = commands.eliminate("{candidates}", "@vpls.vpl", *options, "--quiet")
    return tools.run(words[0], words[1:], {"candidates": candidates}, ["vpls.vpl"])


def kept_by_rejection(tools: Runner, lit: Path, scene: Path, *options: Any) -> Run:
    more = ("--scene", "{scene}", "--method", "rejection", *options, "--quiet")
    words = commands.eliminate("{all}", "@lit.vpl", *more)
    return tools.run(words[0], words[1:], {"scene": scene, "all": lit}, ["lit.vpl"])


def estimated(tools: Runner, scene: Path, vpls: Path, *options: Any) -> Run:
    more = (*options, "--stats", "@stats.json", "--quiet")
    words = commands.estimate("{scene}", "{vpls}", "@lit.vpl", *more)
    return tools.run(words[0], words[1:], {"scene": scene, "vpls": vpls}, ["lit.vpl", "stats.json"])


def rendered(tools: Runner, scene: Path, lit: Path | None, *options: Any) -> Run:
    """`lit` is None for integrators that take no VPLs."""
    more = (*options, "--stats", "@stats.json", "--quiet")
    words = commands.render("{scene}", "{lit}" if lit else None, "@image.exr", *more)
    inputs = {"scene": scene} | ({"lit": lit} if lit else {})
    return tools.run(words[0], words[1:], inputs, ["image.exr", "stats.json"])
