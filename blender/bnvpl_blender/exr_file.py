# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the images of vpl-render: OpenEXR of scanlines, in one part, without or with ZIP.

Blender has no function that gives a script all channels of a file.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float32]
MAGIC = b"\x76\x2f\x31\x01"
# Types by their numbers in the file.
TYPES: tuple[np.dtype[Any], ...] = (np.dtype("<u4"), np.dtype("<f2"), np.dtype("<f4"))
LINES_OF_CHUNK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP


class ExrError(ValueError):
    """The file is none that vpl-render writes."""


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def _attributes(data: bytes) -> tuple[dict[str, bytes], int]:
    """Values of the header by name, and the position behind it."""
    attributes, at = {}, 8
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def _channels(data: bytes) -> list[tuple[str, np.dtype[Any]]]:
    channels, at = [], 0
    while data[at]:
        name, at = _text(data, at)
        channels.append((name, TYPES[struct.unpack_from("<i", data, at)[0]]))
        at += 16
    return channels


def _unzip(data: bytes, size: int) -> bytes:
    """Undoes ZIP: bytes are differences, those of even positions before those of odd ones."""
    if len(data) == size:
        return data
    deltas = np.frombuffer(zlib.decompress(data), np.uint8).astype(np.int64)
    deltas[1:] -= 128
    values = np.cumsum(deltas).astype(np.uint8)
    result = np.empty(size, np.uint8)
    half = (size + 1) // 2
    result[0::2], result[1::2] = values[:half], values[half:]
    return result.tobytes()


def read_exr(path: Path) -> dict[str, Array]:
    """Channels by name, each (height, width) with the top row first."""
    data = path.read_bytes()
    if data[:4] != MAGIC or data[5] & 0x1A:
        raise ExrError(f"{path}: is no OpenEXR file of scanlines in one part")
    attributes, at = _attributes(data)
    compression = attributes["compression"][0]
    if compression not in LINES_OF_CHUNK:
        raise ExrError(f"{path}: its compression {compression} is neither none nor ZIP")
    channels = _channels(attributes["channels"])
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height, lines = right - left + 1, bottom - top + 1, LINES_OF_CHUNK[compression]
    image = {name: np.empty((height, width), np.float32) for name, _ in channels}
    line_bytes = width * sum(kind.itemsize for _, kind in channels)
    for offset in struct.unpack_from(f"<{(height + lines - 1) // lines}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        count = min(lines, bottom + 1 - y)
        chunk = _unzip(data[offset + 8 : offset + 8 + size], count * line_bytes)
        position = 0
        for line in range(y - top, y - top + count):
            for name, kind in channels:
                image[name][line] = np.frombuffer(chunk, kind, width, position)
                position += width * kind.itemsize
    return image


def layer(image: dict[str, Array], name: str, components: str) -> Array:
    """A layer, (height, width, components): "" is the image itself."""
    prefix = f"{name}." if name else ""
    alone = len(components) == 1 and name in image
    names = [name] if alone else [prefix + c for c in components]
    return np.stack([image[n] for n in names], axis=2)
