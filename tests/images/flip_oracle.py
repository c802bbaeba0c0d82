#!/usr/bin/python3
"""Computes FLIP without separable filters, for the figures of flip_test.cpp.

    tests/images/flip_oracle.py                  # figures of the test's pattern
    tests/images/flip_oracle.py A.exr REF.exr    # figures of two images, as vpl-inspect compare

Every filter is a full two-dimensional sum in double precision. Linear input is encoded in sRGB,
which FLIP decodes again.
"""

import sys
from typing import Any

import numpy as np
import numpy.typing as npt

PPD = 3840 * np.pi / 180
XYZ = np.array(
    [
        [10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
        [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
        [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382],
    ]
)
WHITE = XYZ @ np.ones(3)


def encode(linear: npt.NDArray[Any]) -> npt.NDArray[Any]:
    curve = 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055
    return np.where(linear > 0.0031308, curve, 12.92 * linear)


def decode(srgb: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return np.where(srgb > 0.04045, ((srgb + 0.055) / 1.055) ** 2.4, srgb / 12.92)


def opponent(rgb: npt.NDArray[Any]) -> npt.NDArray[Any]:
    x, y, z = np.moveaxis(rgb @ XYZ.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def rgb_of(colour: npt.NDArray[Any]) -> npt.NDArray[Any]:
    y = (colour[..., 0] + 16) / 116
    xyz = np.stack([y + colour[..., 1] / 500, y, y - colour[..., 2] / 200], -1) * WHITE
    result: npt.NDArray[Any] = np.clip(xyz @ np.linalg.inv(XYZ).T, 0, 1)
    return result


def hunt_lab(rgb: npt.NDArray[Any]) -> npt.NDArray[Any]:
    t = rgb @ XYZ.T / WHITE
    f = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
    light = 116 * f[..., 1] - 16
    return np.stack(
        [
            light,
            light / 100 * 500 * (f[..., 0] - f[..., 1]),
            light / 100 * 200 * (f[..., 1] - f[..., 2]),
        ],
        -1,
    )


def hyab(a: npt.NDArray[Any], b: npt.NDArray[Any]) -> npt.NDArray[Any]:
    result: npt.NDArray[Any] = np.abs(a - b)[..., 0] + np.hypot((a - b)[..., 1], (a - b)[..., 2])
    return result


def convolved(plane: npt.NDArray[Any], kernel: npt.NDArray[Any]) -> npt.NDArray[Any]:
    r = kernel.shape[0] // 2
    padded = np.pad(plane, r, mode="edge")
    h, w = plane.shape
    result: npt.NDArray[Any] = sum(
        kernel[j, i] * padded[j : j + h, i : i + w]
        for j in range(2 * r + 1)
        for i in range(2 * r + 1)
    )
    return result


def sensitivity(terms: list[tuple[float, float]]) -> npt.NDArray[Any]:
    r = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi**2)) * PPD))
    x, y = np.meshgrid(np.arange(-r, r + 1) / PPD, np.arange(-r, r + 1) / PPD)
    kernel = sum(
        a * np.sqrt(np.pi / b) * np.exp(-(np.pi**2) * (x * x + y * y) / b) for a, b in terms
    )
    result: npt.NDArray[Any] = kernel / kernel.sum()
    return result


def feature_kernel(point: bool) -> npt.NDArray[Any]:
    sd = 0.5 * 0.082 * PPD
    r = int(np.ceil(3 * sd))
    x, y = np.meshgrid(np.arange(-r, r + 1), np.arange(-r, r + 1))
    kernel = (x * x / sd**2 - 1 if point else -x) * np.exp(-(x * x + y * y) / (2 * sd * sd))
    return np.where(
        kernel > 0, kernel / kernel[kernel > 0].sum(), -kernel / kernel[kernel < 0].sum()
    )


def strength(grey: npt.NDArray[Any], kernel: npt.NDArray[Any]) -> npt.NDArray[Any]:
    return np.hypot(convolved(grey, kernel), convolved(grey, kernel.T))


