#!/usr/bin/env python3
r"""Compares all stages on emulated processors with this machine's processor.

    tests/bytes/processors.py --bin build/release/bin
    tests/bytes/processors.py --bin build/release/bin --scene scenes/cornell/scene.toml -n 20k \
        --photons 1M --size 128x96

With --processor any, all files must have the same bytes on all processors, and shards of different
processors must merge to the file of one run. Without it, files may differ. Then the processor ids
must differ too, and vpl-merge must refuse the mixture and name both ids. Each stage reads files
that this machine's processor has made, so a difference arises in that stage.

Prints a line for each processor, and fails with exit code 1 where that does not hold. Exit code 77
means that qemu-x86_64 of Debian's package qemu-user is not installed.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
QEMU = "qemu-x86_64"
# The setting for which --processor any restarts a tool. An emulated tool has it from the start, as
# a restart would leave the emulator.
PINNED = "glibc.cpu.hwcaps=-FMA,-FMA4"
HERE = "this machine"


class Processor:
    """Runs the tools on a processor, in a folder of its own. `mode` is the value of --processor."""

    def __init__(self, name: str, mode: str, options: argparse.Namespace, folder: Path) -> None:
        self.name, self.mode, self.options = name, mode, options
        self.folder = folder / f"{name}-{mode}".replace(" ", "-")
        self.folder.mkdir()
        self.part = 1 if name == HERE else 2  # which of two shards it makes
        self.prefix = [] if name == HERE else [QEMU, "-cpu", name]
        self.environment = {k: v for k, v in os.environ.items() if k != "GLIBC_TUNABLES"}
        if mode == "any" and name != HERE:
            self.environment["GLIBC_TUNABLES"] = PINNED

    def start(
        self, tool: str, *arguments: object, prefix: list[str] | None = None
    ) -> subprocess.CompletedProcess[str]:
        command = [*(prefix or self.prefix), str(self.options.bin / tool), *map(str, arguments)]
        if tool != "vpl-merge":
            command += ["--processor", self.mode]
        return subprocess.run(
            command, env=self.environment, capture_output=True, text=True, check=False
        )

    def run(self, tool: str, *arguments: object) -> None:
        result = self.start(tool, "--quiet", *arguments)
        if result.returncode:
            sys.exit(
                f"{self.name}: {tool} {' '.join(map(str, arguments))}: exit code "
                f"{result.returncode}: "
                f"{result.stderr}"
            )

    def stages(self, inputs: Path) -> list[tuple[str, str, list[Any]]]:
        """Output, tool and arguments of each stage, which reads from the folder `inputs`."""
        o = self.options
        return [
            ("candidates.vpl", "vpl-place", [o.scene, "-n", o.candidates]),
            ("vpls.vpl", "vpl-eliminate", [inputs / "candidates.vpl", "-n", o.vpls]),
            ("lit.vpl", "vpl-estimate", [o.scene, inputs / "vpls.vpl", "--photons", o.photons]),
            (
                "image.exr",
                "vpl-render",
                [o.scene, inputs / "lit.vpl", "--size", o.size, "--spp", "1"],
            ),
            (
                "path.exr",
                "vpl-render",
                [o.scene, "--integrator", "path", "--size", o.size, "--spp", "1"],
            ),
        ]

    def make(self, inputs: Path) -> None:
        for product, tool, arguments in self.stages(inputs):
            self.run(tool, *arguments, "-o", self.folder / product)
            if product != "vpls.vpl":
                self.run(tool, *arguments, "--shard", f"{self.part}/2", "-o", self.shard(product))

    def shard(self, product: str) -> Path:
        return self.folder / f"{product}.{self.part}.shard"

    def id(self) -> str:
        shard = self.shard("candidates.vpl")
        info = subprocess.run(
            [self.options.bin / "vpl-inspect", "info", "--json", shard],
            capture_output=True,
            text=True,
            check=True,
        )
        result: str = json.loads(info.stdout)["processor"]
        return result


def same(a: Path, b: Path) -> bool:
    return a.read_bytes() == b.read_bytes()


class Check:
    def __init__(self) -> None:
        self.failed = False

    def require(self, holds: bool, problem: str) -> None:
        if not holds:
            print(f"FAILED: {problem}")
            self.failed = True


def compare(check: Check, home: Processor, other: Processor) -> None:
    """Compares the files of `other` with those of `home`, and merges shards of both."""
    products = [product for product, _, _ in home.stages(home.folder)]
    differ = [p for p in products if not same(home.folder / p, other.folder / p)]
    print(
        f"{other.name}, --processor {other.mode}: id {other.id()}, "
        f"{'differs: ' + ', '.join(differ) if differ else 'the same bytes'}",
        flush=True,
    )
    if home.mode == "any":
        check.require(not differ, f"{other.name}: other bytes than {home.name}")
    check.require(
        not differ or home.id() != other.id(), f"{other.name}: other bytes under the same id"
    )
    for product in products:
        first, second = home.shard(product), other.shard(product)
        if product == "vpls.vpl":
            continue
        merged = other.folder / f"merged-{product}"
        result = home.start("vpl-merge", "--quiet", first, second, "-o", merged)
        if home.id() == other.id():
            check.require(
                result.returncode == 0 and same(merged, home.folder / product),
                f"{other.name}: merged {product} is not that of one run {result.stderr}",
            )
        else:
            named = (
                home.id() in result.stderr
                and other.id() in result.stderr
                and str(second) in result.stderr
            )
            check.require(
                result.returncode == 3 and named,
                f"{other.name}: {product} of two processors is not refused",
            )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument(
        "--bin", type=lambda text: Path(text).resolve(), default=ROOT / "build/release/bin"
    )
    parser.add_argument("--scene", type=Path, default=ROOT / "scenes/u-shape/scene.toml")
    parser.add_argument(
        "--processors", default="Nehalem,Haswell,max", help=f"as {QEMU} -cpu help lists them"
    )
    parser.add_argument("-n", "--candidates", default="2k")
    parser.add_argument("--vpls", default="200")
    parser.add_argument("--photons", default="20k")
    parser.add_argument("--size", default="32x24")
    options = parser.parse_args()
    if not shutil.which(QEMU):
        print(f"{QEMU} is not installed: skipped")
        sys.exit(77)
    check = Check()
    with tempfile.TemporaryDirectory() as folder:
        for mode in ("this", "any"):
            home = Processor(HERE, mode, options, Path(folder))
            home.make(home.folder)
            print(f"{HERE}, --processor {mode}: id {home.id()}", flush=True)
            for name in options.processors.split(","):
                other = Processor(name, mode, options, Path(folder))
                traced = other.start(
                    "vpl-place",
                    options.scene,
                    "-n",
                    "1",
                    "-o",
                    other.folder / "x.vpl",
                    prefix=[*other.prefix, "-strace"],
                )
                check.require(
                    traced.returncode == 0 and "execve(" not in traced.stderr,
                    f"{name}: the tool left its emulator",
                )
                other.make(home.folder)
                compare(check, home, other)
    sys.exit(1 if check.failed else 0)


if __name__ == "__main__":
    main()
