"""Tests what the scripts write, and what they refuse."""

from __future__ import annotations

import errno
import json
import re
import tempfile
import unittest
from html import escape
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np

import make_report
import plot_figure
import plots
from test_support import call, flat, report, run, write_exr, write_report


class InputTest(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.json = write_report(self.folder)
        self.page = self.folder / "report.html"

    def make(self) -> str:
        made = call(make_report.main, self.json, "-o", self.page)
        self.assertEqual(made.returncode, 0, made.stderr)
        return self.page.read_text(encoding="utf-8")

    def refused(self, *expected: str) -> None:
        """Checks a refusal: one line with these parts, exit code 3, and no page."""
        made = call(make_report.main, self.json, "-o", self.page)
        self.assertEqual(made.returncode, 3, made.stderr)
        self.assertEqual(made.stderr.count("\n"), 1, made.stderr)
        for part in expected:
            self.assertIn(part, made.stderr)
        self.assertEqual(list(self.folder.glob("report.html*")), [])

    def change(self, edit: Any) -> None:
        data = report()
        edit(data)
        self.json.write_text(json.dumps(data), encoding="utf-8")

    # --- the page

    def test_equal_input_gives_equal_bytes(self) -> None:
        first = self.make()
        made = run("make_report.py", self.json, "-o", self.page)
        self.assertRegex(made.stderr, r"^make_report.py: .*report.html: [0-9.]+ MiB\n$")
        self.assertEqual(first, self.page.read_text(encoding="utf-8"))
        self.assertNotIn(str(self.folder), first)

    def test_text_is_escaped(self) -> None:
        self.change(
            lambda r: r["scenes"][0]["views"][0]["images"][0].update(
                label="</script><script>alert(1)</script>"
            )
        )
        page = self.make()
        self.assertIn("<h1>A report &lt;of&gt; tests</h1>", page)
        self.assertNotIn("<script>alert", page)

    def test_best_of_each_group(self) -> None:
        sums = self.make().partition('id="table-field"')[0]
        rows = re.findall(r"<tr><th scope=\"row\".*?</tr>", sums)
        marks = [
            [("best" in c) for c in re.findall(r"<t[hd][^>]*>.*?</t[hd]>", r)][1:4] for r in rows
        ]
        # The columns are rmse, ratio, rays. Row r is not judged, a single value is not marked,
        # and a tie marks both.
        self.assertEqual(
            marks,
            [
                [False, True, False],
                [True, False, True],
                [False] * 3,
                [False, False, True],
                [False, True, True],
            ],
        )
        self.assertIn("0.100 ± 0.013", self.page.read_text())

    def test_plots_of_the_page(self) -> None:
        page = self.make()
        drawings = re.findall(r'<svg class="plot (?:wide|narrow)".*?</svg>', page, re.S)
        self.assertEqual(len(drawings), 4)
        for svg in drawings[:2]:  # the wide one and the narrow one
            texts = re.findall(r"<text[^>]*>([^<]*)</text>", svg)
            for text in ("1000", "10000", "0.001", "0.1", "VPLs", "relMSE", "slope −1.02"):
                self.assertIn(text, texts)
            # 0.02 ± 0.03 does not stretch the axis down to zero.
            self.assertEqual([t for t in texts if t.startswith("10⁻") or t == "0.0001"], [])
            self.assertEqual(svg.count("<title>"), 24)
            self.assertIn("<title>series 2: 3000, 0.02</title>", svg)
        for svg in drawings:
            self.assertNotRegex(svg, r"#[0-9a-f]{6}\b", "a colour that ignores dark mode")
        ids = re.findall(r'\bid="([^"]*)"', "".join(drawings))
        self.assertEqual(len(ids), len(set(ids)))

    def test_names_of_lines_are_shown_as_they_are(self) -> None:
        names = ["_hidden", "#ffffff", "<b> & 'x'", "$x^2$", "font: 9px serif", "部屋"]

        def edit(data: dict[str, Any]) -> None:
            for series, name in zip(data["plots"][0]["series"], names, strict=False):
                series.update(label=name, slope=None)

        self.change(edit)
        page = self.make()
        for kind in ("wide", "narrow"):
            svg = page[page.index(f'<svg class="plot {kind}"') :]
            texts = re.findall(r"<text[^>]*>([^<]*)</text>", svg[: svg.index("</svg>")])
            for name in names:
                self.assertIn(escape(name, quote=False), texts)

    def test_numbers_of_ticks(self) -> None:
        cases = [
            (0.5, True, "0.5"),
            (-20000, True, "−20000"),
            (0, False, "0"),
            (1e-4, False, "10⁻⁴"),
            (2e6, False, "2·10⁶"),
        ]
        for value, plain, text in cases:
            self.assertEqual(plot_figure.tick_text(value, plain), text)

    def test_plots_as_files(self) -> None:
        for name, start in (("p.png", b"\x89PNG"), ("p.svg", b"<?xml")):
            files = [self.folder / f"{i}{name}" for i in range(2)]
            both = [
                call(plots.main, self.json, "conv", "-o", files[0]),
                run("plots.py", self.json, "conv", "-o", files[1]),
            ]
            self.assertEqual([m.returncode for m in both], [0, 0], both[1].stderr)
            first, second = (f.read_bytes() for f in files)
            self.assertEqual(first[: len(start)], start)
            self.assertEqual(first, second)
        made = call(plots.main, self.json, "none", "-o", self.folder / "n.png")
        self.assertEqual(made.returncode, 3)
        self.assertIn("it has conv, lin", made.stderr)

    # --- refusals

    def test_malformed_json(self) -> None:
        self.json.write_text('{"title": "x",\n "lead": }')
        self.refused("report.json: line 2, column 10", "correct it")
        self.json.write_text('{"title": NaN}')
        self.refused("NaN", "write null")
        self.json.unlink()
        self.refused("report.json: No such file")

    def test_missing_image(self) -> None:
        (self.folder / "a-full.exr").unlink()
        self.refused("a-full.exr: no such file; render it")

    def test_damaged_image(self) -> None:
        (self.folder / "b.exr").write_bytes(b"nonsense")
        self.refused("b.exr: no image that can be read; render it again")

    def test_cut_picture(self) -> None:
        data = (self.folder / "dots.png").read_bytes()
        (self.folder / "dots.png").write_bytes(data[:-5])
        self.refused("dots.png: not a whole PNG file")

    def test_wrong_size(self) -> None:
        write_exr(self.folder / "b.exr", flat(1, 1, 1)[:, :5])
        self.refused("b.exr: 5x6 pixels, but", "reference.exr has 8x6; render both at one size")

    def test_not_finite(self) -> None:
        pixels = flat(1, 1, 1)
        pixels[2, 4, 1] = np.nan
        write_exr(self.folder / "b.exr", pixels)
        self.refused("b.exr: pixel (4, 2): not finite")

    def test_missing_layer(self) -> None:
        write_exr(self.folder / "layers.exr", flat(1, 1, 1))
        self.refused("layers.exr: no channels full.R full.G full.B (it has R G B)")

    def test_wrong_values(self) -> None:
        view = "scenes[0].views[0]"
        cases = [
            (lambda r: r.pop("title"), "top level: 'title' is missing"),
            (
                lambda r: r["tables"][0]["columns"][1].update(better="lower"),
                'tables[0].columns[1].better: "lower" is unknown; use "low"',
            ),
            (
                lambda r: r["tables"][0]["rows"][0].update(rmse=[1]),
                "tables[0].rows[0].rmse: [1] is neither text nor number",
            ),
            (
                lambda r: r["tables"][1].update(filters=["nothing"]),
                "tables[1].filters: no column has the key 'nothing'",
            ),
            (
                lambda r: r["tables"][2]["rows"][0].update(diagram="nothing"),
                "no diagram has the name 'nothing'; add it to eval/report/diagrams",
            ),
            (
                lambda r: r["tables"][1]["rows"][0]["picture"].update(image="none"),
                "no view has the picture room/main/none",
            ),
            (
                lambda r: r["scenes"][0]["views"][0].update(reference="x"),
                f"{view}.reference: no image has the id 'x'",
            ),
            (
                lambda r: r["scenes"][0]["views"][0].update(first="x"),
                f"{view}.first: no image has the id 'x'",
            ),
            (
                lambda r: r["scenes"][0]["views"][0]["images"][1]["files"].update(direct="a.exr"),
                f"{view}.images[1].files.direct: no layer has the id 'direct'",
            ),
            (lambda r: r["scenes"][0]["views"][1].update(id="main"), "id 'main' is used twice"),
            (lambda r: r["scenes"][0].update(id="a b"), "scenes[0].id: 'a b' is no id"),
            (
                lambda r: r["plots"][0]["series"][2]["x"].pop(),
                "plots[0].series[2]: 2 of x, 3 of y, 3 of error: lists of unequal length",
            ),
            (
                lambda r: r["plots"][0]["series"][0]["y"].__setitem__(1, 0),
                "plots[0].series[0].y[1]: 0 has no place on a logarithmic axis",
            ),
        ]
        for edit, expected in cases:
            with self.subTest(expected):
                self.change(edit)
                self.refused(expected)

    def test_output_that_cannot_be_written(self) -> None:
        made = call(make_report.main, self.json, "-o", self.folder / "none" / "r.html")
        self.assertEqual(made.returncode, 4)
        self.assertEqual(made.stderr.count("\n"), 1, made.stderr)

    def test_outputs_replace_only_their_kind(self) -> None:
        cases: list[tuple[Any, list[str], str]] = [
            (make_report.main, [], "r.html"),
            (plots.main, ["conv"], "p.svg"),
            (plots.main, ["conv"], "p.png"),
        ]
        for main, words, name in cases:
            file = self.folder / name
            file.write_bytes(b"\x89VPL\r\n\x1a\n")
            made = call(main, self.json, *words, "-o", file)
            self.assertEqual(made.returncode, 4)
            self.assertRegex(
                made.stderr,
                rf"\A[^\n]*/{name}: is not an? [^\n]*, which -o would replace it with; name "
                r"[^\n]*\n\Z",
            )
            self.assertEqual(file.read_bytes(), b"\x89VPL\r\n\x1a\n")
            file.unlink()
            for _ in range(2):
                self.assertEqual(call(main, self.json, *words, "-o", file).returncode, 0)
        before = self.json.read_bytes()
        made = call(make_report.main, self.json, "-o", self.json)
        self.assertIn("is the file of the report, which the run reads", made.stderr)
        self.assertEqual(self.json.read_bytes(), before)

    def test_a_full_disk_leaves_the_old_page(self) -> None:
        old = self.make()
        self.change(lambda r: r.update(title="Another"))

        def write_half(path: Path, data: bytes) -> None:
            with open(path, "wb") as file:
                file.write(data[: len(data) // 2])
            raise OSError(errno.ENOSPC, "No space left on device")

        with mock.patch.object(Path, "write_bytes", write_half):
            made = call(make_report.main, self.json, "-o", self.page)
        self.assertEqual(made.returncode, 4)
        self.assertIn("report.html: No space left on device", made.stderr)
        self.assertEqual(self.page.read_text(encoding="utf-8"), old)
        self.assertEqual(list(self.folder.glob("*report.html*")), [self.page])


if __name__ == "__main__":
    unittest.main()
