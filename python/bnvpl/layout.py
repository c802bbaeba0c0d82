"""The bytes of .vpl files, version 5, for reader and writer. Specification: formats/README.md."""

from __future__ import annotations

import json
import os
import struct
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

StrPath = str | os.PathLike[str]

MAGIC = b"\x89VPL\r\n\x1a\n"
END_MARK = b"VPL-END\n"
VERSION = 5
ALIGN = 64
TYPES = ("<f4", "<u4", "<u8")  # the first one has the number 1 in files
# Positions of header fields.
VERSION_AT, STAGE_AT, COUNT_AT, PROVENANCE_AT = 8, 12, 16, 32
CHECKSUM_AT, COLUMNS_AT, KIND_AT, R_MAX_AT = 48, 56, 60, 64
AREA_AT, REACH_AT, SHARE_AT, RESERVED_AT = 72, 80, 88, 96
MAX_PROVENANCE_DEPTH = 64


@dataclass
class Header:
    """The first 128 bytes."""

    magic: bytes
    version: int
    stage: int
    count: int
    scene_hash: int
    provenance_bytes: int
    file_bytes: int
    checksum: int
    column_count: int
    row_kind: int
    r_max: float
    area: float
    reach: float
    indirect_share: float

    STRUCT = struct.Struct("<8s2I5Q2I4d32x")
    SIZE = STRUCT.size

    @classmethod
    def unpack(cls, data: bytes) -> Header:
        return cls(*cls.STRUCT.unpack(data))

    def pack(self) -> bytes:
        return self.STRUCT.pack(*(vars(self)[name] for name in self.__annotations__))


@dataclass(frozen=True)
class Entry:
    """An entry of the column directory, 64 bytes."""

    name: str
    kind: int  # 1 f32, 2 u32, 3 u64
    components: int
    unit: str
    offset: int = 0
    size: int = 0

    STRUCT = struct.Struct("<24s2I2Q16s")
    SIZE = STRUCT.size
    # Positions of fields.
    KIND_AT, COMPONENTS_AT, OFFSET_AT, SIZE_AT, UNIT_AT = 24, 28, 32, 40, 48

    @classmethod
    def unpack(cls, data: bytes) -> Entry:
        name, kind, components, offset, size, unit = cls.STRUCT.unpack(data)
        texts = [text.partition(b"\0")[0].decode("latin-1") for text in (name, unit)]
        return cls(texts[0], kind, components, texts[1], offset, size)

    def pack(self) -> bytes:
        name, unit = self.name.encode("latin-1"), self.unit.encode("latin-1")
        return self.STRUCT.pack(name, self.kind, self.components, self.offset, self.size, unit)

    @property
    def dtype(self) -> np.dtype[Any]:
        return np.dtype(TYPES[self.kind - 1])

    @property
    def row_bytes(self) -> int:
        return self.components * self.dtype.itemsize


def entry_at(column: int) -> int:
    return Header.SIZE + column * Entry.SIZE


def aligned(offset: int) -> int:
    return -(-offset // ALIGN) * ALIGN


def lay_out(shape: list[Entry], count: int, provenance_bytes: int) -> tuple[list[Entry], int]:
    """The directory with offsets and sizes, and where the end mark stands."""
    directory = []
    offset = aligned(entry_at(len(shape)) + provenance_bytes)
    for entry in shape:
        directory.append(replace(entry, offset=offset, size=count * entry.row_bytes))
        offset = aligned(offset + count * entry.row_bytes)
    return directory, offset


def checksum(header: bytes, rest: Iterable[bytes | memoryview]) -> int:
    """XXH3-64 of the whole file, a header and pieces, whose checksum is taken as zero."""
    try:
        import xxhash
    except ImportError as error:
        raise ImportError(
            "checksums of .vpl files need the package xxhash (Debian: python3-xxhash); "
            "read_vpl(path, verify=False) does without"
        ) from error
    state = xxhash.xxh3_64(header[:CHECKSUM_AT] + bytes(8) + header[COLUMNS_AT:])
    for piece in rest:
        state.update(piece)
    return state.intdigest()


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is no JSON")


def _depth(value: Any) -> int:
    """How many arrays and objects stand around the innermost value."""
    inner = value.values() if isinstance(value, dict) else value
    if not isinstance(value, dict | list) or not inner:
        return 0
    return 1 + max(map(_depth, inner))


def parse_provenance(text: str) -> list[dict[str, Any]] | None:
    """The records; nothing if the text is not a JSON array of objects, or is nested too deeply."""
    try:
        records = json.loads(text, parse_constant=_no_constant)
        fits = _depth(records) <= MAX_PROVENANCE_DEPTH
    except (ValueError, RecursionError):
        return None
    valid = fits and isinstance(records, list) and all(isinstance(r, dict) for r in records)
    return records if valid else None


class VplError(ValueError):
    """A damaged .vpl file, or one of another version: file, byte, problem, cure."""

    def __init__(self, path: StrPath, byte: int, problem: str, cure: str) -> None:
        super().__init__(f"{os.fspath(path)}: byte {byte}: {problem}; {cure}")
        self.path, self.byte, self.problem = Path(path), byte, problem
