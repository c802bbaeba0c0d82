# SPDX-License-Identifier: GPL-3.0-or-later
"""The text of a scene.toml (docs/scene-format.md) from sections of plain values."""

from __future__ import annotations

import json
from collections.abc import Sequence

Vector = Sequence[float]
Value = str | bool | int | float | Vector
Section = dict[str, Value]


def _number(value: float) -> str:
    """Nine digits give every float of Blender back."""
    return str(value) if isinstance(value, int) else format(value, ".9g")


def _value(value: Value) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return _number(value)
    return "[" + ", ".join(_number(v) for v in value) + "]"


def scene_text(sections: Sequence[tuple[str, Section]]) -> str:
    """The file: each section with its heading, such as "[film]" or "[[light]]"."""
    blocks = [
        "\n".join([heading, *(f"{key} = {_value(value)}" for key, value in section.items())])
        for heading, section in sections
    ]
    return "\n\n".join(blocks) + "\n"
