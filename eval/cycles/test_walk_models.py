#!/usr/bin/python3
"""Tests the material models and bent normals that walk.py compares.

python3 eval/cycles/test_walk_models.py
"""

from __future__ import annotations

import sys
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

sys.path.insert(0, str(Path(__file__).resolve().parent))

import bent_normals  # noqa: E402
import directions  # noqa: E402
import scatter_models  # noqa: E402


class Models(unittest.TestCase):
    def both(
        self, scatter: scatter_models.Scatter, cosine: float = 0.6, inside: bool = False
    ) -> npt.NDArray[Any]:
        """Scattered share of the light by our model and by that of Cycles, over all channels."""
        u = np.random.default_rng(3).random((1 << 15, 4))
        wo = np.tile([np.sqrt(1 - cosine**2), 0.0, cosine], (len(u), 1))
        result: npt.NDArray[Any] = scatter(wo, np.full(len(u), inside), u)[1].mean(axis=(0, 2))
        return result

    def test_smooth_facets_lose_nothing_and_are_the_same(self) -> None:
        for scatter in (scatter_models.conductor(1e-3), scatter_models.dielectric(1e-3, 1.5)):
            np.testing.assert_allclose(self.both(scatter), [1.0, 1.0], atol=1e-3)

    def test_rough_metal_loses_what_the_theory_page_says(self) -> None:
        for alpha, lost in (
            (0.2, 0.05),
            (0.5, 0.31),
            (1.0, 0.67),
        ):  # values of ggx/theory.md at 27 degrees
            ours, cycles = self.both(scatter_models.conductor(alpha), np.cos(np.radians(27)))
            self.assertAlmostEqual(1 - ours, lost, delta=0.02)
            self.assertLess(cycles, ours)

    def test_a_white_base_below_our_coat_returns_all(self) -> None:
        self.assertAlmostEqual(
            self.both(scatter_models.coated(0.3, 1.5, (1, 1, 1)))[0], 1.0, delta=0.015
        )

    def test_gltf_never_returns_more_than_arrives(self) -> None:
        for cosine in (0.05, 0.3, 1.0):
            scatter = scatter_models.metallic_roughness((1, 1, 1), 0.0, 0.4)
            self.assertLess(self.both(scatter, cosine)[0], 1.01)

    def test_a_flat_map_changes_nothing(self) -> None:
        random = np.random.default_rng(2)
        n = np.tile([0.0, 0.0, 1.0], (50, 1))
        wo, wi = (directions.cosine_direction(random.random((50, 2))) for _ in range(2))
        for bend in (bent_normals.our_bend, bent_normals.cycles_bend):
            np.testing.assert_allclose(bend(n, wo, n), n, atol=1e-9)
        np.testing.assert_allclose(bent_normals.softened(n, wi, n), 1.0)

    def test_bent_normals_mirror_the_viewer_above_the_surface(self) -> None:
        random = np.random.default_rng(4)
        n = np.tile([0.0, 0.0, 1.0], (500, 1))
        wo, normal = (directions.cosine_direction(random.random((500, 2))) for _ in range(2))
        for bend in (bent_normals.our_bend, bent_normals.cycles_bend):
            up = directions.reflected(wo, bend(normal, wo, n))[:, 2]
            self.assertGreater(up.min(), 0.0)


if __name__ == "__main__":
    unittest.main()
