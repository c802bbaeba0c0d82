"""Reads and writes EXR images as NumPy arrays (height, width, 3) of float32, top row first."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

from .guard import guarded, output_guard
from .settings import ROOT

sys.path.append(str(ROOT / "python"))
import bnvpl  # noqa: E402


def channel_names(layer: str) -> list[str]:
    """Channels of a layer: R, G, B for '', indirect.R, indirect.G, indirect.B for 'indirect'."""
    return [f"{layer}.{c}" if layer else c for c in "RGB"]


def _opened(path: Path) -> bnvpl.Image:
    try:
        return bnvpl.read_exr(path)
    except (OSError, ValueError) as error:
        raise SystemExit(f"eval: {error}; delete it and rerun") from None


def read(path: Path, layer: str = "") -> npt.NDArray[Any]:
    """Reads R, G, B of the image itself, '', or of a layer."""
    image = _opened(path)
    pixels = image.layers.get(layer or "RGB")
    if pixels is None or pixels.shape[2:] != (3,):
        raise SystemExit(f"eval: {path}: has no layer {layer}; it holds {', '.join(image.layers)}")
    return pixels


def write_half(path: Path, layers: dict[str, npt.NDArray[Any]], note: str) -> None:
    """Writes half floats. `layers` maps names, '' for the image itself, to arrays (h, w, 3).

    Only an older image may be replaced.
    """
    names = [name for layer in layers for name in channel_names(layer)]
    pixels = np.ascontiguousarray(np.concatenate(list(layers.values()), axis=2), dtype=np.float32)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], oiio.HALF)
    spec.channelnames = tuple(names)
    spec.attribute("compression", "zip")
    spec.attribute("DateTime", "")  # equal images have equal bytes
    spec.attribute("ImageDescription", note)
    path.parent.mkdir(parents=True, exist_ok=True)

    def make(partial: Path) -> None:
        target = oiio.ImageOutput.create(str(partial))
        if target is None or not target.open(str(partial), spec) or not target.write_image(pixels):
            reason = target.geterror() if target else oiio.geterror()
            raise SystemExit(
                f"eval: {path}: cannot be written ({reason}); is the folder writable and the "
                "disk not full?"
            )
        target.close()

    guarded(output_guard.replace, path, output_guard.EXR, make)


def read_channel(path: Path, name: str) -> npt.NDArray[Any]:
    """Reads a layer of one channel, of shape (height, width)."""
    image = _opened(path)
    pixels = image.layers.get(name)
    if pixels is None or pixels.ndim != 2:
        raise SystemExit(f"eval: {path}: has no channel {name}; it holds {', '.join(image.layers)}")
    return pixels