def ldr_flip(reference: npt.NDArray[Any], test: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """LDR-FLIP of two images in sRGB, with values from 0 to 1."""
    filters = [
        sensitivity([(1, 0.0047)]),
        sensitivity([(1, 0.0053)]),
        sensitivity([(34.1, 0.04), (13.5, 0.025)]),
    ]
    seen, features = [], []
    for image in (reference, test):
        colour = opponent(decode(image))
        parts = [convolved(colour[..., k], filters[k]) for k in range(3)]
        seen.append(hunt_lab(rgb_of(np.stack(parts, -1))))
        grey = (colour[..., 0] + 16) / 116
        features.append([strength(grey, feature_kernel(p)) for p in (False, True)])
    largest = hyab(hunt_lab(np.array([0.0, 1, 0])), hunt_lab(np.array([0.0, 0, 1]))) ** 0.7
    power, knee = hyab(*seen) ** 0.7, 0.4 * largest
    colour_error = np.where(
        power < knee, 0.95 * power / knee, 0.95 + 0.05 * (power - knee) / (largest - knee)
    )
    steps = [np.abs(features[0][p] - features[1][p]) for p in range(2)]
    result: npt.NDArray[Any] = colour_error ** (1 - np.sqrt(np.maximum(*steps) / np.sqrt(2)))
    return result


def aces(x: npt.NDArray[Any]) -> npt.NDArray[Any]:
    x = 0.6 * np.maximum(x, 0)
    result: npt.NDArray[Any] = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
    return result


def hdr_flip(
    reference: npt.NDArray[Any], test: npt.NDArray[Any], start: float, stop: float
) -> npt.NDArray[Any]:
    maps = [
        ldr_flip(encode(aces(reference * 2**ev)), encode(aces(test * 2**ev)))
        for ev in np.linspace(start, stop, max(2, int(np.ceil(stop - start))))
    ]
    result: npt.NDArray[Any] = np.max(maps, 0)
    return result


def pattern(crossed: bool) -> npt.NDArray[Any]:
    y, x, c = np.meshgrid(np.arange(24), np.arange(40), np.arange(3), indexing="ij")
    step = np.where(x < 20, 0.25, 1.0)
    result: npt.NDArray[Any] = (
        step * ((x // 3 * 7 + y // 2 * 13 + c * 5 + (x * y if crossed else 0)) % 17) / 16
    )
    return result


def load(name: str) -> npt.NDArray[Any]:
    import OpenImageIO

    image = OpenImageIO.ImageInput.open(name)
    names = list(image.spec().channelnames)
    pixels = np.asarray(image.read_image(), dtype=np.float64)
    pixels = pixels.reshape(image.spec().height, image.spec().width, -1)
    return pixels[..., [names.index(c) for c in "RGB"]]


def main() -> None:
    if len(sys.argv) == 3:
        test, reference = load(sys.argv[1]), load(sys.argv[2])
        light = reference @ np.array([0.2126, 0.7152, 0.0722])
        ev = np.round(4 * (np.log2(0.18) - np.log2(light[light > 0]).mean())) / 4
        start, stop = -4.0, 10.0
    else:
        test, reference, ev, start, stop = pattern(True), pattern(False), 0.0, -2.0, 3.0
    screen = [encode(np.clip(image * 2**ev, 0, 1)) for image in (reference, test)]
    ldr, hdr = ldr_flip(*screen), hdr_flip(reference, test, start, stop)
    print(f"LDR-FLIP at {ev:+g} EV: mean {ldr.mean():.7f}, pixels {ldr[5, 7]:.7f} {ldr[0, 39]:.7f}")
    print(f"HDR-FLIP {start:g}:{stop:g}: mean {hdr.mean():.7f}, pixel {hdr[5, 7]:.7f}")


if __name__ == "__main__":
    main()
