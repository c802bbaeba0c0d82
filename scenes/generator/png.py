"""Writes PNG files of 8-bit RGB in stored blocks, so that the bytes depend on no zlib version."""

import struct
import zlib
from collections.abc import Callable, Iterable

BLOCK = 65535  # maximum length of a stored block of deflate


def chunk(tag: bytes, data: bytes) -> bytes:
    body = tag + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


def stored(data: bytes) -> bytes:
    out = b"\x78\x01"
    for begin in range(0, len(data), BLOCK):
        part = data[begin : begin + BLOCK]
        last = begin + BLOCK >= len(data)
        out += struct.pack("<BHH", last, len(part), 0xFFFF - len(part)) + part
    return out + struct.pack(">I", zlib.adler32(data))


def png(width: int, height: int, colour_at: Callable[[int, int], Iterable[int]]) -> bytes:
    """The bytes of a PNG file. `colour_at(x, y)` gives sRGB bytes; row 0 is the top row."""
    rows = b"".join(
        b"\0" + bytes(c for x in range(width) for c in colour_at(x, y)) for y in range(height)
    )
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    signature = b"\x89PNG\r\n\x1a\n"
    return signature + chunk(b"IHDR", header) + chunk(b"IDAT", stored(rows)) + chunk(b"IEND", b"")
