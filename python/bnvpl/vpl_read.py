"""Reads .vpl files. The checks and their order are those of formats/vpl/vpl_opening.cpp."""

from __future__ import annotations

import os
from typing import NoReturn

import numpy as np

from . import columns as spec
from . import layout as at
from .columns import COLUMNS, STAGES, Array
from .layout import Entry, Header, StrPath, VplError
from .vpls import Vpls

RERUN = "copy it again or rerun the tool that made it"


class _File:
    def __init__(self, path: StrPath) -> None:
        self.path = path
        if not os.path.isfile(path):
            os.stat(path)  # raises FileNotFoundError
            raise ValueError(f"{os.fspath(path)}: not a regular file; name a .vpl file")
        self.data = np.fromfile(path, np.uint8)
        self.size = len(self.data)

    def fail(self, byte: int, problem: str, cure: str = RERUN) -> NoReturn:
        raise VplError(self.path, byte, problem, cure)

    def bytes(self, begin: int, size: int) -> bytes:
        return self.data[begin : begin + size].tobytes()


def _read_header(file: _File) -> Header:
    begin = file.bytes(0, Header.SIZE)
    if begin[:8] != at.MAGIC[: len(begin)]:
        if begin[1:4] == at.MAGIC[1:4] and begin[0] & 0x7F == at.MAGIC[0] & 0x7F:
            problem = "magic damaged, as by a copy in text mode"
            file.fail(0, problem, "copy it again in binary mode")
        file.fail(0, "not a .vpl file", "check the name")
    if len(begin) < Header.SIZE:
        file.fail(len(begin), "cut short inside the header")
    header = Header.unpack(begin)
    if header.version != at.VERSION:
        newer = header.version > at.VERSION
        cure = "use the bnvpl that wrote it" if newer else "rerun vpl-place and every later stage"
        file.fail(at.VERSION_AT, f"version {header.version}, expected {at.VERSION}", cure)
    if not 1 <= header.stage <= len(STAGES):
        file.fail(at.STAGE_AT, f"unknown stage {header.stage}")
    if file.size < header.file_bytes:
        file.fail(file.size, f"cut short: {header.file_bytes} bytes were written")
    if file.size > header.file_bytes:
        file.fail(header.file_bytes, "bytes after the end")
    _check_fields(file, header)
    return header


def _check_fields(file: _File, header: Header) -> None:
    stage, count = STAGES[header.stage - 1], header.column_count
    standard = len(spec.standard_columns(stage))
    if not standard <= count <= standard + spec.MAX_EXTRA_COLUMNS:
        file.fail(
            at.COLUMNS_AT,
            f"{count} columns, a file of stage {stage} has {standard}, and at most "
            f"{spec.MAX_EXTRA_COLUMNS} of methods",
        )
    if at.entry_at(count) > file.size:
        file.fail(at.COLUMNS_AT, f"{count} columns do not fit into the file")
    if header.row_kind != 0:
        file.fail(at.KIND_AT, f"row kind {header.row_kind}, this build knows 0, points")
    if any(file.bytes(at.RESERVED_AT, Header.SIZE - at.RESERVED_AT)):
        file.fail(at.RESERVED_AT, "reserved field is not zero")
    for byte, value, problem in (
        (at.R_MAX_AT, header.r_max, "r_max is not a length"),
        (at.REACH_AT, header.reach, "reach is not zero or a positive number"),
        (at.AREA_AT, header.area, "area estimate is not an area"),
    ):
        if not 0 <= value < np.inf:
            file.fail(byte, problem)
    if not 0 <= header.indirect_share <= 1:
        file.fail(at.SHARE_AT, "share of indirect light is not 0 to 1")


def _check_extra(file: _File, entries: list[Entry], index: int) -> None:
    """Checks the entry of a method's column."""
    entry, begin = entries[index], at.entry_at(index)
    if not 1 <= entry.kind <= len(at.TYPES):
        file.fail(begin + Entry.KIND_AT, f"unknown type {entry.kind}")
    problem = spec.extra_problem(entry.name, entry.components, entry.unit)
    if problem and problem[0] == "name":
        file.fail(begin, problem[1])
    if entry.name in (other.name for other in entries[:index]):
        file.fail(begin, f"a second column {entry.name}")
    if problem:
        field = Entry.UNIT_AT if problem[0] == "unit" else Entry.COMPONENTS_AT
        file.fail(begin + field, problem[1])


def _standard_shape(stage: str, entries: list[Entry]) -> list[Entry]:
    """What the directory must say of the standard columns, but for offsets and sizes.

    It alone tells the number of emission points.
    """
    standard = spec.standard_columns(stage)
    points = 1
    for column, entry in zip(standard, entries, strict=False):
        if column.of_emit_points and 1 <= entry.components // 3 <= spec.MAX_EMIT_POINTS:
            points = entry.components // 3
            break
    return [c.entry_of(points) for c in standard]


