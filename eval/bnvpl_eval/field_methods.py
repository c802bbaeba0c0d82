"""What the gathers, compensations and kinds of light do, for the page that compares them."""

import re
from typing import Any

from .settings import ROOT
from .tables import column, table

# Folders with the methods' theory.
PAGES = {
    "gathers": ROOT / "tools/render/gather",
    "compensations": ROOT / "tools/render/compensate",
    "kinds of light": ROOT / "transport/virtual_light",
}
KINDS = sorted(theory.parent.name for theory in PAGES["kinds of light"].glob("*/theory.md"))
SHAPES = (
    "Discs are VPLs, black or white squares receivers. A line is a shadow ray, a cross where it is "
    "blocked; a dashed line is light without a ray of its own. Colours tell clusters apart."
)


def paragraph(group: str, name: str) -> str:
    """The first paragraph of the method's theory, without marks."""
    text = (PAGES[group] / name.replace("-", "_") / "theory.md").read_text()
    words = next(block for block in text.split("\n\n") if not block.startswith("#"))
    words = re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", " ".join(words.split()))
    words = words.replace("`", "").replace("*", "")
    return words.removesuffix(":") + "." if words.endswith(":") else words


def explanation(gathers: list[str], compensations: list[str]) -> dict[str, Any]:
    """A table with a paragraph and a diagram for each gather, compensation and kind of light."""
    texts = [
        {"group": group, "name": name, "text": paragraph(group, name)}
        for group, names in zip(PAGES, (gathers, compensations, KINDS), strict=True)
        for name in names
    ]
    columns = [column("name", "method"), column("text", "what it does")]
    made = table("methods", "What the methods do", SHAPES, columns, texts)
    for row in made["rows"]:
        row["diagram"] = row["name"]
    return made
