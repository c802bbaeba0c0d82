"""Tests tables: what a person chooses, sorts and opens, and the diagrams of rows."""

from __future__ import annotations

import functools
from typing import Any

from diagrams import DIAGRAMS
from page_case import PageCase


def is_drawn(viewer: Any) -> bool:
    return bool(viewer.get_attribute("aria-busy") == "false")


class TableTest(PageCase):
    def rows(self) -> list[str]:
        """Scene and gather of the rows that are shown, in their order."""
        texts: list[str] = self.js("""
            return [...document.querySelectorAll('#table-field tbody tr:not(.group):not(.shown)')]
                .filter((row) => row.getClientRects().length > 0)
                .map((row) => row.cells[0].innerText.trim() + ' ' + row.cells[1].innerText)""")
        return texts

    def headings(self) -> list[str]:
        texts: list[str] = self.js("""
            return [...document.querySelectorAll('#table-field tr.group')]
                .filter((row) => row.getClientRects().length > 0).map((row) => row.innerText)""")
        return texts

    def choose(self, column: int, text: str) -> None:
        self.js(
            "const list = document.querySelectorAll('#table-field .filters select')[arguments[0]];"
            "list.value = arguments[1]; list.dispatchEvent(new Event('change'))",
            column,
            text,
        )

    def sort(self, column: int) -> Any:
        button = self.all("#table-field thead button")[column]
        self.js("arguments[0].click()", button)
        return self.js("return arguments[0].closest('th').getAttribute('aria-sort')", button)

    def test_filters(self) -> None:
        self.assertEqual(self.rows(), ["North a", "North b", "South a", "South wild"])
        self.choose(1, "a")
        self.assertEqual(self.rows(), ["North a", "South a"])
        self.choose(0, "South")
        self.assertEqual((self.rows(), self.headings()), (["South a"], ["South"]))
        self.choose(0, "")
        self.choose(1, "")
        self.assertEqual(len(self.rows()), 4)

    def test_one_measure_is_seen_alone(self) -> None:
        heads = [["Scene", "Gather", "RMSE", "Rays"], ["Scene", "Gather", "Rays"]]
        for value, expected in (("3", heads[1]), ("", heads[0])):
            self.choose(2, value)
            for part in ("thead", "tbody tr:not(.group)"):
                shown: list[int] = self.js(
                    "return [...document.querySelector(`#table-field ${arguments[0]}`)"
                    ".querySelectorAll('th, td')]"
                    ".filter((cell) => cell.getClientRects().length > 0)"
                    ".map((cell) => cell.cellIndex)",
                    part,
                )
                self.assertEqual([heads[0][k] for k in shown], expected)

    def test_sorting(self) -> None:
        self.assertEqual(self.sort(2), "ascending")
        self.assertEqual(self.rows(), ["South a", "North a", "North b", "South wild"])
        self.assertEqual(self.headings(), [])
        self.assertEqual(self.sort(2), "descending")
        self.assertEqual(self.rows(), ["North b", "North a", "South a", "South wild"])
        self.assertIsNone(self.sort(2))
        self.assertEqual(self.rows(), ["North a", "North b", "South a", "South wild"])
        self.assertEqual(self.headings(), ["North", "South"])

    def test_a_row_shows_its_picture(self) -> None:
        for width, scheme in ((1280, "light"), (400, "light"), (400, "dark")):
            self.open(width, scheme)
            home = self.js("return document.querySelector('#view-room-main .viewer') !== null")
            self.assertTrue(home)
            button = self.all("#table-field button.picture")[1]
            self.js("arguments[0].click()", button)
            viewer = self.all("#table-field tr.shown .viewer")[0]
            self.until(functools.partial(is_drawn, viewer))
            label = "return document.querySelector('#table-field .stage').innerText"
            self.assertIn("Image b", self.js(label))
            self.assertIn("Image reference", self.js(label))
            wide = self.js("return document.documentElement.scrollWidth")
            self.assertLessEqual(wide, width)
            self.js("arguments[0].click()", button)
            self.assertEqual(self.all("#table-field tr.shown"), [])
            self.assertEqual(len(self.all("#view-room-main .viewer")), 1)

    def test_a_diagram_stands_beside_its_text_and_on_a_phone_above_it(self) -> None:
        for width in (1280, 400):
            self.open(width, "light")
            boxes = self.js("""
                return [...document.querySelectorAll('.drawn')].map((cell) =>
                    [...cell.children].map((e) => e.getBoundingClientRect().toJSON()))""")
            self.assertEqual(len(boxes), len(DIAGRAMS))
            for drawing, text in boxes:
                edge, start = ("right", "left") if width == 1280 else ("bottom", "top")
                self.assertLess(drawing[edge], text[start])
                self.assertGreater(drawing["width"], 240)
                self.assertGreater(text["width"], 250)
                self.assertLessEqual(max(drawing["right"], text["right"]), width)

    def test_words_of_a_diagram_lie_within_it(self) -> None:
        self.assertEqual(self.words_outside("svg.diagram", above=2), [])

    def test_another_row_takes_the_viewer(self) -> None:
        first, second = self.all("#table-field button.picture")[:2]
        self.js("arguments[0].click()", first)
        self.js("arguments[0].click()", second)
        self.assertEqual(len(self.all("#table-field tr.shown")), 1)
        self.sort(2)
        self.assertEqual(self.all("#table-field tr.shown"), [])
        self.assertEqual(len(self.all("#view-room-main .viewer")), 1)
