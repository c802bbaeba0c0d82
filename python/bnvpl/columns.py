"""The columns that .vpl files of each stage have, and which values are valid in them.

The specification is formats/vpl/vpl_columns.h; formats/README.md explains every column.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .layout import TYPES, Entry

Array = npt.NDArray[Any]

STAGES = ("candidates", "eliminated", "lit")  # the first one has the number 1 in files
MAX_EMIT_POINTS = 64
MAX_EXTRA_COLUMNS = 256
MAX_EXTRA_COMPONENTS = 1024

Check = tuple[Callable[[Array, Array], Array], str]  # whether values are valid; else the problem


def _each(valid: Array) -> Array:
    """Whether all components of each value are valid."""
    return np.asarray(valid.all(axis=1))


def _unit_length(value: Array, _: Array) -> Array:
    with np.errstate(over="ignore", invalid="ignore"):
        length = np.sqrt((value * value).sum(axis=1))
        return np.asarray(np.abs(length - np.float32(1)) <= 1e-3)


_FINITE: Check = (lambda value, _: _each(np.isfinite(value)), "not a finite number")
_NOT_NEGATIVE: Check = (lambda value, _: _each(value >= 0), "negative")
FINITE = (_FINITE,)
UNIT_LENGTH = (_FINITE, (_unit_length, "not of unit length"))
FRACTION = (
    _FINITE,
    (lambda value, _: _each((value >= -1e-4) & (value <= 1.0001)), "not between 0 and 1"),
)
LENGTH = (
    _FINITE,
    (lambda value, _: _each(value > 0), "not above 0"),
    (lambda value, _: _each(value <= 4e9), "larger than any scene"),
)
ZERO_OR_MORE = (_FINITE, _NOT_NEGATIVE)
PART_OF_FLUX = (*ZERO_OR_MORE, (lambda value, flux: _each(flux >= value), "above the flux"))


@dataclass(frozen=True)
class Column:
    """A standard column. Its arrays are (n,), (n, 3) or, of emission points, (n, k, 3)."""

    name: str
    dtype: str
    width: int
    unit: str
    since: str
    checks: tuple[Check, ...] = ()
    of_emit_points: bool = False

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of a row; -1 is the number of emission points."""
        return ((-1,) if self.of_emit_points else ()) + ((self.width,) if self.width > 1 else ())

    def entry_of(self, points: int) -> Entry:
        """The entry of the directory, for a file with so many emission points."""
        components = self.width * (points if self.of_emit_points else 1)
        return Entry(self.name, 1 + TYPES.index(self.dtype), components, self.unit)


COLUMNS = {
    column.name: column
    for column in (
        Column("position", "<f4", 3, "scene unit", "candidates", FINITE),
        Column("normal", "<f4", 3, "1", "candidates", UNIT_LENGTH),
        Column("albedo", "<f4", 3, "1", "candidates", FRACTION),
        Column("id", "<u4", 1, "-", "candidates"),
        Column("radius", "<f4", 1, "scene unit", "eliminated", LENGTH),
        Column("flux", "<f4", 3, "W", "lit", ZERO_OR_MORE),
        Column("photons", "<u8", 1, "1", "lit"),
        Column("relative_error", "<f4", 1, "1", "lit", ZERO_OR_MORE),
        Column("emit_position", "<f4", 3, "scene unit", "lit", FINITE, True),
        Column("emit_normal", "<f4", 3, "1", "lit", UNIT_LENGTH, True),
        Column("first_bounce_flux", "<f4", 3, "W", "lit", PART_OF_FLUX),
    )
}


def standard_columns(stage: str) -> list[Column]:
    """The columns that every file of the stage has, in file order."""
    if stage not in STAGES:
        raise ValueError(f"stage {stage!r} is none of {', '.join(STAGES)}")
    last = STAGES.index(stage)
    return [column for column in COLUMNS.values() if STAGES.index(column.since) <= last]


def extra_problem(name: str, components: int, unit: str) -> tuple[str, str] | None:
    """Which field of a method's column is wrong, and why; nothing if none is."""
    if len(name) > 23 or not re.fullmatch(r"[a-z0-9_-]+\.[a-z0-9_-]+", name):
        return "name", (
            "a method's column needs a name such as rich.lobes: small letters, digits, _ and -, "
            "one dot, at most 23 bytes"
        )
    if not 1 <= components <= MAX_EXTRA_COMPONENTS:
        problem = f"column {name} has {components} components, not 1 to {MAX_EXTRA_COMPONENTS}"
        return "components", problem
    if not re.fullmatch(r"[ -~]{1,15}", unit):
        return "unit", f"the unit of column {name} is not 1 to 15 bytes of plain ASCII"
    return None


def bad_value(columns: Mapping[str, Array], name: str) -> tuple[int, str] | None:
    """Row and problem of the first invalid value of a column; nothing if all values are valid."""
    values = columns[name]
    if name in COLUMNS:
        checks: tuple[Check, ...] = COLUMNS[name].checks
        width = COLUMNS[name].width
    else:
        checks, width = (FINITE if values.dtype.kind == "f" else ()), 1
    flat = values.reshape(-1, width)
    failures = [(~valid(flat, columns.get("flux", flat)), text) for valid, text in checks]
    if not failures:
        return None
    failed = np.logical_or.reduce([bad for bad, _ in failures])
    if not failed.any():
        return None
    first = int(failed.argmax())
    return first // (flat.shape[0] // len(values)), next(t for bad, t in failures if bad[first])
