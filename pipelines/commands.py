"""The commands of the four stages as lists of words, for all programs that run them.

Each begins with the name of its tool. `more` are further options of the tool.
"""

from typing import Any


def place(scene: Any, output: Any, *more: Any) -> list[Any]:
    return ["vpl-place", scene, "-o", output, *more]


def eliminate(candidates: Any, output: Any, *more: Any) -> list[Any]:
    return ["vpl-eliminate", candidates, "-o", output, *more]


def estimate(scene: Any, vpls: Any, output: Any, *more: Any) -> list[Any]:
    return ["vpl-estimate", scene, vpls, "-o", output, *more]


def render(scene: Any, lit: Any, output: Any, *more: Any) -> list[Any]:
    """`lit` is a file of lit VPLs, or None for integrators that take none."""
    return ["vpl-render", scene, *([] if lit is None else [lit]), "-o", output, *more]


def merge(shards: list[Any], output: Any, *more: Any) -> list[Any]:
    return ["vpl-merge", *shards, "-o", output, *more]
