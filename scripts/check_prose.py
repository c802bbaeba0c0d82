#!/usr/bin/env python3
"""Checks the prose of the project: comments, docstrings and pages of documentation.

    scripts/check_prose.py [PATH...]

Without PATH, every tracked file is read. Each finding is one line, FILE:LINE: problem, and any
finding makes the exit status 1. The rules:

- No comment begins with "Of", "By" or "As"; no trailing comment begins with "of".
- Outside docs/lab/ and CHANGELOG.md nothing names a commit, a date or an earlier state. They are
  the history's.
- In the README, the guide, the options' help and the theory pages no sentence has more than 35
  words.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MAX_WORDS = 35

SLASHED = {".cpp", ".h", ".in"}
HASHED = {".py", ".sh", ".cmake", ".toml", ".yml"}
LONG_SENTENCES_ARE_FOUND_IN = re.compile(
    r"^README\.md$|^docs/(guide|options|theory)\.md$|/theory\.md$"
)
HISTORY_IS_TOLD_IN = re.compile(r"^docs/lab/|^CHANGELOG\.md$")

OPENING = re.compile(r"(Of|By|As)\b")
COMMIT = re.compile(r"\b(?=[0-9a-f]*[a-f])(?=[0-9a-f]*[0-9])[0-9a-f]{7,40}\b")
DATE = re.compile(r"\b20[0-9]{2}-[01][0-9]-[0-3][0-9]\b")
FORMER = re.compile(r"\b(formerly|former|used to be|before it was|no longer)\b", re.IGNORECASE)

Block = tuple[int, str, bool]  # first line, text, whether it stands behind code


def slashed_comments(text: str) -> Iterator[Block]:
    """Comments of C++: runs of // lines are one block. Strings are skipped."""
    token = re.compile(
        r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|//[^\n]*|/\*.*?\*/', re.DOTALL
    )
    run: list[str] = []
    first = last = 0
    for match in token.finditer(text):
        if not match[0].startswith("/"):
            continue
        line = text.count("\n", 0, match.start()) + 1
        start = text.rfind("\n", 0, match.start()) + 1
        trailing = bool(text[start : match.start()].strip())
        body = match[0].lstrip("/*").rstrip("*/").lstrip("<!").strip()
        if run and (trailing or line != last + 1):
            yield first, " ".join(run), False
            run = []
        if trailing:
            yield line, body, True
            continue
        if not run:
            first = line
        run.append(body)
        last = line + match[0].count("\n")
    if run:
        yield first, " ".join(run), False


def hashed_comments(text: str) -> Iterator[Block]:
    """Comments of shell, CMake, TOML and YAML."""
    run: list[str] = []
    first = 0
    for number, line in enumerate(text.splitlines() + [""], 1):
        bare = line.strip()
        if bare.startswith("#") and not bare.startswith("#!"):
            if not run:
                first = number
            run.append(bare.lstrip("#").strip())
            continue
        if run:
            yield first, " ".join(run), False
            run = []
        trailing = re.search(r"\s#\s(.*)$", line)
        if trailing:
            yield number, trailing[1], True


def python_comments(path: Path) -> Iterator[Block]:
    """Comments and docstrings of Python."""
    with tokenize.open(path) as file:
        text = file.read()
    run: list[str] = []
    first = last = 0
    lines = text.splitlines()
    before = tokenize.NEWLINE
    for token in tokenize.generate_tokens(iter(text.splitlines(keepends=True)).__next__):
        line = token.start[0]
        if token.type == tokenize.COMMENT:
            body = token.string.lstrip("#!").strip()
            trailing = bool(lines[line - 1][: token.start[1]].strip())
            if run and (trailing or line != last + 1):
                yield first, " ".join(run), False
                run = []
            if trailing:
                yield line, body, True
                continue
            if not run:
                first = line
            run.append(body)
            last = line
        elif token.type == tokenize.STRING and before in (
            tokenize.NEWLINE,
            tokenize.INDENT,
            tokenize.ENCODING,
        ):
            yield line, token.string.strip("rR\"'").strip(), False
        if token.type not in (tokenize.NL, tokenize.COMMENT):
            before = token.type
    if run:
        yield first, " ".join(run), False


def paragraphs(text: str) -> Iterator[Block]:
    """Prose of Markdown: paragraphs, list items and table cells, without code and formulas."""
    run: list[str] = []
    first = 0
    fenced = False
    for number, line in enumerate(text.splitlines() + [""], 1):
        bare = line.strip()
        if bare.startswith(("```", "$$")):
            fenced = (
                not fenced
                if not (bare.startswith("$$") and bare.endswith("$$") and len(bare) > 3)
                else fenced
            )
            bare = ""
        elif fenced or line.startswith("    ") and not run:
            continue
        starts = re.match(r"([-*+]|\d+\.)\s|#", bare)
        if run and (not bare or starts or bare.startswith(("|", "<"))):
            yield first, " ".join(run), False
            run = []
        if bare.startswith("|"):
            for cell in re.split(r"(?<!\\)\|", bare):
                yield number, cell, False
        elif bare and not bare.startswith("<"):
            if not run:
                first = number
            run.append(bare)


def without_code(text: str) -> str:
    text = re.sub(r"`[^`]*`", "x", text)
    text = re.sub(r"\$[^$]*\$", "x", text)
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)


def blocks_of(path: Path, name: str) -> Iterator[Block]:
    if path.suffix == ".md":
        return paragraphs(path.read_text())
    if path.suffix == ".py":
        return python_comments(path)
    if path.suffix in SLASHED:
        return slashed_comments(path.read_text())
    if path.suffix in HASHED or path.name in ("CMakeLists.txt", "Makefile"):
        return hashed_comments(path.read_text())
    return iter(())


def problems_of(path: Path, name: str) -> Iterator[tuple[int, str]]:
    for line, text, trailing in blocks_of(path, name):
        if path.suffix != ".md":
            opening = OPENING.match(text)
            if opening:
                yield (
                    line,
                    f'a comment begins with "{opening[1]}": give the sentence its subject first',
                )
            if trailing and text.startswith("of "):
                yield line, 'a trailing comment begins with "of": name the thing itself'
        if not HISTORY_IS_TOLD_IN.search(name):
            plain = without_code(text)
            for pattern, what in (
                (COMMIT, "a commit"),
                (DATE, "a date"),
                (FORMER, "a former state"),
            ):
                found = pattern.search(plain)
                if found:
                    yield line, f'"{found[0]}" is {what}: it belongs into CHANGELOG.md or docs/lab/'
        if LONG_SENTENCES_ARE_FOUND_IN.search(name):
            for sentence in re.split(r"(?<=[.!?:;])\s+", without_code(text)):
                count = len(re.findall(r"\w[\w'’-]*", sentence))
                if count > MAX_WORDS:
                    yield (
                        line,
                        f'a sentence has {count} words, at most {MAX_WORDS}: "{sentence[:60]}…"',
                    )


def tracked_files() -> list[str]:
    """Names of the project's files; without git those outside of build folders."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, check=False, capture_output=True
    )
    if listed.returncode == 0:
        return [name for name in listed.stdout.decode().split("\0") if name]
    names = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
    return sorted(str(n) for n in names if n.parts[0] not in ("build", "out", ".git"))


def main() -> int:
    names = [
        str(Path(name).resolve().relative_to(ROOT)) for name in sys.argv[1:]
    ] or tracked_files()
    found = 0
    for name in names:
        path = ROOT / name
        if not path.is_file() or "third_party" in path.parts:
            continue
        for line, problem in problems_of(path, name):
            print(f"{name}:{line}: {problem}")
            found += 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
