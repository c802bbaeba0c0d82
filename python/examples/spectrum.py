#!/usr/bin/env python3
"""Plots the spectra of VPLs on the wall that faces +x: blue noise beside random choice.

    spectrum.py vpls.vpl random.vpl spectrum.png

The power of n points at a frequency f is |sum exp(-2 pi i f p)|^2 / n. Points that know nothing of
each other have 1 on average, at all frequencies. Blue noise has next to none at low ones: what such
VPLs get wrong is as small as their spacing, and makes no blotches.
"""

import sys

import matplotlib
import numpy as np

import bnvpl

matplotlib.use("Agg")  # writes files and opens no window
import matplotlib.pyplot as plt  # noqa: E402


def points_on_wall(file):
    """Points in units of the wall's sides, and these sides."""
    vpls = bnvpl.read_vpl(file)
    wall = vpls.position[vpls.normal[:, 0] > 0.999][:, 1:]
    sides = np.ptp(wall, axis=0)
    return (wall - wall.min(axis=0)) / sides, sides


def radial_spectrum(points, sides, bins=60, highest=3):
    """Mean power in rings of frequencies, and these frequencies, in units of 1 / spacing.

    At whole periods along both sides a constant density has no power, so the wall's rim adds none.
    """
    spacing = np.sqrt(np.prod(sides) / len(points))
    periods = np.arange(-int(highest * max(sides) / spacing), int(highest * max(sides) / spacing))
    waves = [np.exp(-2j * np.pi * np.outer(periods, points[:, axis])) for axis in (0, 1)]
    power = abs(waves[0] @ waves[1].T) ** 2 / len(points)
    frequency = np.hypot(*np.meshgrid(*(periods / side for side in sides), indexing="ij")) * spacing
    edges = np.linspace(0, highest, bins + 1)
    ring = np.digitize(frequency, edges) - 1
    ring[frequency == 0] = -1  # has the number of points
    rings = [k for k in range(bins) if (ring == k).any()]
    return edges[rings] + highest / bins / 2, [power[ring == k].mean() for k in rings]


figure, axes = plt.subplots(1, 3, figsize=(12, 4), layout="constrained", width_ratios=[1, 1, 1.4])
for plot, file, name in zip(axes, sys.argv[1:3], ("blue noise", "random"), strict=False):
    points, sides = points_on_wall(file)
    plot.scatter(*(points * sides)[:, ::-1].T, s=5, color="black")
    plot.set(title=f"{name}, {len(points)} VPLs", aspect="equal", xlabel="z", ylabel="y")
    axes[2].plot(*radial_spectrum(points, sides), label=name)
axes[2].axhline(1, color="grey", linewidth=0.5)
axes[2].set(title="radial power", xlabel="frequency, 1 / mean spacing", ylim=(0, None))
axes[2].legend()
figure.savefig(sys.argv[3], dpi=80)
