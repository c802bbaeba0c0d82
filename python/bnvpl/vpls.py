"""VPLs in memory: named columns of equal length."""

from __future__ import annotations

import copy
import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import numpy.typing as npt

from .columns import COLUMNS, MAX_EMIT_POINTS, Array, standard_columns

NO_SCENE = "0" * 16


class _Attribute:
    """Access to a column as an attribute: vpls.flux is vpls.columns["flux"]."""

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, vpls: None, owner: type) -> _Attribute: ...
    @overload
    def __get__(self, vpls: Vpls, owner: type) -> Array: ...
    def __get__(self, vpls: Vpls | None, owner: type) -> Array | _Attribute:
        if vpls is None:
            return self
        try:
            return vpls.columns[self.name]
        except KeyError:
            raise AttributeError(f"VPLs of stage {vpls.stage} have no {self.name}") from None

    def __set__(self, vpls: Vpls, values: npt.ArrayLike) -> None:
        vpls.columns[self.name] = np.asarray(values)


@dataclass(repr=False)
class Vpls:
    """VPLs as columns: vpls.flux, or vpls["rich.lobes"] for a column of a method.

    Row i of every column belongs to the same VPL. Arrays are (n,), (n, 3), or (n, k, 3) for the k
    emission points of each VPL. They may be changed and replaced; write_vpl() checks them.
    """

    stage: str  # "candidates", "eliminated" or "lit"
    columns: dict[str, Array]
    units: dict[str, str] = field(default_factory=dict)
    scene_hash: str = NO_SCENE  # 16 hex digits, as vpl-inspect shows them
    provenance: list[dict[str, Any]] = field(default_factory=list)  # oldest stage first
    r_max: float = 0.0  # radius of uniform density, scene units; 0: unknown
    area: float = 0.0  # indirectly visible area, scene units squared; 0: unknown
    reach: float = 0.0  # distance of the photons that a VPL received, in radii; 0: not by photons
    indirect_share: float = 1.0  # the view's share of indirect light; 1: unknown
    checksum: str = ""  # the file's, as later stages record it; empty for new VPLs
    provenance_text: str = "[]"  # as it stands in the file

    position = _Attribute()
    normal = _Attribute()
    albedo = _Attribute()
    id = _Attribute()
    radius = _Attribute()
    flux = _Attribute()
    photons = _Attribute()
    relative_error = _Attribute()
    emit_position = _Attribute()
    emit_normal = _Attribute()
    first_bounce_flux = _Attribute()

    if not TYPE_CHECKING:  # checkers know the attributes, and would take any name

        def __setattr__(self, name: str, value: Any) -> None:
            """Refuses a name that no file would keep."""
            known = [*self.__dataclass_fields__, *COLUMNS]
            if name not in known:
                near = difflib.get_close_matches(name, known, 1)
                cure = f"did you mean {near[0]}?" if near else 'write vpls["mine.heat"] = ...'
                raise AttributeError(f"VPLs have no attribute {name}; {cure}")
            object.__setattr__(self, name, value)

    def __len__(self) -> int:
        return len(self.position)

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def __setitem__(self, name: str, values: npt.ArrayLike) -> None:
        self.columns[name] = np.asarray(values)

    def __repr__(self) -> str:
        lines = [f"<{len(self)} VPLs, {self.stage}, scene {self.scene_hash}"]
        for name, values in self.columns.items():
            unit = self.units.get(name, "1")
            lines.append(f"  {name:18} {str(values.shape):14} {values.dtype.name:8} {unit}")
        return "\n".join(lines) + ">"

    def take(self, rows: Any) -> Vpls:
        """A copy of the given rows in the given order: numbers, a mask or a slice."""
        return replace(
            self,
            columns={name: np.array(values[rows]) for name, values in self.columns.items()},
            units=dict(self.units),
            provenance=copy.deepcopy(self.provenance),
            checksum="",
        )


def rows_of(name: str, values: npt.ArrayLike) -> Array:
    """The values as an array of numbers, whose first axis is that of the rows."""
    try:
        array = np.asarray(values)
    except ValueError:  # lists of different lengths
        raise ValueError(f"column {name} has rows of different lengths") from None
    if array.dtype.kind not in "biuf":
        raise ValueError(f"column {name} has values that are no real numbers")
    if array.ndim == 0:
        raise ValueError(f"column {name} is one value, not a row for each VPL")
    return array


def complete(given: Mapping[str, npt.ArrayLike]) -> Vpls:
    """VPLs of some columns; the others of their stage get values that say "unknown".

    Positions and normals are needed. With flux they are lit, with radii alone eliminated, else
    candidates. Lit and eliminated VPLs need radii. An albedo of 0.5 is assumed: the renderer
    chooses samples by it, and sums nothing of it. VPLs shine from their positions unless emission
    points are given, whose normals are those of the VPLs unless given as well.
    """
    columns = {name: rows_of(name, values) for name, values in given.items()}
    stage = "lit" if "flux" in columns else "eliminated" if "radius" in columns else "candidates"
    needed = ("position", "normal") if stage == "candidates" else ("position", "normal", "radius")
    for name in needed:
        if name not in columns:
            raise ValueError(f"VPLs of stage {stage} need the column {name}")
    count = len(columns["position"])
    given_points = [columns[name] for name in ("emit_position", "emit_normal") if name in columns]
    points = given_points[0].shape[1] if given_points and given_points[0].ndim == 3 else 1
    defaults: dict[str, Array] = {
        "albedo": np.full((count, 3), 0.5, np.float32),
        "id": np.arange(count, dtype=np.uint32),
        "photons": np.zeros(count, np.uint64),
        "relative_error": np.zeros(count, np.float32),
        "emit_position": np.repeat(columns["position"][:, None], points, axis=1),
        "emit_normal": np.repeat(columns["normal"][:, None], points, axis=1),
        "first_bounce_flux": np.zeros((count, 3), np.float32),
    }
    standard = [column.name for column in standard_columns(stage)]
    whole = {name: columns[name] if name in columns else defaults[name] for name in standard}
    return Vpls(stage, {**whole, **columns})


def typed(name: str, values: npt.ArrayLike, count: int) -> Array:
    """The values as a file stores them: type, shape and order of a column of `count` rows."""
    array = rows_of(name, values)
    column = COLUMNS.get(name)
    if column is None:
        kind = {"f": "<f4", "u": "<u8" if array.dtype.itemsize > 4 else "<u4"}
        dtype, shape = kind.get(array.dtype.kind, "<u4"), (count, *array.shape[1:2])
    else:
        dtype, shape = column.dtype, (count, *column.shape)
    points = array.shape[1] if len(shape) == 3 and array.ndim == 3 else 1
    if not 1 <= points <= MAX_EMIT_POINTS:
        raise ValueError(f"column {name} has {points} points a row, not 1 to {MAX_EMIT_POINTS}")
    shape = tuple(points if size == -1 else size for size in shape)
    if array.shape != shape:
        raise ValueError(f"column {name} has the shape {array.shape}, expected {shape}")
    with np.errstate(over="ignore", invalid="ignore"):  # infinities are refused by name and row
        result = np.ascontiguousarray(array, dtype)
    if result.dtype.kind == "u" and not np.array_equal(result, array):
        raise ValueError(f"column {name} has values that {result.dtype.name} cannot hold")
    return result
