"""Tests the page as a whole: use of the network, width, colours, names."""

from __future__ import annotations

import json
import re
import time
import unittest

import numpy as np
from selenium.webdriver.common.keys import Keys

from page_case import PageCase


class PageTest(PageCase):
    # --- loading

    def test_nothing_is_fetched(self) -> None:
        self.driver.get_log("performance")  # drops what other cases asked for
        self.open(1280, "light")
        self.reach(1)
        asked = []
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                asked.append(message["params"]["request"]["url"])
        self.assertIn(self.url, asked)
        self.assertEqual([u for u in asked if u != self.url and not u.startswith("data:")], [])

    def test_the_policy_forbids_the_network(self) -> None:
        blocked = self.driver.execute_async_script(
            "const done = arguments[0]; addEventListener('securitypolicyviolation',"
            "(e) => done(e.effectiveDirective)); fetch('https://example.invalid/').catch(() => {})"
        )
        self.assertEqual(blocked, "connect-src")
        self.driver.get_log("browser")  # the browser's report of the refusal

    def test_viewers_far_below_wait(self) -> None:
        made = "return [...document.querySelectorAll('.viewer')].map((v) => v.children.length > 1)"
        # The emulation takes effect before any script of the page runs.
        style = (
            "const s = new CSSStyleSheet();"
            "s.replaceSync('.view {margin-top: 9000px !important}');"
            "document.adoptedStyleSheets = [s]"
        )
        script = self.driver.execute_cdp_cmd(
            "Page.addScriptToEvaluateOnNewDocument", {"source": style}
        )
        self.addCleanup(
            self.driver.execute_cdp_cmd, "Page.removeScriptToEvaluateOnNewDocument", script
        )
        self.driver.get(self.url)
        time.sleep(0.3)
        self.assertEqual(self.js(made), [False, False])
        self.viewer = self.reach(1)
        self.assertEqual(self.js(made), [False, True])

    # --- looks

    def test_no_horizontal_scroll(self) -> None:
        for width in (1280, 400):
            self.open(width, "light")
            self.js("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
            self.keys("m")
            wide = self.js("return document.documentElement.scrollWidth")
            self.assertLessEqual(wide, width)
            self.assertEqual(
                self.js(
                    "return [...document.querySelectorAll('svg.plot')].filter("
                    "(p) => p.getBoundingClientRect().width > 0).length"
                ),
                2,
            )
            self.assertEqual(self.words_outside("svg.plot"), [], "texts outside of their plot")
        box = self.all("#table-sum .scroll")[0]
        self.assertGreater(
            self.js("return arguments[0].scrollWidth", box),
            self.js("return arguments[0].clientWidth", box),
        )

    def test_contrast_in_both_modes(self) -> None:
        papers = []
        for scheme in ("light", "dark"):
            self.open(1280, scheme)
            self.keys("m")
            paper = rgb(self.js("return getComputedStyle(document.body).backgroundColor"))
            papers.append(paper)
            for selector in (
                "h1",
                ".lead p",
                ".note",
                "nav a",
                "td",
                ".numbers thead small",
                "b.best",
                "legend",
                ".list small",
                ".readout td",
                ".formula",
                "figcaption",
                "kbd",
                "summary",
                ".provenance dt",
            ):
                colours = self.js(
                    "return [...document.querySelectorAll(arguments[0])].map("
                    "(e) => getComputedStyle(e).color)",
                    selector,
                )
                self.assertTrue(colours, selector)
                for colour in colours:
                    self.assertGreaterEqual(
                        contrast(rgb(colour), paper), 4.5, f"{selector} in {scheme} mode"
                    )
            for fill in self.js(
                "return [...document.querySelectorAll('svg text')].map("
                "(e) => getComputedStyle(e).fill)"
            ):
                self.assertGreaterEqual(contrast(rgb(fill), paper), 4.5, f"plot, {scheme}")
        self.assertGreater(min(papers[0]), 200)
        self.assertLess(max(papers[1]), 60)

    def test_controls_have_names(self) -> None:
        unnamed = self.js("""
            return [...document.querySelectorAll('.viewer input, .viewer button, .viewer select,'
                + '.viewer [role=slider], .viewer [role=application], .scroll')].filter((e) =>
                !(e.getAttribute('aria-label') || e.labels?.[0]?.textContent.trim()
                  || e.textContent.trim())).map((e) => e.outerHTML)""")
        self.assertEqual(unnamed, [])
        self.assertIn("Shift 1–9", self.one(".keys").text)
        self.keys(Keys.TAB)
        ring = self.js(
            "return getComputedStyle(document.activeElement.firstElementChild).outlineStyle"
        )
        self.assertEqual(ring, "solid", "the split's handle shows that it has the focus")


def rgb(text: str) -> list[float]:
    return [float(t) for t in re.findall(r"[\d.]+", text)[:3]]


def contrast(a: list[float], b: list[float]) -> float:
    """Contrast ratio by WCAG 2."""

    def luminance(colour: list[float]) -> float:
        v = np.array(colour) / 255
        linear = np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)
        return float(np.dot([0.2126, 0.7152, 0.0722], linear))

    high, low = sorted((luminance(a), luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


if __name__ == "__main__":
    unittest.main()
