"""Tests docs/index.html in Chromium: its sizes, schemes and splits, and that it needs no network."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "docs"), str(ROOT / "eval/report")]
import make_index  # noqa: E402
from test_support import browser  # noqa: E402

MAX_BYTES = 1_500_000
NOT_DECODED = "return [...document.images].filter((i) => !i.complete || !i.naturalWidth).length"


class IndexTest(unittest.TestCase):
    driver: Any

    @classmethod
    def setUpClass(cls) -> None:
        cls.driver = browser()
        cls.addClassCleanup(cls.driver.quit)

    def open(self, width: int, scheme: str) -> None:
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        media = {"features": [{"name": "prefers-color-scheme", "value": scheme}]}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", media)
        self.driver.get(make_index.PAGE.as_uri())

    def test_widths_and_schemes(self) -> None:
        papers = set()
        for width in (400, 1600):
            for scheme in ("light", "dark"):
                self.open(width, scheme)
                js = self.driver.execute_script
                self.assertEqual(js("return document.documentElement.scrollWidth"), width)
                self.assertEqual(js(NOT_DECODED), 0)
                papers.add(js("return getComputedStyle(document.body).backgroundColor"))
                self.assertEqual([e["message"] for e in self.driver.get_log("browser")], [])
        self.assertEqual(len(papers), 2)

    def test_splits_follow_their_input(self) -> None:
        self.open(1600, "light")
        clip = "return getComputedStyle(arguments[0].querySelector('img + img')).clipPath"
        splits = self.driver.find_elements("css selector", ".split")
        self.assertEqual(len(splits), 4)
        for split in splits:
            before = self.driver.execute_script(clip, split)
            split.find_element("css selector", "input").send_keys("\ue010")  # the key End
            after = self.driver.execute_script(clip, split)
            self.assertIn("50%", before)
            self.assertIn("100%", after)

    def test_page_is_small_and_that_of_the_template(self) -> None:
        page = make_index.PAGE.read_text(encoding="utf-8")
        self.assertLess(make_index.PAGE.stat().st_size, MAX_BYTES)
        self.assertEqual(
            page, make_index.page_html(make_index.kept_values(page)), "run make_index.py --text"
        )

    def test_links_lead_to_pages(self) -> None:
        self.open(1600, "light")
        for link in self.driver.find_elements("css selector", "a"):
            target = ROOT / "docs" / link.get_dom_attribute("href")
            self.assertTrue(target.exists(), target)


if __name__ == "__main__":
    unittest.main()
