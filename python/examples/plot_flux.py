#!/usr/bin/env python3
"""Plots what lit VPLs emit, over the scene: radiant exitance, and the relative error of the flux.

plot_flux.py lit.vpl flux.png
"""

import sys

import matplotlib
import numpy as np

import bnvpl

matplotlib.use("Agg")  # writes files and opens no window
import matplotlib.pyplot as plt  # noqa: E402

ELEVATION, AZIMUTH = np.radians(12), np.radians(-75)  # where the viewer stands

lit = bnvpl.read_vpl(sys.argv[1])
share = 2 * np.sqrt(3) * lit.radius**2  # the surface that each VPL stands for
exitance = lit.flux.mean(axis=1) / share
# Matplotlib draws z upwards, these scenes y.
to_plot = np.array([[-1, 0, 0], [0, 0, 1], [0, 1, 0]])
place, normal = lit.position @ to_plot.T, lit.normal @ to_plot.T
viewer = [
    np.cos(ELEVATION) * np.cos(AZIMUTH),
    np.cos(ELEVATION) * np.sin(AZIMUTH),
    np.sin(ELEVATION),
]
facing = normal @ viewer > 0

figure = plt.figure(figsize=(11, 5), layout="constrained")
for column, values, title in (
    (1, exitance, "radiant exitance, W per unit of area"),
    (2, lit.relative_error, "relative error of the flux"),
):
    low, high = np.quantile(values[values > 0], [0.01, 0.99])
    axes = figure.add_subplot(1, 2, column, projection="3d")
    dots = axes.scatter(
        *place[facing].T,
        c=np.maximum(values[facing], low),
        norm=matplotlib.colors.LogNorm(low, high, clip=True),
        cmap="inferno",
        s=16,
        depthshade=False,
    )
    axes.set_box_aspect(np.ptp(place, axis=0), zoom=1.1)
    axes.view_init(np.degrees(ELEVATION), np.degrees(AZIMUTH))
    axes.set(xlabel="-x", ylabel="z", zlabel="y", title=title)
    figure.colorbar(dots, shrink=0.7)
figure.savefig(sys.argv[2], dpi=80)
