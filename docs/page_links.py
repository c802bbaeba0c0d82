"""Lists the pages of the project and finds relative links in them that lead nowhere."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def pages() -> list[Path]:
    found = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "*.md"],
        cwd=ROOT,
        capture_output=True,
        text=True,
    ).stdout.splitlines()
    return [f for f in ([ROOT / f for f in found] or sorted(ROOT.glob("**/*.md"))) if f.exists()]


def prose(text: str) -> str:
    """The text without code, where brackets are no links."""
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M))


def anchors(file: Path) -> Iterator[str]:
    """Anchors of the file's headings by GitHub's rules: lower case, hyphens for blanks."""
    seen: dict[str, int] = {}
    for heading in re.findall(
        r"^#+ +(.*?) *$", re.sub(r"^```.*?^```", "", file.read_text(), flags=re.S | re.M), re.M
    ):
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        seen[name] = seen.get(name, -1) + 1
        yield f"{name}-{seen[name]}" if seen[name] else name


def broken_links(file: Path) -> Iterator[str]:
    for link in re.findall(r"\]\(([^)\s]+)\)", prose(file.read_text())):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (file.parent / path).resolve() if path else file
        if not target.exists():
            yield f"{link}: no such file"
        elif anchor and (target.suffix != ".md" or anchor not in anchors(target)):
            yield f"{link}: no such heading"
