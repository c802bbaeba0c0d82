#!/usr/bin/env python3
"""Compares the results of two builds of the tools, byte by byte.

    tests/bytes/bytes.py record --bin OLD/bin -o table.json   # records a build
    tests/bytes/bytes.py compare --bin NEW/bin table.json     # compares another build

Bits depend on the processor, so the table is recorded on the same machine, with a build of the
commit from which the work started. Each file has two hashes: one of its values (columns of a .vpl,
channels of an image), and one of the whole file, which also holds the record of the options.
`compare` fails when values differ; with --files also when whole files differ. --only TEXT limits it
to cases whose name contains the text. Scenes that are not in the project come from --shared, where
that exists.
"""

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy
import OpenImageIO

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "pipelines"))
import output_guard  # noqa: E402


def scenes(shared: Path) -> dict[str, tuple[Path, list[str]]]:
    """Scene file and options --define of every scene, by name, in the project and in `shared`."""
    found = {}
    for file in sorted(ROOT.glob("scenes/*/*.toml")):
        folder = file.parent.name
        defines = []
        if folder in ("sponza", "veach-ajar"):
            if not (shared / folder).exists():
                continue
            defines = ["--define", f"{folder.upper().replace('-', '_')}_DIR={shared / folder}"]
        found[f"{folder}/{file.stem}"] = (file, defines)
    for file in sorted(shared.glob("*/scene.toml")):
        found[f"shared/{file.parent.name}"] = (file, [])
    return found


# All variants run on these scenes, and the defaults on the others.
FULL = ("u-shape/scene", "cornell/scene", "test/quirks")


class Tools:
    """Runs the tools of one build. Commands have the options of this version."""

    def __init__(self, folder: str) -> None:
        self.folder = Path(folder).resolve()
        self.renames = self._renames()

    def run(self, tool: str, *arguments: object) -> tuple[int, str]:
        command = [str(self.folder / tool), "--quiet", *map(str, arguments)]
        for new, old in self.renames:
            for i in range(len(command) - len(new) + 1):
                if tuple(command[i : i + len(new)]) == new:
                    command[i : i + len(new)] = old
                    break
        done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT)
        return done.returncode, done.stderr

    def _renames(self) -> list[tuple[tuple[str, ...], tuple[str, ...]]]:
        """Pairs of options of this version and their spelling in an older build."""
        for help_option in "--help-all", "--help":  # an older build has only the second
            asked = subprocess.run(
                [self.folder / "vpl-render", help_option], capture_output=True, text=True
            )
            if asked.returncode == 0:
                break
        text = asked.stdout
        older: list[tuple[tuple[str, ...], tuple[str, ...]]] = []
        if "--fireflies" not in text:
            older += [
                (("--fireflies", "redistribute"), ("--specks", "spread")),
                (("--fireflies", "keep"), ("--specks", "keep")),
            ]
            older += [
                ((new,), (old,))
                for new, old in (("--reuse", "--sharers"), ("--allocate", "--balance"))
            ]
        if "--compensate" not in text:
            older.append((("--compensate", "none"), ("--near-field", "off")))
        return older


def hash_vpl(file: Path) -> str:
    """Hash of all columns and of the numbers of the header, without the provenance."""
    data = file.read_bytes()
    head = numpy.frombuffer(data, numpy.uint64, 16)
    columns = int(numpy.frombuffer(data, numpy.uint32, 1, 56)[0])
    values = hashlib.sha256(data[12:32] + data[64:88])
    for c in range(columns):
        entry = 128 + 64 * c
        offset, size = numpy.frombuffer(data, numpy.uint64, 2, entry + 32)
        values.update(data[int(offset) : int(offset + size)])
    return f"{int(head[2])} rows {values.hexdigest()[:16]}"


def hash_image(file: Path) -> str:
    image = OpenImageIO.ImageInput.open(str(file))
    spec = image.spec()
    pixels = image.read_image(OpenImageIO.FLOAT)
    image.close()
    values = hashlib.sha256()
    order = sorted(range(spec.nchannels), key=lambda c: str(spec.channelnames[c]))
    for c in order:
        values.update(
            spec.channelnames[c].encode() + numpy.ascontiguousarray(pixels[:, :, c]).tobytes()
        )
    return f"{spec.width}x{spec.height} {values.hexdigest()[:16]}"


def hashes(file: Path) -> dict[str, str]:
    values = hash_image(file) if file.suffix == ".exr" else hash_vpl(file)
    return {"values": values, "file": hashlib.sha256(file.read_bytes()).hexdigest()[:16]}


