"""Packs EXR layers and PNG pictures for the page.

An HDR image is stored as half floats, times a power of two that scales its largest value to just
below 2^15, so that dark images keep their precision. The 16 bits of green, and those of red and
blue minus those of green, are predicted from their neighbours: by the median of left, above, and
left + above - corner, as in lossless JPEG. The residuals are deflated, low bytes before high bytes.
The bits of a half float are nearly its logarithm, so subtracting green leaves the hue, which is
smooth even where the light is noisy. That halves the size of a VPL image against plain deflate.
web/hdr.js decodes it.
"""

from __future__ import annotations

import base64
import math
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

from report_json import ReportError


@dataclass(frozen=True)
class HdrImage:
    width: int
    height: int
    exponent: int  # value = half * 2^exponent
    data: str  # base64


def read_layer(path: Path, layer: str) -> npt.NDArray[Any]:
    """Linear floats (height, width, 3) of a layer, whose channels are `layer`.R, or R if empty."""
    if not path.is_file():
        raise ReportError(f"{path}: no such file; render it, or correct its name in the report")
    source = oiio.ImageInput.open(str(path))
    if source is None:
        oiio.geterror()  # fetching the error removes it from OpenImageIO's queue
        raise ReportError(f"{path}: no image that can be read; render it again")
    names = list(source.spec().channelnames)
    wanted = [f"{layer}.{c}" if layer else c for c in "RGB"]
    if not set(wanted) <= set(names):
        raise ReportError(
            f"{path}: no channels {' '.join(wanted)} (it has {' '.join(names)}); "
            "name another layer, or render with --layers"
        )
    pixels: npt.NDArray[Any] | None = source.read_image(oiio.FLOAT)
    if pixels is None:
        raise ReportError(f"{path}: cut short or damaged; render it again")
    pixels = pixels[:, :, [names.index(name) for name in wanted]]
    bad = np.argwhere(~np.isfinite(pixels).all(axis=2))
    if len(bad):
        y, x = bad[0]
        raise ReportError(
            f"{path}: pixel ({x}, {y}): not finite, and {len(bad) - 1} more; see "
            "vpl-inspect check, and render it again"
        )
    return pixels


def residuals(plane: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Residuals of the predictor in 16 bits, mapped so that small ones of either sign are small."""
    p = plane.astype(np.int32)
    left, above, corner = np.zeros_like(p), np.zeros_like(p), np.zeros_like(p)
    left[:, 1:] = p[:, :-1]
    above[1:] = p[:-1]
    corner[1:, 1:] = p[:-1, :-1]
    above[0] = corner[0] = left[0]
    left[1:, 0] = corner[1:, 0] = above[1:, 0]
    high, low = np.maximum(left, above), np.minimum(left, above)
    guess = np.where(corner >= high, low, np.where(corner <= low, high, left + above - corner))
    missed = (p - guess).astype(np.int16).astype(np.int32)  # modulo 2^16
    return np.where(missed < 0, -2 * missed - 1, 2 * missed).astype(np.uint16)


def pack(pixels: npt.NDArray[Any]) -> HdrImage:
    height, width = pixels.shape[:2]
    largest = float(np.abs(pixels).max())
    exponent = math.frexp(largest)[1] - 15 if largest > 0 else 0
    scaled = np.ldexp(pixels.astype(np.float64), -exponent)
    bits = scaled.astype(np.float16).view(np.int16)
    red, green, blue = (bits[:, :, k] for k in range(3))
    planes = [residuals(plane) for plane in (green, red - green, blue - green)]
    stream = b"".join((p & 255).astype(np.uint8).tobytes() for p in planes)
    stream += b"".join((p >> 8).astype(np.uint8).tobytes() for p in planes)
    return HdrImage(width, height, exponent, base64.b64encode(zlib.compress(stream, 9)).decode())


class HdrStore:
    """Stores every image of a page once, however many views show it."""

    def __init__(self) -> None:
        self.images: list[HdrImage] = []
        self._index: dict[tuple[Path, str], int] = {}

    def add(self, path: Path, layer: str) -> int:
        key = (path, layer)
        if key not in self._index:
            self._index[key] = len(self.images)
            self.images.append(pack(read_layer(path, layer)))
        return self._index[key]


def read_png(path: Path) -> tuple[int, int, str]:
    """Width, height, and the bytes of the file as base64."""
    try:
        data = path.read_bytes()
    except OSError as e:
        raise ReportError(
            f"{path}: {e.strerror}; make it, or correct its name in the report"
        ) from e
    if data[:8] != b"\x89PNG\r\n\x1a\n" or data[12:16] != b"IHDR" or data[-8:-4] != b"IEND":
        raise ReportError(f"{path}: not a whole PNG file; make it again")
    width, height = (int.from_bytes(data[at : at + 4], "big") for at in (16, 20))
    return width, height, base64.b64encode(data).decode()
