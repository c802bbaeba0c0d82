"""Tests the table of docs/field.md."""

import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import field_page  # noqa: E402 (after the path that it needs)
from bnvpl_eval import output  # noqa: E402


def row(gather: str, at: str, vpls: int, relmse: float, **more: Any) -> dict[str, Any]:
    made: dict[str, Any] = {
        "film": "24x18",
        "scene": "a room",
        "gather": gather,
        "compensate": "none",
        "at": at,
        "vpls": vpls,
        "relmse": relmse,
        "relmse_error": 0.01,
        "spp": 1,
        "render_cpu_s": vpls / 100,
        "mean_ratio": 0.97,
        "shadow_rays": vpls / 10,
    }
    return made | more


class FieldPage(unittest.TestCase):
    def table(self, *rows: dict[str, Any]) -> list[list[str]]:
        lines = field_page.table(list(rows)).splitlines()
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]

    def test_the_least_error_and_those_within_its_noise_are_bold(self) -> None:
        made = self.table(
            row("a", "equal time", 1000, 0.30),
            row("b", "equal time", 1000, 0.315),
            row("c", "equal time", 1000, 0.33),
        )
        self.assertEqual([cells[1] for cells in made[2:]], ["**0.3**", "**0.315**", "0.33"])

    def test_each_compensation_has_its_own_column(self) -> None:
        made = self.table(
            row("a", "equal time", 1000, 0.3, compensate="near-field"),
            row("a", "equal time", 1000, 0.1),
            row("a", "equal time", 1000, 0.2, compensate="kollig-keller"),
            row("b", "equal time", 1000, 0.4),
        )
        self.assertEqual(made[0][1:3], ["a room, none", "a room, near-field"])
        self.assertEqual([cells[1:3] for cells in made[2:]], [["**0.1**", "**0.3**"], ["0.4", "-"]])

    def test_what_a_gather_spends_is_that_at_equal_vpls(self) -> None:
        made = self.table(
            row("a", "equal VPLs", 1000, 0.3),
            row("a", "equal VPLs", 10_000, 0.3),
            row("a", "equal time", 10_000, 0.2),
        )
        self.assertEqual(made[2], ["a", "**0.2**", "-", "1000"])

    def test_gathers_without_a_row_have_their_error_at_few_vpls(self) -> None:
        rows = [
            row("a", "equal time", 1000, 0.3),
            row("b", "equal VPLs", 1000, 0.4),
            row("b", "equal VPLs", 10_000, 0.1),
            row("tilecuts", "equal VPLs", 1000, 0.5),
            row("tilecuts", "equal time", 1000, 0.3),
        ]
        text = field_page.table(rows, ["a", "b", "c", "tilecuts"])
        _, few = text.split("\n\nToo slow for this time: b, c. Beside the default, with 1,000 VPLs,")
        self.assertEqual(
            few.splitlines()[3:],
            [
                "| gather | a room |",
                "|---|---|",
                "| tilecuts | 0.5 (10) |",
                "| b | 0.4 (10) |",
            ],
        )

    def test_the_widest_films_are_shown(self) -> None:
        made = self.table(
            row("a", "equal time", 1000, 0.3), row("a", "equal time", 1000, 0.1, film="8x6")
        )
        self.assertEqual(made[2][1], "**0.3**")

    def test_rows_of_a_scene_replace_those_of_an_earlier_run(self) -> None:
        def found(scene: str, film: str, relmse: float, part: str = "field") -> dict[str, Any]:
            one = row("a", "equal time", 1000, relmse, scene=scene, film=film, part=part)
            return {"results": [one], "provenance": {"commit": "abc", "date": "2026-01-01"}}

        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "field.csv"
            with mock.patch.object(field_page, "ROWS", file):
                for results in (
                    found("hall", "8x6", 0.1),
                    found("hall", "24x18", 0.2),
                    found("attic", "24x18", 0.3),
                    found("hall", "24x18", 0.4),
                    found("attic", "24x18", 9.0, "methods"),
                ):
                    rows = field_page.merged(field_page.read(), field_page.kept(results))
                    output.write_csv(file, rows)
                shown = [(r["scene"], r["film"], r["relmse"]) for r in field_page.read()]
        self.assertEqual(
            shown, [("hall", "8x6", 0.1), ("attic", "24x18", 0.3), ("hall", "24x18", 0.4)]
        )

    def test_a_size_without_equal_time_has_no_table(self) -> None:
        with self.assertRaisesRegex(SystemExit, "no row at equal time"):
            field_page.table([row("a", "equal VPLs", 1000, 0.3)])

    def test_the_default_gather_stands_beside_itself_with_every_compensation(self) -> None:
        rows = [
            row("tilecuts", "equal time", 1000, 0.3),
            row("tilecuts", "equal time", 1000, 0.1, compensate="local"),
            row("tilecuts", "equal time", 1000, 0.2, compensate="disk", mean_ratio=0.9),
            row("b", "equal time", 1000, 0.1, compensate="disk"),
        ]
        table = field_page.table(rows).split("\n\n")[-1]
        self.assertEqual(
            table.splitlines()[2:],
            ["| none | 0.3 (0.970) |", "| local | 0.1 (0.970) |", "| disk | 0.2 (0.900) |"],
        )
        self.assertNotIn("every compensation", field_page.table(rows[:1]))


if __name__ == "__main__":
    unittest.main()