def _check_directory(file: _File, header: Header, entries: list[Entry]) -> int:
    """Checks that counts make up the file and entries are the writer's.

    Returns where the end mark stands.
    """
    shape = _standard_shape(STAGES[header.stage - 1], entries)
    standard = len(shape)
    shape += entries[standard:]
    if header.count > file.size // sum(entry.row_bytes for entry in shape):
        file.fail(at.COUNT_AT, f"{header.count} rows do not fit into the file")
    if header.provenance_bytes > file.size:
        file.fail(at.PROVENANCE_AT, "provenance does not fit into the file")
    right, end = at.lay_out(shape, header.count, header.provenance_bytes)
    if end + len(at.END_MARK) != file.size:
        make = f"{header.count} rows make a file of {end + len(at.END_MARK)} bytes"
        file.fail(at.COUNT_AT, f"{make}, not of {file.size}")
    for i, expected in enumerate(right):
        begin, name = at.entry_at(i), expected.name
        if file.bytes(begin, Entry.SIZE) == expected.pack():
            continue
        if i < standard:
            file.fail(begin, f"directory entry is not that of column {name}")
        for field, is_, needed, what in (
            (Entry.OFFSET_AT, entries[i].offset, expected.offset, "offset"),
            (Entry.SIZE_AT, entries[i].size, expected.size, "bytes"),
        ):
            if is_ != needed:
                problem = f"{what} of column {name} {is_}, expected {needed}"
                file.fail(begin + field, problem)
        file.fail(begin, f"name or unit of column {name} is not padded with zeros")
    return end


def _check_content(file: _File, header: Header, entries: list[Entry], end: int) -> None:
    """Checks end mark, checksum and padding."""
    if file.bytes(end, len(at.END_MARK)) != at.END_MARK:
        file.fail(end, "no end mark")
    whole = at.checksum(file.bytes(0, Header.SIZE), [file.data[Header.SIZE :].data])
    if whole != header.checksum:
        file.fail(at.CHECKSUM_AT, "checksum does not match: the content is damaged")
    begins = [at.entry_at(len(entries)) + header.provenance_bytes]
    begins += [entry.offset + entry.size for entry in entries]
    for begin, next_ in zip(begins, [*(e.offset for e in entries), end], strict=True):
        used = file.data[begin:next_] != 0
        if used.any():
            file.fail(begin + int(used.argmax()), "padding is not zero")


def _column(file: _File, entry: Entry, count: int) -> Array:
    values = file.data[entry.offset : entry.offset + entry.size].view(entry.dtype)
    known = COLUMNS.get(entry.name)
    if known is not None:
        shape = tuple(entry.components // 3 if size == -1 else size for size in known.shape)
    else:
        shape = (entry.components,) if entry.components > 1 else ()
    return values.reshape(count, *shape)


def read_vpl(path: StrPath, verify: bool = True) -> Vpls:
    """Reads a .vpl file of any stage.

    `verify` reads as the tools do: checksum, padding and every value are checked. Without it only
    header and directory are, and xxhash is not needed. Raises VplError, with the byte, where the
    file is damaged.
    """
    file = _File(path)
    header = _read_header(file)
    count = header.column_count
    raw = file.bytes(Header.SIZE, count * Entry.SIZE)
    entries = [Entry.unpack(raw[i : i + Entry.SIZE]) for i in range(0, len(raw), Entry.SIZE)]
    stage = STAGES[header.stage - 1]
    for i in range(len(spec.standard_columns(stage)), count):
        _check_extra(file, entries, i)
    end = _check_directory(file, header, entries)
    if verify:
        _check_content(file, header, entries, end)
    text_at = at.entry_at(count)
    text = ""
    try:
        text = file.bytes(text_at, header.provenance_bytes).decode()
        provenance = at.parse_provenance(text)
    except UnicodeDecodeError:
        provenance = None
    if provenance is None:
        problem = "provenance is not a JSON array of objects, or is nested too deeply"
        file.fail(text_at, problem)
    columns = {entry.name: _column(file, entry, header.count) for entry in entries}
    for entry in entries if verify else ():
        bad = spec.bad_value(columns, entry.name)
        if bad:
            problem = f"column {entry.name}, row {bad[0]}: {bad[1]}"
            file.fail(entry.offset + bad[0] * entry.row_bytes, problem)
    return Vpls(
        stage,
        columns,
        {entry.name: entry.unit for entry in entries},
        f"{header.scene_hash:016x}",
        provenance,
        header.r_max,
        header.area,
        header.reach,
        header.indirect_share,
        f"{header.checksum:016x}",
        text,
    )
