"""Reads and writes EXR images as NumPy arrays (height, width, 3) of float32, top row first."""

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import OpenImageIO as oiio

from .guard import guarded, output_guard


def channel_names(layer: str) -> list[str]:
    """Channels of a layer: R, G, B for '', indirect.R, indirect.G, indirect.B for 'indirect'."""
    return [f"{layer}.{c}" if layer else c for c in "RGB"]


def read(path: Path, layer: str = "") -> npt.NDArray[Any]:
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise SystemExit(
            f"eval: {path}: cannot be read as an image ({oiio.geterror()}); delete it and rerun"
        )
    spec = source.spec()
    names = list(spec.channelnames)
    missing = [name for name in channel_names(layer) if name not in names]
    if missing:
        raise SystemExit(f"eval: {path}: has no channel {missing[0]}; it holds {', '.join(names)}")
    pixels = source.read_image(oiio.FLOAT)
    source.close()
    return np.ascontiguousarray(pixels[:, :, [names.index(name) for name in channel_names(layer)]])


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
    """Reads one channel, of shape (height, width)."""
    source = oiio.ImageInput.open(str(path))
    names = list(source.spec().channelnames) if source else []
    if name not in names:
        raise SystemExit(f"eval: {path}: has no channel {name}; it holds {', '.join(names)}")
    pixels = source.read_image(oiio.FLOAT)
    source.close()
    result: npt.NDArray[Any] = pixels[:, :, names.index(name)]
    return result
