"""Tests how the part that compares gathers chooses its numbers of samples."""

import math
import sys
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from bnvpl_eval import equal_samples, pipeline, settings  # noqa: E402 (after the path that it needs)
from bnvpl_eval.parts import field  # noqa: E402
from bnvpl_eval.runner import TookTooLong  # noqa: E402


class FittingSamples(unittest.TestCase):
    def fitting(self, preparation_s: float, sample_s: float, time_s: float) -> int:
        return equal_samples.fitting_spp(lambda spp: preparation_s + sample_s * spp, 2, time_s)

    def test_preparations_are_not_taken_for_samples(self) -> None:
        self.assertEqual(self.fitting(1.5, 0.1, 4.0), 25)
        self.assertEqual(self.fitting(0.0, 0.5, 4.0), 8)

    def test_preparations_may_take_nearly_all_of_the_time(self) -> None:
        self.assertEqual(self.fitting(3.4, 0.3, 4.0), 2)

    def test_a_time_that_is_close_to_the_wanted_one_will_do(self) -> None:
        self.assertEqual(self.fitting(3.7, 0.1, 4.0), 4)  # 4.1 s; 3 samples take 4.0 s

    def test_fewer_samples_than_the_first_trial(self) -> None:
        self.assertEqual(self.fitting(0.0, 4.0, 4.0), 1)
        self.assertEqual(self.fitting(0.0, 20.0, 4.0), 0)

    def test_as_many_samples_as_the_first_trial_may_take_a_quarter_more(self) -> None:
        self.assertEqual(self.fitting(0.0, 2.45, 4.0), 2)
        self.assertEqual(self.fitting(0.0, 2.6, 4.0), 1)

    def test_one_sample_whose_preparations_exceed_the_time_is_left_out(self) -> None:
        self.assertEqual(self.fitting(20.0, 0.5, 12.0), 0)

    def test_samples_that_become_cheaper_fill_the_time(self) -> None:
        def cpu_s(spp: int) -> float:
            return 1.5 + 0.4 * math.pow(spp, 0.7)

        self.assertAlmostEqual(cpu_s(equal_samples.fitting_spp(cpu_s, 2, 12.0)), 12.0, delta=0.6)

    def test_samples_that_become_dearer_fill_the_time(self) -> None:
        times = {4: 16.6, 8: 45.0, 5: 23.0, 6: 31.0}
        self.assertEqual(equal_samples.fitting_spp(times.__getitem__, 4, 29.0), 6)

    def test_noise_of_two_short_trials_does_not_lead_to_endless_runs(self) -> None:
        ran: list[int] = []

        def cpu_s(spp: int) -> float:
            ran.append(spp)
            return {1: 9.0, 2: 8.9}.get(spp, 5.0 + 2.0 * spp)

        self.assertAlmostEqual(cpu_s(equal_samples.fitting_spp(cpu_s, 1, 30.0)), 30.0, delta=3.0)
        self.assertLessEqual(max(ran), 16)

    def test_no_more_than_the_limit(self) -> None:
        self.assertEqual(self.fitting(0.0, 1e-6, 4.0), equal_samples.MAX_SPP)


class NearLight(unittest.TestCase):
    def options(self, compensate: str) -> tuple[str, ...]:
        context = mock.MagicMock(size={"candidates_per_vpl": 10})
        field.Field(context).configuration(mock.Mock(), "tilecuts", compensate, 100)
        options: tuple[str, ...] = context.configuration.return_value.but.call_args.kwargs["render"]
        return options

    def test_a_kind_of_light_is_rendered_without_compensation(self) -> None:
        made = ("--gather", "tilecuts", "--compensate", "none", "--fireflies", "keep")
        self.assertEqual(self.options("none"), made)
        self.assertEqual(self.options("yuksel"), (*made, "--light", "yuksel"))

    def test_only_the_default_gather_is_paired_with_kinds(self) -> None:
        size = {"compensations": [], "gathers_with_any": ["all"], "kinds": ["disk"]}
        self.assertTrue(field.paired(size, "tilecuts", "disk"))
        self.assertFalse(field.paired(size, "tilecuts", "yuksel"))
        self.assertFalse(field.paired(size, "all", "disk"))


class Pictures(unittest.TestCase):
    def test_every_size_has_contributions_of_its_own_vpls(self) -> None:
        """Also sizes without rows at equal time, whose VPLs come from the lights."""
        _, table = settings.load()
        for name, size in table["size"].items():
            if not name.startswith("field"):
                continue
            context = mock.MagicMock(size=size)
            row = {"gather": "all", "compensate": "none", "at": "equal VPLs", "vpls": 10}
            row |= {"mean_ratio": 1.0, "relmse": 0.1, "seeds": 1, "images": ["a.exr"]}
            with (
                mock.patch.object(pipeline, "contributions") as contributions,
                mock.patch.object(field, "mean_reference"),
            ):
                field.add_pictures(context, mock.Mock(), [row])
            contributions.assert_called_once()
            context.configuration.assert_called_once_with(mock.ANY, size.get("method", "local"))
            vpls = context.configuration.return_value.but.call_args.kwargs["vpls"]
            self.assertIn(vpls, size["vpls"], name)


class TooSlow(unittest.TestCase):
    def test_no_trial_is_run_where_one_sample_would_exceed_the_time(self) -> None:
        size = {"equal_time_vpls": 10_000, "candidates_per_vpl": 10, "time_s": 4.0}
        context = mock.Mock(size=size)
        context.configuration.return_value.but.return_value = mock.Mock(vpls=10_000, spp=2)
        run = field.Field(context)
        rows = [{"vpls": n, "render_cpu_s": 0.9 * n / 1000} for n in (1000, 10_000)]
        view = mock.Mock()
        self.assertIsNone(run.at_equal_time(view, "all", "none", rows))
        self.assertEqual(len(run.skipped), 1)
        context.runner.run.assert_not_called()

    def test_what_exceeds_the_limit_is_left_out_after_one_trial(self) -> None:
        size = {"vpls": [1000, 10_000], "candidates_per_vpl": 10, "limit_s": 3.0}
        context = mock.MagicMock(size=size)
        run = field.Field(context)
        with (
            mock.patch.object(pipeline, "lit"),
            mock.patch.object(pipeline, "image", side_effect=TookTooLong) as image,
        ):
            self.assertEqual(run.at_equal_vpls(mock.Mock(), "all"), [])
        self.assertEqual((image.call_count, len(run.skipped)), (1, 1))
        context.runner.limited.assert_called_once_with("vpl-render", 3.0)


if __name__ == "__main__":
    unittest.main()
