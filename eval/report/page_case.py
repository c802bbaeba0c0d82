"""A test case with the page in a real browser, and functions to inspect it."""

from __future__ import annotations

import atexit
import functools
import tempfile
import time
import unittest
from collections.abc import Callable
from pathlib import Path
from typing import Any

from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

import make_report
from test_support import WIDTH, browser, call, write_report

# It reads a canvas of its own, as Chromium warns in the console of repeated reads of the page's.
READ_PIXEL = """
    function readPixel(canvas, x, y) {
      const own = document.createElement('canvas');
      own.width = own.height = 1;
      const context = own.getContext('2d', {willReadFrequently: true});
      context.drawImage(canvas, Math.floor(x), Math.floor(y), 1, 1, 0, 0, 1, 1);
      return [...context.getImageData(0, 0, 1, 1).data].slice(0, 3);
    }"""


@functools.cache
def page_in_browser() -> tuple[str, Any]:
    """A page and the browser for it, which all cases share."""
    folder = tempfile.TemporaryDirectory()
    atexit.register(folder.cleanup)
    page = Path(folder.name) / "report.html"
    made = call(make_report.main, write_report(page.parent), "-o", page)
    assert made.returncode == 0, made.stderr
    driver = browser()
    atexit.register(driver.quit)
    return page.as_uri(), driver


class PageCase(unittest.TestCase):
    url: str
    driver: Any

    @classmethod
    def setUpClass(cls) -> None:
        cls.url, cls.driver = page_in_browser()

    def setUp(self) -> None:
        self.open(1280, "light")

    def words_outside(self, drawing: str, above: int = 1) -> Any:
        """Words of the drawings that a selector names, which leave it by more than a pixel, or by
        more than `above` pixels at top and bottom."""
        return self.js(
            """
            const [drawing, above] = arguments;
            return [...document.querySelectorAll(drawing + ' text')].filter((text) => {
              const frame = text.closest('svg').getBoundingClientRect();
              const box = text.getBoundingClientRect();
              return box.left < frame.left - 1 || box.right > frame.right + 1
                  || box.top < frame.top - above || box.bottom > frame.bottom + above;
            }).map((text) => text.textContent)""",
            drawing,
            above,
        )

    def tearDown(self) -> None:
        found = [entry["message"] for entry in self.driver.get_log("browser")]
        self.assertEqual(found, [], "the console is not silent")

    def open(self, width: int, scheme: str) -> None:
        self.driver.execute_cdp_cmd(
            "Emulation.setDeviceMetricsOverride",
            {"width": width, "height": 800, "deviceScaleFactor": 1, "mobile": False},
        )
        self.driver.execute_cdp_cmd(
            "Emulation.setEmulatedMedia",
            {"features": [{"name": "prefers-color-scheme", "value": scheme}]},
        )
        self.driver.get(self.url)
        self.viewer = self.reach(0)

    def reach(self, index: int) -> Any:
        """The viewer, scrolled into view and with all its images decoded."""
        viewer = self.all(".viewer")[index]
        self.js("arguments[0].scrollIntoView({behavior: 'instant'})", viewer)
        self.until(lambda: viewer.get_attribute("aria-busy") == "false" and "relMSE" in viewer.text)
        return viewer

    def until(self, condition: Callable[[], bool]) -> None:
        end = time.monotonic() + 10
        while not condition():
            self.assertLess(time.monotonic(), end, "waited 10 s in vain")
            time.sleep(0.02)

    def js(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def all(self, selector: str) -> list[Any]:
        result: list[Any] = self.driver.find_elements("css selector", selector)
        return result

    def one(self, selector: str) -> Any:
        return self.viewer.find_element("css selector", selector)

    def actions(self) -> ActionChains:
        """A chain of actions whose pointer moves at once."""
        return ActionChains(self.driver, duration=0)

    def keys(self, *keys: str, at: str = ".stage") -> None:
        target = self.one(at)
        self.js("arguments[0].focus({preventScroll: true})", target)
        chain = self.actions()
        for key in keys:
            if len(key) > 1 and key.startswith("^"):
                chain.key_down(Keys.SHIFT).send_keys(key[1:]).key_up(Keys.SHIFT)
            else:
                chain.send_keys(key)
        chain.perform()
        # All images are decoded then.
        self.until(lambda: bool(self.viewer.get_attribute("aria-busy") == "false"))

    def colour(self, x: float, y: float) -> list[int]:
        """Colour of the canvas at a place given in image pixels at zoom 1."""
        return self.colours([(x, y)])[0]

    def colours(self, places: list[tuple[float, float]]) -> list[list[int]]:
        result: list[list[int]] = self.js(
            """
            const c = arguments[0].querySelector('.stage canvas'), s = c.width / arguments[2];
            return arguments[1].map(([x, y]) => readPixel(c, x * s, y * s));"""
            + READ_PIXEL,
            self.viewer,
            places,
            WIDTH,
        )
        return result

    def readout(self) -> list[list[str]]:
        result: list[list[str]] = self.js(
            "return [...arguments[0].querySelectorAll('.readout tbody tr')].map("
            "(r) => [...r.querySelectorAll('td')].map((c) => c.textContent))",
            self.viewer,
        )
        return result
