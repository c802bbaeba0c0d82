"""Tests the explorer of VPLs: a click on a place, and on a VPL."""

from __future__ import annotations

import json
import tempfile
import unittest
from pathlib import Path
from typing import Any

from selenium.webdriver.common.keys import Keys

import make_report
from page_case import READ_PIXEL, PageCase
from test_support import call, contributions, write_report


class ExplorerTest(PageCase):
    def setUp(self) -> None:
        super().setUp()
        self.explorer = self.all(".explorer")[0]
        self.js("arguments[0].scrollIntoView({behavior: 'instant'})", self.explorer)
        self.until(lambda: bool(self.explorer.get_attribute("aria-busy") == "false"))
        self.picture = self.explorer.find_element("css selector", ".explorer-picture")

    def click(self, x: float, y: float) -> None:
        """Clicks a place, given as shares of width and height."""
        size = self.picture.size
        self.actions().move_to_element_with_offset(
            self.picture, round((x - 0.5) * size["width"]), round((y - 0.5) * size["height"])
        ).click().perform()

    def text(self) -> str:
        return str(self.explorer.find_element("css selector", ".explorer-text").text)

    def rows(self) -> list[list[str]]:
        result: list[list[str]] = self.js(
            "return [...arguments[0].querySelectorAll('tbody tr')].map("
            "(r) => [...r.children].map((c) => c.textContent))",
            self.explorer,
        )
        return result

    def colour(self, x: float, y: float) -> list[int]:
        result: list[int] = self.js(
            "const c = arguments[0].querySelector('canvas');"
            "return readPixel(c, arguments[1] * c.width, arguments[2] * c.height);" + READ_PIXEL,
            self.picture,
            x,
            y,
        )
        return result

    def test_a_place_shows_its_vpls(self) -> None:
        self.assertIn("3 VPLs with 1 in sight", self.text())
        self.click(0.1, 0.1)
        self.assertIn("Pixel (0, 0) of 4×3: 3 VPLs contribute 87.5 % of its VPL light", self.text())
        self.assertIn("Rings: 1 behind surfaces. Outside the picture: 1.", self.text())
        self.assertEqual(
            self.rows(),
            [["0", "50.0 %", ""], ["1", "25.0 %", "hidden"], ["2", "12.5 %", "outside"]],
        )

    def test_a_vpl_shows_what_it_lights(self) -> None:
        right = self.colour(0.9, 0.9)
        self.click(0.25, 0.5)
        self.assertIn("VPL 0 contributes 12.5 % of the VPLs' light in the picture", self.text())
        self.assertIn("strongest of 3 of 12 pixels, with up to 50.0 %", self.text())
        red, green, blue = self.colour(0.1, 0.9)
        self.assertGreater(red, 180)  # yellow: the most
        self.assertGreater(green, 160)
        self.assertLess(blue, 180)
        # Where it does not light, the picture is only dimmed.
        dimmed = self.colour(0.9, 0.9)
        self.assertTrue(all(d < r for d, r in zip(dimmed, right, strict=True)), (dimmed, right))

    def test_from_the_list_and_back(self) -> None:
        self.click(0.1, 0.1)
        buttons = self.explorer.find_elements("css selector", "tbody button")
        buttons[2].click()
        self.assertIn("VPL 2 contributes 12.5 %", self.text())
        self.assertIn("strongest of 11 of 12 pixels", self.text())
        self.explorer.find_element("css selector", ".explorer-side > button").click()
        self.assertIn("3 VPLs with 1 in sight", self.text())

    def test_keys(self) -> None:
        self.js("arguments[0].focus({preventScroll: true})", self.picture)
        keys = self.actions()
        keys.send_keys(*[Keys.ARROW_RIGHT] * 4, *[Keys.ARROW_DOWN] * 4).perform()
        self.assertIn("Pixel (3, 2) of 4×3: 1 VPL contributes 75.0 %", self.text())
        self.actions().send_keys(Keys.ESCAPE).perform()
        self.assertIn("3 VPLs", self.text())

    def test_it_fits_a_narrow_page(self) -> None:
        self.open(400, "dark")
        explorer = self.all(".explorer")[0]
        self.js("arguments[0].scrollIntoView({behavior: 'instant'})", explorer)
        self.until(lambda: bool(explorer.get_attribute("aria-busy") == "false"))
        width = self.js("return document.documentElement.scrollWidth")
        self.assertLessEqual(width, 400)
        self.assertGreater(explorer.find_element("css selector", "canvas").size["width"], 300)


class ListTest(unittest.TestCase):
    def fails(self, value: Any) -> str:
        with tempfile.TemporaryDirectory() as folder:
            report = write_report(Path(folder))
            text = value if isinstance(value, str) else json.dumps(value)
            (Path(folder) / "contributions.json").write_text(text, encoding="utf-8")
            made = call(make_report.main, report, "-o", Path(folder) / "report.html")
            self.assertEqual(made.returncode, make_report.EXIT_INPUT)
            self.assertEqual(made.stderr.count("\n"), 1)
            return made.stderr

    def test_bad_lists(self) -> None:
        self.assertIn("contributions.json: no JSON", self.fails("{"))
        self.assertIn("no list of contributions", self.fails({"format": "other"}))
        self.assertIn("damaged: KeyError", self.fails({**contributions(), "pixels": {}}))
        self.assertIn("damaged: ", self.fails({**contributions(), "width": 5}))
        wide = {**contributions(), "width": 12, "height": 1}
        self.assertIn("12x1 pixels are not of the shape of the images' 8x6", self.fails(wide))
        self.assertIn("version 2", self.fails({**contributions(), "version": 2}))


if __name__ == "__main__":
    unittest.main()
