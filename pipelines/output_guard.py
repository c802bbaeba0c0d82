"""Writes the outputs of scripts by the rules of the tools' outputs.

An output is whole or absent, and it replaces nothing but an older file of its kind:

    write(options.svg, text, SVG, option="--svg", reads={"--model": options.model})

The content of a file tells its kind, not its name. An empty file is of every kind.
"""

from __future__ import annotations

import dataclasses
import json
import os
import pathlib
import re
import signal
import sys
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar, Union

T = TypeVar("T")
File = Union[str, "os.PathLike[str]"]  # this way for Python 3.9, which nodes may have
HEAD = 4096  # number of leading bytes that tell a file's kind


class Refused(Exception):
    """A refusal in one line: file, problem; cure."""


@dataclasses.dataclass(frozen=True)
class Kind:
    content: str  # what messages call it, such as "an SVG picture"
    begins: Callable[[bytes], bool] | None  # tells the kind from the first HEAD bytes
    whole: Callable[[bytes], bool] | None = (
        None  # tells the kind from all bytes, if the head cannot
    )


def _svg(head: bytes) -> bool:
    return head.startswith(b"<svg") or (head.startswith(b"<?xml") and b"<svg" in head)


def _csv(head: bytes) -> bool:
    line = head.split(b"\n", 1)[0]
    return b"," in line and re.fullmatch(rb"[\w,.\r]+", line) is not None


def json_kind(content: str, fits: Callable[[Any], bool]) -> Kind:
    """A kind of JSON files; fits(value) tells whether the value of a file is of this kind."""

    def whole(data: bytes) -> bool:
        try:
            return bool(fits(json.loads(data)))
        except (ValueError, RecursionError):
            return False

    return Kind(content, None, whole)


def json_object(content: str, *keys: str) -> Kind:
    return json_kind(
        content, lambda value: isinstance(value, dict) and all(key in value for key in keys)
    )


def text_kind(content: str, mark: str | Iterable[str]) -> Kind:
    """A kind of texts that begin with a mark of this project, or with one of several."""
    marks = (mark,) if isinstance(mark, str) else mark
    return Kind(content, lambda head: head.startswith(tuple(each.encode() for each in marks)))


SVG = Kind("an SVG picture", _svg)
PNG = Kind("a PNG picture", lambda head: head.startswith(b"\x89PNG\r\n\x1a\n"))
JPEG = Kind("a JPEG picture", lambda head: head.startswith(b"\xff\xd8\xff"))
EXR = Kind("an OpenEXR image", lambda head: head.startswith(b"\x76\x2f\x31\x01"))
HTML = Kind("an HTML page", lambda head: head.lower().startswith(b"<!doctype html"))
CSV = Kind("a CSV table", _csv)


def _is(file: pathlib.Path, kind: Kind) -> bool:
    try:
        with open(file, "rb") as found:
            data = found.read(-1 if kind.whole else HEAD)
    except OSError:
        return True  # the caller reports this error when it replaces the file
    tells = kind.whole or kind.begins
    return not data or (tells is not None and tells(data))


def check(
    file: File, kind: Kind, option: str = "", reads: Mapping[str, File] | None = None
) -> None:
    """Raises Refused where `file` is an input, a folder, or a file of another kind.

    `reads` maps options to the files that the run reads. Nothing is written.
    """
    file = pathlib.Path(file)
    if not file.exists():
        return
    if file.is_dir():
        raise Refused(f"{file}: is a folder; name a file for {option or kind.content}")
    if not file.is_file():
        return  # a device such as /dev/stdout
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


def replace(
    file: File,
    kind: Kind,
    make: Callable[[pathlib.Path], T],
    option: str = "",
    reads: Mapping[str, File] | None = None,
) -> T:
    """Checks `file`, then replaces it by the file that make(partial) writes beside it.

    `partial` has the extension of `file`. Returns what `make` returns.
    """
    check(file, kind, option, reads)
    target = pathlib.Path(os.path.realpath(file))  # a symbolic link keeps its place
    if target.exists() and not target.is_file():
        return make(target)
    partial = target.with_name(f".{target.stem}.partial-{os.getpid()}{target.suffix}")
    try:
        made = make(partial)
        os.replace(partial, target)
        return made
    finally:
        partial.unlink(missing_ok=True)


def write(
    file: File,
    data: str | bytes,
    kind: Kind,
    option: str = "",
    reads: Mapping[str, File] | None = None,
) -> None:
    """Writes bytes or a text. Raises Refused or OSError, and then leaves the file as it was."""
    content = data.encode() if isinstance(data, str) else data
    replace(file, kind, lambda partial: partial.write_bytes(content), option, reads)


def or_exit(act: Callable[..., T], *arguments: Any, program: str = "") -> T:
    """Calls a function of this module. Refused and OSError become one line and exit code 1."""
    try:
        return act(*arguments)
    except Refused as problem:
        line = str(problem)
    except OSError as problem:
        line = f"{problem.filename}: cannot be written: {problem.strerror}"
    sys.exit(f"{program or pathlib.Path(sys.argv[0]).name}: {line}")


def make_folder(folder: str | pathlib.Path, option: str = "") -> None:
    """Makes a folder and those above it. Raises Refused where a file is in the way, or OSError."""
    try:
        pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        raise Refused(
            f"{folder}: is no folder, or is below a file; name another folder"
            f"{f' for {option}' if option else ''}"
        ) from None


def run(main: Callable[..., None], *arguments: Any) -> None:
    """Runs the main function of a program. Refused and OSError become one line and exit code 1."""
    program = pathlib.Path(sys.argv[0]).name
    try:
        main(*arguments)
    except Refused as problem:
        sys.exit(f"{program}: {problem}")
    except BrokenPipeError:  # the reader of the output has left, so Python prints no more
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(128 + signal.SIGPIPE)
    except OSError as problem:
        where = f"{problem.filename}: " if problem.filename else ""
        sys.exit(
            f"{program}: {where}{problem.strerror or problem}; check the name and the rights to it"
        )
