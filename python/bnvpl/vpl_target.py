"""Where an output goes. What the tools would not replace is refused here as well."""

from __future__ import annotations

import errno
import os
from pathlib import Path

from . import layout as at
from .columns import STAGES

MAX_LINKS = 40  # the kernel's limit
ANOTHER = "name another file, or remove this one"


def _links(path: Path) -> list[Path]:
    """The path and the targets of its chain of links."""
    chain = [path]
    while chain[-1].is_symlink() and len(chain) <= MAX_LINKS:
        chain.append(chain[-1].parent / chain[-1].readlink())
    return chain


def _is_stream(path: Path) -> bool:
    """Whether the path is in /proc, where /dev/stdout leads: a process holds the file open."""
    return Path(os.path.realpath(path.parent)).is_relative_to("/proc")


def _check_folder(path: Path, folder: Path) -> None:
    problem = 0 if folder.is_dir() else errno.ENOTDIR if folder.exists() else errno.ENOENT
    if not problem and not os.access(folder, os.W_OK | os.X_OK):
        problem = errno.EACCES
    if problem:
        cure = "choose a folder that exists and is writable"
        raise named(OSError(problem, os.strerror(problem)), f"{path}: cannot write", cure)


def _check_content(path: Path, place: Path, stage: str) -> None:
    """A file that holds no VPLs, or those of another stage, may be somebody's work."""
    with place.open("rb") as file:
        start = file.read(at.STAGE_AT + 4)
    if start and not start.startswith(at.MAGIC):
        raise FileExistsError(f"{path}: exists and is no .vpl file; {ANOTHER}")
    number = int.from_bytes(start[at.STAGE_AT :], "little")
    if 1 <= number <= len(STAGES) and STAGES[number - 1] != stage:
        raise FileExistsError(
            f"{path}: holds VPLs of stage {STAGES[number - 1]}, not {stage}; {ANOTHER}"
        )


def named(error: OSError, before: str, after: str) -> OSError:
    """An error of the same class whose message is "before: reason; after"."""
    result = type(error)(f"{before}: {error.strerror or error}; {after}")
    result.errno = error.errno
    return result


def replaceable(path: Path, stage: str) -> Path:
    """The file at the end of the path's links, which VPLs of the stage may replace.

    Raises OSError where they may not.
    """
    chain = _links(path)
    if any(map(_is_stream, chain)):
        raise FileExistsError(
            f"{path}: is an open stream; outputs go to files, which are replaced whole; name a file"
        )
    place = Path(os.path.realpath(path))
    if chain[-1].is_symlink():
        raise FileExistsError(f"{path}: is a loop of links; name a file")
    if place.is_dir():
        raise IsADirectoryError(f"{path}: is a folder; name a file")
    _check_folder(path, place.parent)
    if not place.exists():
        return place
    if not place.is_file():
        raise FileExistsError(
            f"{path}: is a device or pipe, which cannot be replaced; name a file"
        )
    if not os.access(place, os.W_OK):
        raise PermissionError(f"{path}: is read-only; make it writable, or name another file")
    if os.access(place, os.R_OK):
        _check_content(path, place, stage)
    return place
