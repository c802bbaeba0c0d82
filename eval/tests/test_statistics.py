"""Tests that bias, noise and the reference's noise are separated, on images of known errors."""

import sys
import unittest
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bnvpl_eval import statistics  # noqa: E402 (after the path that it needs)

SHAPE = (120, 160, 3)


class KnownErrors(unittest.TestCase):
    def setUp(self) -> None:
        self.random = np.random.default_rng(7)
        self.truth = self.random.uniform(0.5, 1.5, SHAPE)
        noise = self.random.normal(0, 0.2, (2, *SHAPE))
        self.halves = (self.truth + noise[0], self.truth + noise[1])

    def judged(self, bias: float, noise: float, seeds: int = 8) -> dict[str, Any]:
        made = [self.truth + bias + self.random.normal(0, noise, SHAPE) for _ in range(seeds)]
        return statistics.summarise(made, self.halves)

    def test_noise_alone(self) -> None:
        found = self.judged(0.0, 0.1)
        self.assertAlmostEqual(found["std_over_mean"], 0.1, delta=0.003)
        # The noise of the reference, 0.2 / sqrt 2, must not add to it.
        self.assertAlmostEqual(found["rmse_over_mean"], 0.1, delta=0.005)
        self.assertLess(found["bias_over_mean"], 0.02)
        self.assertAlmostEqual(found["mean_ratio"], 1.0, delta=0.003)

    def test_bias_alone(self) -> None:
        found = self.judged(0.3, 0.0)
        self.assertAlmostEqual(found["bias_over_mean"], 0.3, delta=0.005)
        self.assertAlmostEqual(found["std_over_mean"], 0.0, delta=1e-9)
        self.assertAlmostEqual(found["mean_ratio"], 1.3, delta=0.003)

    def test_both(self) -> None:
        found = self.judged(0.2, 0.3)
        self.assertAlmostEqual(found["bias_over_mean"], 0.2, delta=0.01)
        self.assertAlmostEqual(found["std_over_mean"], 0.3, delta=0.005)
        self.assertAlmostEqual(
            found["rmse_over_mean"] ** 2,
            found["bias_over_mean"] ** 2 + found["std_over_mean"] ** 2,
            delta=1e-6,
        )
        self.assertAlmostEqual(
            found["relmse"], found["relmse_bias"] + found["relmse_variance"], delta=1e-6
        )

    def test_reference_halves(self) -> None:
        self.assertAlmostEqual(
            self.judged(0, 0)["reference_half_difference"], 0.2 * np.sqrt(2), delta=0.005
        )

    def test_one_seed_has_no_noise_to_tell(self) -> None:
        self.assertNotIn("std_over_mean", self.judged(0.1, 0.1, seeds=1))

    def test_slope(self) -> None:
        self.assertAlmostEqual(statistics.slope([1, 10, 100], [8, 0.8, 0.08]), -1.0, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
