"""Tests that each method has a paragraph and a diagram, without the tools."""

import sys
import unittest
from pathlib import Path
from xml.etree import ElementTree

EVAL = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(EVAL), str(EVAL / "report")]
from bnvpl_eval import field_methods  # noqa: E402
from diagrams import DIAGRAMS, diagram_svg, matrices  # noqa: E402

METHODS = {
    kind: sorted(
        theory.parent.name.replace("_", "-")
        for theory in (EVAL.parent / folder).glob("*/theory.md")
    )
    for kind, folder in field_methods.PAGES.items()
}


class Diagrams(unittest.TestCase):
    def test_each_method_has_one(self) -> None:
        self.assertGreater(len(METHODS["gathers"]), 10)
        self.assertEqual(sorted(DIAGRAMS), sorted(sum(METHODS.values(), [])))

    def test_each_is_well_formed_and_has_a_title(self) -> None:
        for name in DIAGRAMS:
            root = ElementTree.fromstring(diagram_svg(name))
            self.assertEqual(root[0].tag, "title")
            self.assertTrue((root[0].text or "").startswith(f"{name}: "))
            self.assertGreater(len(root), 8, name)

    def test_no_two_are_alike(self) -> None:
        bodies = {diagram_svg(name).partition("</title>")[2] for name in DIAGRAMS}
        self.assertEqual(len(bodies), len(DIAGRAMS))

    def test_colours_are_those_of_the_page(self) -> None:
        for name in DIAGRAMS:
            self.assertNotRegex(diagram_svg(name), r"#[0-9a-f]{3}|rgb|black|white", name)

    def test_one_column_of_each_cluster_is_computed(self) -> None:
        for alike in matrices.ALIKE:
            computed = sorted(column for column in alike if column.isupper())
            self.assertEqual(computed, sorted(set(alike.upper())))

    def test_the_paragraph_says_what_the_method_does(self) -> None:
        made = field_methods.explanation(METHODS["gathers"], METHODS["compensations"])
        self.assertEqual(sorted(row["diagram"] for row in made["rows"]), sorted(DIAGRAMS))
        for row in made["rows"]:
            name, text = row["name"], row["text"]
            self.assertGreater(len(text), 40, name)
            self.assertTrue(text.endswith("."), name)
            self.assertNotRegex(text, r"Source:|[*`]|\]\(", name)


if __name__ == "__main__":
    unittest.main()
