"""Says whether two renderers agree, and prints the stored figures as a table."""

from __future__ import annotations

from typing import Any

import numpy as np

from cases import CASES


def verdict(figures: dict[str, Any], tolerance: float) -> str:
    """agrees, differs, or noisy, where the error bar is too wide for either."""
    ratio, error = figures["mean"]["ratio"], figures["mean"]["error"]
    error = 0.0 if error is None else np.hypot(error, figures.get("expected_error", 0.0))
    difference = None if ratio is None else abs(ratio - figures.get("expected", 1.0))
    if difference is None or difference > tolerance + 3.0 * error:
        return "differs"
    if 2.0 * error > tolerance:
        return "noisy"
    return "agrees" if difference <= tolerance else "differs"


def table(results: dict[str, Any]) -> str:
    heads = (
        "case",
        "view",
        "ours",
        "Cycles",
        "ratio",
        "standard error",
        "expected",
        "blocks: mean z²",
    )
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for case in (case.name for case in CASES if case.name in results):
        for view, figures in results[case]["views"].items():
            mean, z2 = figures["mean"], figures["blocks"]["mean_square_z"]
            ratio, error = (
                "-" if mean[key] is None else f"{mean[key]:.4f}" for key in ("ratio", "error")
            )
            lines.append(
                f"| {case} | {view} | {mean['ours']:.4g} | {mean['cycles']:.4g} "
                f"| {ratio} | {error} | {figures.get('expected', 1.0):.4f} | {z2:.2f} |"
            )
    return "\n".join(lines)
