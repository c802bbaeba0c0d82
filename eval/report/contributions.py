"""Packs a list of `vpl-inspect contributions` for the page; web/explorer.js unpacks it."""

from __future__ import annotations

import base64
import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from report_json import ReportError

NO_ROW = 0xFFFFFFFF
FORMAT = "bnvpl.contributions"


def read(path: Path) -> dict[str, Any]:
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except OSError as e:
        raise ReportError(f"{path}: {e.strerror}; make it by vpl-inspect contributions") from e
    except ValueError as e:
        raise ReportError(f"{path}: no JSON: {e}; make it by vpl-inspect contributions") from e
    if not isinstance(found, dict) or found.get("format") != FORMAT:
        raise ReportError(f"{path}: no list of contributions; make it by vpl-inspect contributions")
    if found.get("version") != 1:
        raise ReportError(
            f"{path}: version {found.get('version')}, but this page knows 1; make it again"
        )
    return found


def pack(path: Path) -> tuple[dict[str, int], str]:
    """Sizes for the page, and the data as base64.

    For each pixel the rows (u32) and their shares (f16), strongest first, filled up to equal
    length; for each row its place on the film (NaN outside) and its contribution.
    """
    found = read(path)
    try:
        return packed(found)
    except (KeyError, TypeError, ValueError, OverflowError) as e:
        raise ReportError(
            f"{path}: damaged: {type(e).__name__} {e}; make it again by vpl-inspect contributions"
        ) from e


def packed(found: dict[str, Any]) -> tuple[dict[str, int], str]:
    pixels, rows = found["pixels"], found["rows"]
    if len(pixels["rows"]) != found["width"] * found["height"]:
        raise ValueError("the lists are not as many as the pixels")
    per_pixel = max(1, *(len(listed) for listed in pixels["rows"]))
    row_of = np.full((len(pixels["rows"]), per_pixel), NO_ROW, "<u4")
    share = np.zeros(row_of.shape, "<f2")
    for i, (listed, shares) in enumerate(zip(pixels["rows"], pixels["shares"], strict=True)):
        row_of[i, : len(listed)] = listed
        share[i, : len(listed)] = shares
    data = b"".join(
        [
            row_of.tobytes(),
            floats(pixels["radiance"]),
            floats(rows["x"]),
            floats(rows["y"]),
            floats(rows["radiance"]),
            share.tobytes(),
            np.array(rows["in_sight"], np.uint8).tobytes(),
        ]
    )
    sizes = {
        "width": found["width"],
        "height": found["height"],
        "perPixel": per_pixel,
        "rows": len(rows["x"]),
    }
    return sizes, base64.b64encode(zlib.compress(data, 9)).decode()


def floats(values: list[float | None]) -> bytes:
    return np.array([np.nan if v is None else v for v in values], "<f4").tobytes()
