"""The structure of the sources: who includes whom, and how long files and functions are.

A folder includes only what stands before it in its list, itself, and what every list may use.
"""

from __future__ import annotations

import graphlib
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
import check_prose  # noqa: E402

LAYERS = ["core", "formats", "spatial", "scene", "transport", "images", "tools"]
STAGES = ["place", "eliminate", "estimate", "render"]
# What vpl-render is made of, from the record of a sample up to the integrators.
RENDER = [
    [
        "sample.h",
        "pixel_filter.h",
        "pixel_filter.cpp",
        "camera_path.h",
        "film_points.h",
        "film_rays.h",
        "film_rays.cpp",
        "tile_dimensions.h",
        "stage_options.h",
    ],
    ["splat"],
    ["film"],
    ["preview"],
    ["light_tree"],
    ["gather"],
    ["compensate"],
    ["tile"],
    ["integrator"],
]

MAX_MAIN_LINES = 90
MAX_FILE_LINES = 350
MAX_FUNCTION_LINES = 60


def sources(*folders: str) -> list[Path]:
    names = [Path(name) for name in check_prose.tracked_files()]
    return [
        name
        for name in names
        if name.suffix in (".h", ".cpp", ".py")
        and (not folders or str(name).startswith(tuple(folders)))
    ]


def includes_of(path: Path) -> list[str]:
    return re.findall(r'^#include "([^"]+)"', (ROOT / path).read_text(), re.MULTILINE)


def rank(name: str, order: list[list[str]]) -> int | None:
    """Position of the first part of a path in the order; None where it is not listed."""
    first = name.split("/")[0]
    return next((i for i, names in enumerate(order) if first in names), None)


class Includes(unittest.TestCase):
    def expect_order(self, folder: str, order: list[list[str]]) -> None:
        prefix = folder + "/" if folder else ""
        for path in sources(prefix):
            if path.suffix == ".py" or "test" in path.name:
                continue
            own = rank(str(path).removeprefix(prefix), order)
            if own is None:
                continue
            for include in includes_of(path):
                if not include.startswith(prefix):
                    continue
                other = rank(include.removeprefix(prefix), order)
                self.assertTrue(
                    other is None or other <= own, f"{path} includes {include}, which stands above"
                )

    def test_layers_of_the_project(self) -> None:
        self.expect_order("", [[name] for name in LAYERS])

    def test_folders_of_the_renderer(self) -> None:
        self.expect_order("tools/render", RENDER)

    def test_no_tool_of_the_renderer_is_included_below_its_frame(self) -> None:
        for path in sources("tools/render/"):
            if path.parent == Path("tools/render") and path.name not in RENDER[0]:
                continue
            for include in includes_of(path):
                if include.startswith("tools/render/"):
                    inner = include.removeprefix("tools/render/")
                    self.assertIsNotNone(rank(inner, RENDER), f"{path} includes {include}")

    def test_no_circle_of_folders(self) -> None:
        """A folder may use the folders within it, and they what lies in it."""
        folders: dict[str, set[str]] = {}
        for path in sources():
            if path.suffix == ".py" or "test" in str(path):
                continue
            own = str(path.parent)
            for include in includes_of(path):
                other = str(Path(include).parent)
                if other != own and not other.startswith(own + "/"):
                    folders.setdefault(own, set()).add(other)
        try:
            graphlib.TopologicalSorter(folders).prepare()
        except graphlib.CycleError as error:
            self.fail("folders include each other: " + " <- ".join(error.args[1]))

    def test_stages_do_not_include_each_other(self) -> None:
        for stage in STAGES:
            for path in sources(f"tools/{stage}/"):
                for include in includes_of(path):
                    for other in STAGES:
                        self.assertFalse(
                            other != stage and include.startswith(f"tools/{other}/"),
                            f"{path} includes {include} of another stage",
                        )


def code_of(text: str) -> str:
    """The text without what is in comments, strings and preprocessor lines; lines stay."""
    pattern = (
        r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'|'
        r"^[ ]*\#(?:\\\n|[^\n])*"
    )

    def blank(match: re.Match[str]) -> str:
        digits = match.start() > 0 and text[match.start() - 1].isalnum() and match[0][0] == "'"
        return match[0] if digits else re.sub(r"[^\n]", " ", match[0])

    return re.sub(pattern, blank, text, flags=re.DOTALL | re.MULTILINE)


def end_of_block(code: str, begin: int) -> int:
    """Index of the brace that closes the one at `begin`."""
    depth = 0
    for i in range(begin, len(code)):
        depth += {"{": 1, "}": -1}.get(code[i], 0)
        if depth == 0:
            return i
    return len(code) - 1


def functions_of(text: str) -> list[tuple[int, int]]:
    """First line and length of each function of C++, also of members."""
    code, found, head, i = code_of(text), [], 0, 0
    while i < len(code):
        if code[i] in ";}":
            head = i + 1
        elif code[i] == "{":
            before = code[head:i]
            if re.search(r"\b(namespace|class|struct|union|extern)\b[^()]*$", before):
                head = i + 1
            else:
                end = end_of_block(code, i)
                initialises = code[end + 1 :].lstrip()[:1] in (",", "{")  # before the body
                if ")" in before and not initialises:
                    first = head + len(before) - len(before.lstrip())
                    line = code.count("\n", 0, first) + 1
                    found.append((line, code.count("\n", first, end) + 1))
                if not initialises:
                    head = end + 1
                i = end
        i += 1
    return found


class Sizes(unittest.TestCase):
    def test_mains_are_short(self) -> None:
        for path in sources("tools/"):
            if path.name == "main.cpp":
                lines = len((ROOT / path).read_text().splitlines())
                self.assertLessEqual(lines, MAX_MAIN_LINES, str(path))

    def test_files_of_cpp_are_short(self) -> None:
        for path in sources():
            if path.suffix == ".py":
                continue
            lines = len((ROOT / path).read_text().splitlines())
            self.assertLessEqual(lines, MAX_FILE_LINES, str(path))

    def test_functions_are_found(self) -> None:
        text = """namespace a {
int f(int x = 3,
      int y = 4) {
  return '{' + 1'000;
}
struct S {
  S() : x{1}, y(2) {
    if (x) {
    }
  }
  int x, y;
};
}  // namespace {
"""
        self.assertEqual(functions_of(text), [(2, 4), (7, 4)])

    def test_functions_are_short(self) -> None:
        for path in sources():
            if path.suffix == ".py" or path.name == "small_font.h":  # a table of glyphs
                continue
            for start, length in functions_of((ROOT / path).read_text()):
                self.assertLessEqual(length, MAX_FUNCTION_LINES, f"{path}:{start}")


class Prose(unittest.TestCase):
    def test_comments_and_pages(self) -> None:
        done = subprocess.run(
            [sys.executable, str(ROOT / "scripts/check_prose.py")],
            capture_output=True,
            text=True,
            check=False,
        )
        self.assertEqual(done.returncode, 0, done.stdout[-4000:] + done.stderr)


if __name__ == "__main__":
    unittest.main()
