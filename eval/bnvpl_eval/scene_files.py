"""The files that a scene consists of, and a key of their bytes."""

import gzip
import hashlib
import os
import re
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

NAMING = (".toml", ".pbrt", ".pbrt.gz", ".gltf", ".glb", ".obj", ".mtl")  # formats that name other files
LONGEST_NAME = 1024  # characters; what is longer holds data


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:20]


def _names(file: Path, data: bytes) -> Iterator[str]:
    """What may be the name of a file: strings in quotation marks, and ends of an MTL's lines."""
    text = data.decode(errors="replace")
    if file.suffix == ".obj":
        for line in re.findall(r"^\s*mtllib\s+(.*\S)", text, re.M):
            yield from (line, *line.split())
    elif file.suffix == ".mtl":
        for line in re.findall(r"^\s*(?:map_|bump|disp|decal|refl|norm)\S*\s+(.*\S)", text, re.M):
            words = line.split(" ")  # options stand before the name, which may have blanks
            yield from (" ".join(words[first:]) for first in range(len(words)))
    else:
        yield from re.findall(r'"([^"\n]*)"', text)
        if file.suffix == ".toml":  # whose literal strings have other marks
            yield from re.findall(r"'([^'\n]*)'", text)


def _named_by(file: Path, data: bytes, scene: Path) -> Iterator[Path]:
    """Files relative to the file that names them or, as in included pbrt files, to the scene."""
    for name in _names(file, data):
        for spelled in {os.path.expandvars(name), unquote(name)}:
            if not spelled or len(spelled) >= LONGEST_NAME or "\0" in spelled:
                continue
            for folder in {file.parent, scene.parent}:
                path = folder / spelled.replace("\\", "/")
                if path.is_file():
                    yield path.resolve()


def scene_key(scene: Path) -> str:
    """Hash of a scene's file and of all files that it names, directly or through others."""
    waiting = [scene.resolve()]
    keys: dict[Path, str] = {}
    while waiting:
        file = waiting.pop()
        if file in keys:
            continue
        data = file.read_bytes()
        keys[file] = digest(data)
        if file.name.endswith(NAMING):
            plain = gzip.decompress(data) if file.suffix == ".gz" else data
            waiting += _named_by(file, plain, scene.resolve())
    # Where the files lie has no effect: those who name them are hashed as well.
    return digest("".join(sorted(f"{file.name} {key}\n" for file, key in keys.items())).encode())
