"""Reads the images of vpl-render."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .columns import Array
from .layout import StrPath

ORDERS = ("RGBA", "XYZ")  # order of a layer's channels in arrays; others are sorted by name


@dataclass(repr=False)
class Image:
    """An image as layers: arrays (height, width) or (height, width, channels), top row first.

    The image itself is the layer "RGB". Others have the names that vpl-render --layers lists.
    """

    layers: dict[str, Array]
    attributes: dict[str, Any]  # from the file's header
    origin: tuple[int, int]  # pixel of the film where the layers begin: not (0, 0) for crops
    film: tuple[int, int]  # width and height of the whole film

    @property
    def provenance(self) -> list[dict[str, Any]]:
        """Records of the stages that made the image, oldest first."""
        records: list[dict[str, Any]] = json.loads(self.attributes.get("bnvpl.provenance", "[]"))
        return records

    def __getitem__(self, layer: str) -> Array:
        try:
            return self.layers[layer]
        except KeyError:
            names = ", ".join(self.layers)
            raise KeyError(f"no layer {layer}; the image has {names}") from None

    def __repr__(self) -> str:
        lines = [f"<Image, film {self.film[0]} x {self.film[1]}"]
        lines += [f"  {name:12} {values.shape}" for name, values in self.layers.items()]
        return "\n".join(lines) + ">"


def _layers_of(channels: list[str]) -> dict[str, list[str]]:
    """Channels of each layer, in order. R, G, B without a layer's name are the layer RGB."""
    layers: dict[str, list[str]] = {}
    for channel in channels:
        layer, _, component = channel.rpartition(".")
        name = layer or ("RGB" if component in ("R", "G", "B") else channel)
        layers.setdefault(name, []).append(channel)

    def place(channel: str) -> tuple[int, str]:
        component = channel.rpartition(".")[2]
        places = [order.find(component.upper()) for order in ORDERS]
        return max(places), component

    return {name: sorted(of, key=place) for name, of in layers.items()}


def read_exr(path: StrPath) -> Image:
    """Reads an OpenEXR file. Half and float channels become float32, integers uint32."""
    try:
        import OpenImageIO as oiio
    except ImportError as error:
        raise ImportError("EXR files need OpenImageIO (Debian: python3-openimageio)") from error
    os.stat(path)  # raises FileNotFoundError
    source = oiio.ImageInput.open(os.fspath(path))
    if source is None:
        raise ValueError(f"{os.fspath(path)}: cannot be read as an image: {oiio.geterror()}")
    spec = source.spec()
    names: list[str] = list(spec.channelnames)
    formats = [str(f) for f in spec.channelformats] or [str(spec.format)] * len(names)
    pixels: npt.NDArray[np.float32] | None = source.read_image(oiio.FLOAT)
    if pixels is None:
        raise ValueError(f"{os.fspath(path)}: is damaged: {source.geterror()}")
    values: dict[str, Array] = {name: pixels[:, :, c] for c, name in enumerate(names)}
    for c, (name, kind) in enumerate(zip(names, formats, strict=True)):
        if kind.startswith("uint"):
            values[name] = source.read_image(c, c + 1, oiio.UINT)[:, :, 0]
    source.close()
    layers = {
        layer: np.stack([values[c] for c in of], axis=2) if len(of) > 1 else values[of[0]].copy()
        for layer, of in _layers_of(names).items()
    }
    attributes = {str(a.name): a.value for a in spec.extra_attribs}
    return Image(layers, attributes, (spec.x, spec.y), (spec.full_width, spec.full_height))
