"""Tests the viewer: a person's input, and the pixels and numbers that must follow."""

from __future__ import annotations

import functools
import importlib.util
import re
import unittest
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from selenium.webdriver.common.keys import Keys

from page_case import READ_PIXEL, PageCase
from test_support import HEIGHT, WIDTH, images, to_srgb8


class ViewerTest(PageCase):
    # --- comparing

    def test_split_by_pointer(self) -> None:
        a, reference = to_srgb8([0.5, 0.25, 0.125]), to_srgb8([0.25, 0.125, 0.0625])
        self.assertEqual([self.colour(1.5, 2.5), self.colour(6.5, 2.5)], [a, reference])
        stage = self.one(".stage")
        width = stage.size["width"]
        drag = self.actions()
        drag.move_to_element(self.one(".handle")).click_and_hold()
        drag.move_to_element_with_offset(stage, int(0.375 * width), 0).release().perform()
        self.assertEqual([self.colour(6.5, 2.5), self.colour(7.5, 2.5)], [a, reference])
        self.actions().move_to_element_with_offset(
            stage, int(-0.375 * width), 0
        ).click().perform()
        self.assertEqual([self.colour(0.5, 2.5), self.colour(1.5, 2.5)], [a, reference])

    def test_split_by_keys(self) -> None:
        a, reference = to_srgb8([0.5, 0.25, 0.125]), to_srgb8([0.25, 0.125, 0.0625])
        self.keys(Keys.HOME, at=".handle")
        self.assertEqual(self.colour(0.5, 2.5), reference)
        self.keys(Keys.END, at=".handle")
        self.assertEqual(self.colour(7.5, 2.5), a)
        self.keys(Keys.ARROW_LEFT, "^" + Keys.ARROW_LEFT, at=".handle")
        self.assertEqual(self.one(".handle").get_attribute("aria-valuenow"), "89")
        self.keys("<")
        self.assertEqual(self.one(".handle").get_attribute("aria-valuenow"), "84")

    def test_flipping(self) -> None:
        a, b = to_srgb8([0.5, 0.25, 0.125]), to_srgb8([0.125, 0.0625, 0.03125])
        reference = to_srgb8([0.25, 0.125, 0.0625])
        self.keys("^3")
        self.assertEqual([self.colour(1.5, 2.5), self.colour(6.5, 2.5)], [a, b])
        self.keys("f")
        self.assertEqual([self.colour(1.5, 2.5), self.colour(6.5, 2.5)], [b, b])
        self.keys(" ")
        self.assertEqual([self.colour(1.5, 2.5), self.colour(6.5, 2.5)], [a, a])
        self.keys("1")
        self.assertEqual(self.colour(6.5, 2.5), reference)
        self.keys("x", "s")
        self.assertEqual([self.colour(1.5, 2.5), self.colour(6.5, 2.5)], [b, reference])
        self.keys("9")  # there is no ninth image
        self.assertEqual(self.colour(1.5, 2.5), b)
        self.viewer.find_elements("css selector", ".list tbody tr input")[2].click()
        self.assertEqual(self.colour(1.5, 2.5), a)

    def test_keys_under_the_pointer(self) -> None:
        self.actions().move_to_element(self.one(".stage")).perform()
        self.actions().send_keys("3").perform()
        self.assertEqual(self.colour(1.5, 2.5), to_srgb8([0.125, 0.0625, 0.03125]))

    def test_exposure(self) -> None:
        reference = [0.25, 0.125, 0.0625]
        self.keys("e", "e", "e")
        self.assertEqual(self.colour(6.5, 2.5), to_srgb8(reference, 1.5))
        self.keys("^e", "^e", "^e", "^e", "^e")
        self.assertEqual(self.colour(6.5, 2.5), to_srgb8(reference, -1))
        self.keys(Keys.ARROW_RIGHT, at=".ev")
        self.assertEqual(self.colour(6.5, 2.5), to_srgb8(reference, -0.75))
        self.assertEqual(self.one(".ev-text").text, "−0.75 EV")
        self.keys("a")
        luminance = float(np.dot([0.2126, 0.7152, 0.0722], reference))
        auto = round(np.log2(0.18 / luminance) * 4) / 4
        self.assertEqual(self.colour(6.5, 2.5), to_srgb8(reference, auto))
        self.keys("r")
        self.assertEqual(self.colour(6.5, 2.5), to_srgb8(reference, 0))
        self.viewer = self.reach(1)  # gives no exposure: automatic
        self.assertEqual(self.colour(6.5, 2.5), to_srgb8(reference, auto))

    def test_the_image_that_is_shown_first(self) -> None:
        def chosen() -> str:
            return str(self.one('input[aria-label^="A: "]:checked').get_attribute("aria-label"))

        self.assertEqual(chosen(), "A: Image a")  # the first that is not the reference
        self.viewer = self.reach(1)
        self.assertEqual(chosen(), "A: Image b")

    def test_layers(self) -> None:
        full = images()["reference-full"]
        self.keys("l", "f")
        self.assertEqual(self.colour(3.5, 2.5), to_srgb8(full[2, 3]))
        self.assertEqual(self.colour(4.5, 2.5), to_srgb8(full[2, 4]))
        inputs = self.viewer.find_elements("css selector", ".list tbody tr:nth-child(3) input")
        self.assertFalse(inputs[0].is_enabled(), "image b has no full layer")
        self.keys("1", "3")
        self.assertEqual(self.colour(4.5, 2.5), to_srgb8(full[2, 4]))

    def test_zoom(self) -> None:
        self.keys("l", "f")
        self.keys(*[Keys.ARROW_LEFT] * 2, *[Keys.ARROW_UP] * 1, "z", "z", "z")
        full = images()["reference-full"]
        self.assertEqual(self.one(".zoom-text").text, "8×")
        # One image pixel covers 8 x 8 places; the odd pixel must fill its mark.
        mark = self.js(
            """const m = arguments[0].querySelector('.mark'),
            c = arguments[0].querySelector('.stage canvas');
            const s = c.clientWidth / arguments[1];
            return [m.offsetLeft / s, m.offsetTop / s, m.offsetWidth / s]""",
            self.viewer,
            WIDTH,
        )
        self.keys(Keys.ARROW_RIGHT)
        odd = self.js(
            """const m = arguments[0].querySelector('.mark'),
            c = arguments[0].querySelector('.stage canvas');
            const s = c.clientWidth / arguments[1];
            return [m.offsetLeft / s, m.offsetTop / s]""",
            self.viewer,
            WIDTH,
        )
        self.assertAlmostEqual(mark[2], 8, delta=0.1)
        corners = [(odd[0] + dx, odd[1] + dy) for dx in (0.2, 7.8) for dy in (0.2, 7.8)]
        inside = [c for c in corners if 0 <= c[0] < WIDTH and 0 <= c[1] < HEIGHT]
        self.assertTrue(inside)
        for x, y in inside:
            self.assertEqual(self.colour(x, y), to_srgb8(full[2, 3]))

    # --- numbers

    def test_pixel_under_the_pointer(self) -> None:
        stage = self.one(".stage")
        size = stage.size["width"] / WIDTH
        self.actions().move_to_element_with_offset(
            stage, int((5.5 - WIDTH / 2) * size), int((1.5 - HEIGHT / 2) * size)
        ).perform()
        self.assertEqual(self.one(".readout caption").text, "Pixel (5, 1), linear")
        mean = (0.25 + 0.125 + 0.0625) / 3
        self.assertEqual(
            self.readout(),
            [
                ["0.5000", "0.2500", "0.1250", f"+{100 * mean / (1.1 * mean):.1f} %"],
                ["0.2500", "0.1250", "0.06250", "–"],
                ["0.2500", "0.1250", "0.06250", "–"],
            ],
        )

    def test_every_value_arrives(self) -> None:
        expected = wild_as_stored()
        self.keys("4", *[Keys.ARROW_LEFT] * WIDTH, *[Keys.ARROW_UP] * HEIGHT)
        # Real keys select the first pixel; for the other 47 they would take half a minute.
        found = self.js(
            """
            const stage = arguments[0].querySelector('.stage'), found = [];
            const press = (key) => stage.dispatchEvent(
                new KeyboardEvent('keydown', {key, bubbles: true}));
            for (let y = 0; y < arguments[2]; ++y) {
              for (let x = 0; x < arguments[1]; ++x) {
                found.push([arguments[0].querySelector('.readout caption').textContent,
                    ...[...arguments[0].querySelectorAll('.readout tbody tr:first-child td')]
                        .map((c) => c.textContent)]);
                if (x < arguments[1] - 1) press('ArrowRight');
              }
              if (y === arguments[2] - 1) break;
              for (let x = 0; x < arguments[1]; ++x) press('ArrowLeft');
              press('ArrowDown');
            }
            return found;""",
            self.viewer,
            WIDTH,
            HEIGHT,
        )
        for i, (caption, *values) in enumerate(found):
            y, x = divmod(i, WIDTH)
            self.assertEqual(caption, f"Pixel ({x}, {y}), linear")
            numbers = [float(t.replace("−", "-")) for t in values[:3]]
            np.testing.assert_allclose(numbers, expected[y, x], rtol=6e-4, atol=1e-30)
        spoken = self.js(
            "return arguments[0].querySelector('[aria-live]').textContent", self.viewer
        )
        self.assertIn(f"Pixel ({WIDTH - 1}, {HEIGHT - 1})", spoken)

    def test_list_says_how_good(self) -> None:
        rows = [r.text for r in self.viewer.find_elements("css selector", ".list tbody tr")]
        reference = np.array([0.25, 0.125, 0.0625])
        epsilon = 1e-4 * reference.mean() ** 2
        error = np.mean(reference**2 / (reference**2 + epsilon))
        self.assertIn(f"mean ratio 2.000, relMSE {error:.2f}", rows[1])
        self.assertNotIn("relMSE", rows[0])
        self.assertIn("relMSE 0.5 of seven seeds", rows[2])

    def test_relative_map_and_legend(self) -> None:
        self.keys("m")
        self.assertEqual(
            self.colour(6.5, 2.5), to_srgb8([0.25, 0.125, 0.0625]), "the reference stays a picture"
        )
        self.choose_range("2")
        self.assertEqual(self.ticks(), ["−200 %", "−100 %", "0", "+100 %", "+200 %"])
        self.assertEqual(self.colour(1.5, 2.5), self.legend(0.5 + 0.5 * (1 / 1.1) / 2))
        self.keys("3")
        darker = self.colour(1.5, 2.5)
        self.assertEqual(darker, self.legend(0.5 - 0.5 * (0.5 / 1.1) / 2))
        self.assertGreater(darker[2], darker[0], "darker is blue")

    def test_squared_map_and_legend(self) -> None:
        self.keys("m", "m")
        self.choose_range("10")
        self.assertEqual(self.ticks(), ["10−3", "10−2", "10−1", "1", "101"])
        error = float(re.findall(r"relMSE ([\d.]+)", self.viewer.text)[0])
        self.assertEqual(self.colour(1.5, 2.5), self.legend(1 + np.log10(error / 10) / 4))
        self.keys("m", "m")
        self.assertFalse(self.one(".legend").is_displayed())

    def test_flip_map_is_that_of_the_exposure_shown(self) -> None:
        reference = images()["reference"].astype(np.float64)
        self.keys("m", "m", "m", "4", "f", "f")
        self.assertIn("LDR-FLIP", self.one(".legend").text)
        self.assertEqual(self.ticks(), ["0", "0.5", "1"])
        for ev in (0.0, -0.5):
            expected = flip_oracle().ldr_flip(
                *(
                    flip_oracle().encode(np.clip(v * 2**ev, 0, 1))
                    for v in (reference, wild_as_stored())
                )
            )
            self.assertGreater(np.ptp(expected), 0.15)
            ramp = np.array(self.legends([i / 255 for i in range(256)]))
            places = list(np.ndindex(expected.shape))
            shown = self.colours([(x + 0.5, y + 0.5) for y, x in places])
            for (y, x), colour in zip(places, shown, strict=True):
                steps = np.flatnonzero((ramp == colour).all(axis=1)) / 255
                self.assertLess(np.abs(steps - expected[y, x]).min(), 0.6 / 255, (x, y))
            self.keys("^e")
        self.choose_range("0.5")
        self.assertEqual(self.ticks(), ["0", "0.25", "0.5"])

    def choose_range(self, value: str) -> None:
        self.one(f".legend option[value='{value}']").click()

    def ticks(self) -> list[str]:
        return [
            t.get_attribute("textContent")
            for t in self.viewer.find_elements("css selector", ".ticks > span")
        ]

    def legend(self, share: float) -> list[int]:
        return self.legends([share])[0]

    def legends(self, shares: list[float]) -> list[list[int]]:
        result: list[list[int]] = self.js(
            "const canvas = arguments[0].querySelector('.legend canvas');"
            "return arguments[1].map((share) => readPixel(canvas, Math.round(255 * share), 0));"
            + READ_PIXEL,
            self.viewer,
            shares,
        )
        return result

    def test_pictures(self) -> None:
        names = [n.text for n in self.viewer.find_elements("css selector", ".list .name")]
        self.assertEqual(names[4:], ["Dots"], "the tall one is of another shape")
        self.assertEqual(len(self.all(".figures img")), 2)
        self.keys("5", "e")
        self.until(lambda: self.colour(1.5, 2.5) == [10, 200, 30])
        self.keys(Keys.ARROW_LEFT)
        self.assertEqual(self.readout()[0], ["10", "200", "30", "8 bit"])
        self.keys(Keys.END, at=".handle")
        self.assertEqual(
            self.colour(WIDTH - 0.5, HEIGHT - 0.5), [10, 200, 30], "it fills the stage"
        )


@functools.cache
def flip_oracle() -> Any:
    """The oracle that also checks the FLIP of vpl-inspect."""
    path = Path(__file__).resolve().parents[2] / "tests/images/flip_oracle.py"
    spec = importlib.util.spec_from_file_location("flip_oracle", path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def wild_as_stored() -> npt.NDArray[Any]:
    values = images()["wild"].astype(np.float64)
    exponent = np.frexp(np.abs(values).max())[1] - 15
    return np.ldexp(np.ldexp(values, -exponent).astype(np.float16).astype(np.float64), exponent)


if __name__ == "__main__":
    unittest.main()