def cases(name: str) -> Iterator[tuple[str, str, list[str], str | None]]:
    """Yields in order: name of the file, tool, arguments after the scene, name of the input."""
    full = name in FULL
    count = "3k" if name == "u-shape/scene" else "1k"
    yield "candidates.vpl", "vpl-place", ["-n", "20k"], None
    yield "light.vpl", "vpl-place", ["-n", "1k", "--method", "light"], None
    variants: dict[str, list[str]] = {"vpls.vpl": [], "uniform.vpl": ["--density", "uniform"]}
    if full:
        variants["random.vpl"] = ["--method", "random", "--seed", "7"]
    for file, options in variants.items():
        yield file, "vpl-eliminate", ["-n", count, *options], "candidates.vpl"
    photons = ["--photons", "100k"]
    yield "lit.vpl", "vpl-estimate", photons, "vpls.vpl"
    yield "even.vpl", "vpl-estimate", [*photons, "--method", "even"], "vpls.vpl"
    if full:
        yield "uniform-lit.vpl", "vpl-estimate", photons, "uniform.vpl"
        yield "random-lit.vpl", "vpl-estimate", [*photons, "--emit-points", "0"], "random.vpl"
    film = ["--size", "80x60", "--spp", "2", "--layers", "all"]
    yield "image.exr", "vpl-render", film, "lit.vpl"
    yield "path.exr", "vpl-render", [*film, "--integrator", "path"], None
    if full:
        for gather in ("lightcuts", "all"):
            yield f"{gather}.exr", "vpl-render", [*film, "--gather", gather], "lit.vpl"
        yield (
            "many.exr",
            "vpl-render",
            ["--size", "33x21", "--spp", "70", "--layers", "all", "--seed", "3"],
            "lit.vpl",
        )
        yield "instant-radiosity.exr", "vpl-render", film, "light.vpl"
        yield "no-near-field.exr", "vpl-render", [*film, "--compensate", "none"], "uniform-lit.vpl"
        yield (
            "random.exr",
            "vpl-render",
            [*film, "--clamp", "1", "--error", "0.1", "--max-cut", "100"],
            "random-lit.vpl",
        )
        yield (
            "half.exr",
            "vpl-render",
            [*film, "--pixels", "half", "--only", "indirect"],
            "even.vpl",
        )
        yield (
            "light.exr",
            "vpl-render",
            [*film, "--integrator", "light", "--max-bounces", "5"],
            None,
        )
        yield "direct.exr", "vpl-render", [*film, "--integrator", "path", "--only", "direct"], None
    elif name.startswith("sponza"):
        yield "light.exr", "vpl-render", [*film, "--integrator", "light"], None


def run_scene(
    tools: Tools, name: str, scene: Path, defines: list[str], only: str | None
) -> dict[str, dict[str, str]]:
    table = {}
    with tempfile.TemporaryDirectory(prefix="bnvpl-bytes.") as name_of_folder:
        folder = Path(name_of_folder)
        for file, tool, options, source in cases(name):
            key = f"{name} {file}"
            if only and only not in key and file.endswith(".exr"):
                continue
            if source and not (folder / source).exists():
                continue
            inputs = [] if tool == "vpl-eliminate" else [scene, *defines]
            if source:
                inputs.append(folder / source)
            code, errors = tools.run(tool, *inputs, "-o", folder / file, *options)
            table[key] = (
                hashes(folder / file) if code == 0 else {"values": f"exit {code}", "file": ""}
            )
            if code not in (0, 3):  # exit code 3: a scene without places for VPLs, or without light
                print(f"{key}: {errors}", file=sys.stderr)
    return table


TABLE = output_guard.json_kind(
    "a table of bytes.py",
    lambda table: (
        isinstance(table, dict)
        and all(isinstance(row, dict) and {"values", "file"} & set(row) for row in table.values())
    ),
)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("record", "compare"))
    parser.add_argument("table", nargs="?", help="compare: made by record")
    parser.add_argument("-o", "--output", default="bytes.json", help="record: the table")
    parser.add_argument("--bin", required=True, help="folder of the executables")
    parser.add_argument("--shared", default=ROOT.parent / "shared/scenes", type=Path)
    parser.add_argument("--only", help="cases whose name holds this text")
    parser.add_argument("--files", action="store_true", help="compare: whole files too")
    options = parser.parse_intermixed_args()

    if options.what == "record":
        output_guard.or_exit(output_guard.check, options.output, TABLE, "-o")
    tools = Tools(options.bin)
    table: dict[str, dict[str, str]] = {}
    for name, (scene, defines) in scenes(options.shared.resolve()).items():
        if options.only and not any(options.only in f"{name} {c[0]}" for c in cases(name)):
            continue
        table.update(run_scene(tools, name, scene, defines, options.only))
        print(f"{name}: {len(table)} files so far", file=sys.stderr)
    if options.what == "record":
        output_guard.or_exit(
            output_guard.write, options.output, json.dumps(table, indent=1) + "\n", TABLE, "-o"
        )
        return 0
    kinds = ("values", "file") if options.files else ("values",)
    expected = json.loads(Path(options.table).read_text())
    different = 0
    for key, now in table.items():
        then = expected.get(key)
        for kind in kinds:
            if then is None or now[kind] != then[kind]:
                different += 1
                print(f"{key}: {kind} {now[kind]}, was {then[kind] if then else 'not there'}")
    if not options.only:
        missing = [key for key in expected if key not in table]
        different += len(missing)
        print("".join(f"{key}: was there\n" for key in missing), end="")
    print(f"{len(table)} files, {different} differences")
    return 1 if different or not table else 0


if __name__ == "__main__":
    sys.exit(main())
