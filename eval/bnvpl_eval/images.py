"""EXR images as NumPy arrays: (height, width, 3) float32, top row first."""

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

from .guard import guarded, output_guard


def channel_names(layer: str) -> list[str]:
    """'' for the image itself, 'indirect' for indirect.R, indirect.G, indirect.B."""
    return [f"{layer}.{c}" if layer else c for c in "RGB"]


def read(path: Path, layer: str = "") -> np.ndarray:
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


def write_half(path: Path, layers: dict[str, np.ndarray], note: str) -> None:
    """Half floats, in place of an older image at most. `layers`: '' and others to (h, w, 3)."""
    names = [name for layer in layers for name in channel_names(layer)]
    pixels = np.ascontiguousarray(np.concatenate(list(layers.values()), axis=2), dtype=np.float32)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], oiio.HALF)
    spec.channelnames = tuple(names)
    spec.attribute("compression", "zip")
    spec.attribute("DateTime", "")  # or the bytes would tell when
    spec.attribute("ImageDescription", note)
    path.parent.mkdir(parents=True, exist_ok=True)

    def make(partial: Path) -> None:
        target = oiio.ImageOutput.create(str(partial))
        if target is None or not target.open(str(partial), spec) or not target.write_image(pixels):
            reason = target.geterror() if target else oiio.geterror()
            raise SystemExit(
                f"eval: {path}: cannot be written ({reason}); is the folder writable and the disk not full?"
            )
        target.close()

    guarded(output_guard.replace, path, output_guard.EXR, make)


def read_channel(path: Path, name: str) -> np.ndarray:
    """One channel, (height, width)."""
    source = oiio.ImageInput.open(str(path))
    names = list(source.spec().channelnames) if source else []
    if name not in names:
        raise SystemExit(f"eval: {path}: has no channel {name}; it holds {', '.join(names)}")
    pixels = source.read_image(oiio.FLOAT)
    source.close()
    return pixels[:, :, names.index(name)]
