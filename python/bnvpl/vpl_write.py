"""Writes .vpl files."""

from __future__ import annotations

import contextlib
import fcntl
import itertools
import json
import math
import os
import re
from pathlib import Path

from . import columns as spec
from . import layout as at
from .columns import COLUMNS, STAGES, Array
from .layout import Entry, Header, StrPath
from .vpl_target import named, replaceable
from .vpls import Vpls, rows_of, typed


_partials = itertools.count()  # numbers of the process's unfinished files


def _provenance_text(vpls: Vpls) -> str:
    """The text that was read, as long as it says the same as the records."""
    if at.parse_provenance(vpls.provenance_text) == vpls.provenance:
        return vpls.provenance_text
    text = json.dumps(vpls.provenance, ensure_ascii=False, separators=(",", ":"))
    if at.parse_provenance(text) is None:
        raise ValueError(f"provenance is no list of objects that JSON can hold: {text[:80]}")
    return text


def _columns_in_order(vpls: Vpls) -> dict[str, Array]:
    standard = [column.name for column in spec.standard_columns(vpls.stage)]
    missing = [name for name in standard if name not in vpls.columns]
    if missing:
        raise ValueError(f"VPLs of stage {vpls.stage} need the column {missing[0]}")
    extras = [name for name in vpls.columns if name not in standard]
    later = [name for name in extras if name in COLUMNS]
    if later:
        raise ValueError(f"column {later[0]} is beyond stage {vpls.stage}")
    if len(extras) > spec.MAX_EXTRA_COLUMNS:
        raise ValueError(f"more than {spec.MAX_EXTRA_COLUMNS} columns of methods")
    count = len(rows_of("position", vpls.columns["position"]))
    columns = {name: typed(name, vpls.columns[name], count) for name in standard + extras}
    points = {name: columns[name].shape[1] for name in columns if _is_of_emit_points(name)}
    if len(set(points.values())) > 1:
        counts = ", ".join(f"{name} has {number}" for name, number in points.items())
        raise ValueError(f"columns differ in their points a row: {counts}")
    return columns


def _is_of_emit_points(name: str) -> bool:
    return name in COLUMNS and COLUMNS[name].of_emit_points


def _entry(vpls: Vpls, name: str, values: Array) -> Entry:
    known = COLUMNS.get(name)
    if known is not None:
        return known.entry_of(values.shape[1] if known.of_emit_points else 1)
    components = values.shape[1] if values.ndim > 1 else 1
    unit = vpls.units.get(name, "1")
    problem = spec.extra_problem(name, components, unit)
    if problem:
        raise ValueError(problem[1])
    return Entry(name, 1 + at.TYPES.index(values.dtype.str), components, unit)


def _pieces(vpls: Vpls) -> list[bytes]:
    """The file behind its header: directory, provenance, columns, end mark."""
    columns = _columns_in_order(vpls)
    for name in columns:
        bad = spec.bad_value(columns, name)
        if bad:
            raise ValueError(f"column {name}, row {bad[0]}: {bad[1]}")
    text = _provenance_text(vpls).encode()
    shape = [_entry(vpls, name, values) for name, values in columns.items()]
    directory, _ = at.lay_out(shape, len(vpls), len(text))
    pieces = [entry.pack() for entry in directory]
    # Directory and header end at multiples of ALIGN, so that the padding of each piece is its own.
    for piece in (text, *(values.tobytes() for values in columns.values())):
        pieces += [piece, bytes(at.aligned(len(piece)) - len(piece))]
    return [*pieces, at.END_MARK]


def _header(vpls: Vpls, pieces: list[bytes]) -> bytes:
    for value, what in ((vpls.r_max, "r_max"), (vpls.area, "area"), (vpls.reach, "reach")):
        if not 0 <= value < math.inf:
            raise ValueError(f"{what} is negative or not finite")
    if not 0 <= vpls.indirect_share <= 1:
        raise ValueError("share of indirect light is not 0 to 1")
    if not re.fullmatch(r"[0-9a-fA-F]{16}", vpls.scene_hash):
        raise ValueError(f"scene_hash {vpls.scene_hash!r} is not 16 hex digits")
    header = Header(
        at.MAGIC,
        at.VERSION,
        1 + STAGES.index(vpls.stage),
        len(vpls),
        int(vpls.scene_hash, 16),
        len(_provenance_text(vpls).encode()),
        Header.SIZE + sum(map(len, pieces)),
        0,
        len(vpls.columns),
        0,
        vpls.r_max,
        vpls.area,
        vpls.reach,
        vpls.indirect_share,
    )
    header.checksum = at.checksum(header.pack(), pieces)
    return header.pack()


def contents(vpls: Vpls) -> list[bytes]:
    """The bytes of a file, in pieces. Raises ValueError where something is invalid."""
    pieces = _pieces(vpls)
    return [_header(vpls, pieces), *pieces]


def _replace(place: Path, content: list[bytes]) -> None:
    """Puts a whole file in the place of another, with its mode."""
    # The tools remove files of such a name that no process locks, as left by a killed one.
    while True:
        partial = place.with_name(f"{place.name}.partial-{os.getpid()}-{next(_partials)}")
        try:
            file = partial.open("xb")
            break
        except FileExistsError:  # a process of another machine or container has the name
            continue
    try:
        with file:
            with contextlib.suppress(OSError):  # some file systems have no locks
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            with contextlib.suppress(OSError):  # or no modes
                if place.exists():
                    os.fchmod(file.fileno(), place.stat().st_mode & 0o7777)
            file.writelines(content)
            file.flush()
            os.fsync(file.fileno())
            os.replace(partial, place)
    except BaseException:
        partial.unlink(missing_ok=True)
        raise


def save(path: StrPath, vpls: Vpls) -> None:
    """Writes VPLs, whole or not at all, as the tools do: through links, with the old file's mode.

    Raises ValueError where something is invalid, and OSError with the file's name where it cannot
    be written or is none that these VPLs may replace: see vpl_target.py.
    """
    target = Path(path)
    try:
        content = contents(vpls)
    except ValueError as error:
        raise ValueError(f"{target}: not written: {error}") from None
    place = replaceable(target, vpls.stage)
    try:
        _replace(place, content)
    except OSError as error:
        cure = "the old file, if any, is unchanged"
        raise named(error, f"{target}: write failed", cure) from error
