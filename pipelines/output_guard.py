"""Outputs of the scripts: whole or absent, and over nothing but an older file of their kind, as those of the tools.

    write(options.svg, text, SVG, option="--svg", reads={"--model": options.model})

Refused is one line: file, problem; cure. A kind is told by content, whatever the name; an empty file is of every kind.
"""

import dataclasses
import json
import os
import pathlib
import re
import sys
import typing

HEAD = 4096  # bytes that tell a kind


class Refused(Exception):
    """One line: file, problem; cure."""


@dataclasses.dataclass(frozen=True)
class Kind:
    content: str  # "an SVG picture"
    begins: typing.Callable[[bytes], bool] | None  # of the first HEAD bytes
    whole: typing.Callable[[bytes], bool] | None = (
        None  # of all bytes, where the head tells too little
    )


def _svg(head):
    return head.startswith(b"<svg") or (head.startswith(b"<?xml") and b"<svg" in head)


def _csv(head):
    line = head.split(b"\n", 1)[0]
    return b"," in line and re.fullmatch(rb"[\w,.\r]+", line) is not None


def json_kind(content, fits):
    """A JSON file of which fits(value) tells whether it is of this kind."""

    def whole(data):
        try:
            return bool(fits(json.loads(data)))
        except (ValueError, RecursionError):
            return False

    return Kind(content, None, whole)


def json_object(content, *keys):
    return json_kind(
        content, lambda value: isinstance(value, dict) and all(key in value for key in keys)
    )


def text_kind(content, mark):
    """A text that begins with a mark of ours, or with one of several."""
    marks = (mark,) if isinstance(mark, str) else mark
    return Kind(content, lambda head: head.startswith(tuple(each.encode() for each in marks)))


SVG = Kind("an SVG picture", _svg)
PNG = Kind("a PNG picture", lambda head: head.startswith(b"\x89PNG\r\n\x1a\n"))
JPEG = Kind("a JPEG picture", lambda head: head.startswith(b"\xff\xd8\xff"))
EXR = Kind("an OpenEXR image", lambda head: head.startswith(b"\x76\x2f\x31\x01"))
HTML = Kind("an HTML page", lambda head: head.lower().startswith(b"<!doctype html"))
CSV = Kind("a CSV table", _csv)


def _is(file, kind):
    try:
        with open(file, "rb") as found:
            data = found.read(-1 if kind.whole else HEAD)
    except OSError:
        return True  # whoever replaces it reports that
    return not data or (kind.whole or kind.begins)(data)


def check(file, kind, option="", reads=None):
    """Refuses a file that is read, a folder, and a file of another kind. `reads`: {option: file}. Writes nothing."""
    file = pathlib.Path(file)
    if not file.exists():
        return
    if file.is_dir():
        raise Refused(f"{file}: is a folder; name a file for {option or kind.content}")
    if not file.is_file():
        return  # such as /dev/stdout
    for name, other in (reads or {}).items():
        if os.path.exists(other) and os.path.samefile(file, other):
            raise Refused(
                f"{file}: is the file of {name}, which the run reads; name another file"
                f"{f' for {option}' if option else ''}"
            )
    if not _is(file, kind):
        raise Refused(
            f"{file}: is not {kind.content}, which {option or 'this run'} would replace it with; "
            "name another file, or remove this one"
        )


def replace(file, kind, make, option="", reads=None):
    """The same for what others write: make(partial) writes a file beside, of the same extension."""
    check(file, kind, option, reads)
    target = pathlib.Path(os.path.realpath(file))  # a link stays one
    if target.exists() and not target.is_file():
        return make(target)
    partial = target.with_name(f".{target.stem}.partial-{os.getpid()}{target.suffix}")
    try:
        made = make(partial)
        os.replace(partial, target)
        return made
    finally:
        partial.unlink(missing_ok=True)


def write(file, data, kind, option="", reads=None):
    """Bytes or a text. Throws Refused, or OSError; the file is then as it was."""
    data = data.encode() if isinstance(data, str) else data
    replace(file, kind, lambda partial: partial.write_bytes(data), option, reads)


def or_exit(act, *arguments, program=""):
    """One of the above; its problem ends the program in one line, with exit code 1."""
    try:
        return act(*arguments)
    except Refused as problem:
        line = str(problem)
    except OSError as problem:
        line = f"{problem.filename}: cannot be written: {problem.strerror}"
    sys.exit(f"{program or pathlib.Path(sys.argv[0]).name}: {line}")
