"""Tests of the sentences about the comparison room by room."""

import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import rooms_page  # noqa: E402 (after the path that it needs)


def row(room: str, setting: str, beside: str, share: float, times: float) -> dict[str, Any]:
    """Errors of 1 for ours, and of `times` for the other, whose FLIP is a tenth of it."""
    errors = {m: "1" for m in rooms_page.MEASURES} | {f"its_{m}": times for m in rooms_page.MEASURES}
    return {
        "room": room,
        "setting": setting,
        "light": "full",
        "beside": beside,
        "indirect_share": share,
        "cpu_s": "40",
        "its_cpu_s": "41",
        **errors,
        "its_flip": times / 10,
    }


class Facts(unittest.TestCase):
    def test_ranges_and_exceptions(self) -> None:
        rows = [
            row("hall", "default", "path", 0.9, 1234.0),
            row("attic", "default", "path", 0.5, 30.0),
            row("yard", "default", "path", 0.1, 8.0),
            row("hall", "default", "guided", 0.9, 100.0),
            row("yard", "default", "guided", 0.1, 16.0),
            row("hall", "draft", "path", 0.9, 50.0),
        ]
        text = " ".join(rooms_page.facts(rows).split())
        self.assertIn("half of the image or more, the path tracer has 30 to 1,200 times", text)
        self.assertIn("else 8 to 8 times", text)
        self.assertIn("in all views but in FLIP of yard (0.8). So is the preset `draft`, by", text)
        self.assertIn("by 50 times in relMSE and 5 in FLIP at least", text)
        self.assertIn(
            "Guided paths are ahead of the path tracer but in relMSE of yard (0.5), RMSE of yard "
            "(0.5), SMAPE of yard (0.5), FLIP of yard (0.5).",
            text,
        )

    def test_runs_of_another_time_are_left_out(self) -> None:
        fair = row("hall", "default", "path", 0.9, 4.0)
        self.assertTrue(rooms_page.at_equal_time(fair))
        self.assertTrue(rooms_page.at_equal_time(fair | {"its_cpu_s": ""}))
        for other in ("20", "60"):
            self.assertFalse(rooms_page.at_equal_time(fair | {"its_cpu_s": other}))

    def test_the_range_stands_within_its_sentence(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "README.md"
            page.write_text("A path tracer has <!-- range -->2 times<!-- end -->: there.\n")
            rooms_page.put_range(page, [row("a", "default", "path", 0.1, 3.0)])
            self.assertEqual(
                page.read_text(),
                "A path tracer has <!-- range -->3 to 3 times our relMSE in 1 views<!-- end -->: "
                "there.\n",
            )


if __name__ == "__main__":
    unittest.main()
