#!/usr/bin/env python3
"""Makes the OBJ, MTL and PNG files of the project's own scenes, beside their scene.toml.

    scenes/generate.py           rewrite the files that differ
    scenes/generate.py --check   write nothing; exit 1 if a file differs or is missing

The bytes are the same on every machine: it uses only the standard library and writes six
significant digits.
"""

import argparse
import pathlib
import sys

sys.dont_write_bytecode = True
from generator import many_lights, rooms, teapot, test_scenes  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent


def made_files() -> dict[str, bytes]:
    """Bytes of the files, by their paths below scenes/."""
    made = {
        **teapot.files(HERE / "teapot"),
        **rooms.files(),
        **many_lights.files(),
        **test_scenes.files(),
    }
    return {name: data if isinstance(data, bytes) else data.encode() for name, data in made.items()}


def main() -> int:
    parser = argparse.ArgumentParser(description="Make the models of the project's own scenes.")
    parser.add_argument("--check", action="store_true", help="only compare; exit 1 on a difference")
    check = parser.parse_args().check
    stale = 0
    for name, data in made_files().items():
        path = HERE / name
        if path.is_file() and path.read_bytes() == data:
            continue
        stale += 1
        print(f"{'differs' if check else 'writing'}: scenes/{name}")
        if not check:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
    if check and stale:
        print("run scenes/generate.py", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
