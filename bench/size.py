#!/usr/bin/python3
"""Measures time and memory of the stages as triangles, candidates, VPLs and lights grow in number.

    bench/size.py                          the core parts: about four minutes and 3 GiB
    bench/size.py --parts lights,vpls      some parts
    bench/size.py --most 0.01              a hundredth of each size, as a quick test
    bench/size.py --parts instances,many_vpls,shard,file,hundredth
                                           the largest parts: fifteen minutes, 14 GiB, 5 GB of disk
    bench/size.py --cpu ...                CPU seconds of all threads, for a busy machine

The output is Markdown. docs/lab/ has figures.
"""

import argparse
import json
import math
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
U_SHAPE = ROOT / "scenes/u-shape/scene.toml"
CORE_PARTS = ("triangles", "candidates", "vpls", "lights")
LARGE_PARTS = ("instances", "many_vpls", "shard", "file", "hundredth")
BUMPY = 224  # squares along the side of the instanced mesh, which has 100k triangles
MTL = "newmtl grey\nKd 0.6 0.6 0.6\nnewmtl lamp\nKd 0 0 0\nKe 20 20 20\n"
CAMERA = """[film]
width = 64
height = 48
[camera]
position = [0.0, 0.5, 0.9]
look_at = [0.0, 0.5, 0.0]
up = [0.0, 1.0, 0.0]
vertical_fov_deg = 70.0
[[mesh]]
file = "size.obj"
"""


def cpu_of_children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


class Size:
    def __init__(self, options: argparse.Namespace, folder: Path) -> None:
        self.bin, self.most, self.cpu, self.folder = options.bin, options.most, options.cpu, folder

    def run(self, tool: str, *words: object) -> tuple[float, float]:
        """Runs a tool. Returns its seconds and peak memory in MiB."""
        stats, before = self.folder / "stats.json", cpu_of_children()
        done = subprocess.run(
            [str(w) for w in (self.bin / tool, *words, "--quiet", "--stats", stats)],
            capture_output=True,
            text=True,
        )
        if done.returncode != 0:
            sys.exit(f"size.py: {done.stderr.strip()}")
        found = json.loads(stats.read_text())
        return cpu_of_children() - before if self.cpu else found["time_s"], found["peak_memory_MiB"]

    def sizes(self, *full: int) -> list[int]:
        return [max(1, round(n * self.most)) for n in full]

    def room(self, triangles: int, lamps: int, lights: int) -> Path:
        """Writes a wavy floor and ceiling, lamps below the ceiling, and point lights in between."""
        side = max(1, round(math.sqrt(triangles / 4)))
        with open(self.folder / "size.obj", "w") as obj:
            obj.write("mtllib size.mtl\nusemtl grey\n")
            for base in (0.0, 1.0):
                for j in range(side + 1):
                    z = 2 * j / side - 1
                    wave = 0.03 * math.cos(9 * z)
                    obj.write(
                        "".join(
                            f"v {2 * i / side - 1:.7f} "
                            f"{base + wave * math.sin(9 * i / side):.7f} {z:.7f}\n"
                            for i in range(side + 1)
                        )
                    )
            for first, (a, b) in ((1, (1, side + 1)), ((side + 1) ** 2 + 1, (side + 1, 1))):
                for j in range(side):
                    row = first + j * (side + 1)
                    obj.write(
                        "".join(
                            f"f {row + i} {row + i + b} {row + i + a}\nf {row + i + a} "
                            f"{row + i + b} "
                            f"{row + i + side + 2}\n"
                            for i in range(side)
                        )
                    )
            obj.write("usemtl lamp\n")
            columns = max(1, math.ceil(math.sqrt(lamps)))
            for k in range(lamps):
                x, z = (2 * (v + 0.3) / columns - 1 for v in (k % columns, k // columns))
                obj.write(
                    f"v {x} 0.9 {z}\nv {x + 0.3 / columns} 0.9 {z}\nv {x} 0.9 "
                    f"{z + 0.3 / columns}\nf -3 -2 -1\n"
                )
        (self.folder / "size.mtl").write_text(MTL)
        toml = CAMERA
        for k in range(lights):
            angle = 2.4 * k  # a multiple of the golden angle keeps the lights apart
            r = 0.9 * math.sqrt((k + 0.5) / lights)
            toml += (
                '[[light]]\ntype = "point"\n'
                f"position = [{r * math.cos(angle):.6f}, 0.5, {r * math.sin(angle):.6f}]\n"
                f"intensity = [{1 / lights}, {1 / lights}, {1 / lights}]\n"
            )
        (self.folder / "size.toml").write_text(toml)
        return self.folder / "size.toml"

    def triangles(self) -> None:
        print("\n| triangles | vpl-place -n 10k: s | MiB |\n|---|---|---|")
        for n in self.sizes(100_000, 1_000_000, 10_000_000):
            scene = self.room(n, 0, 1)
            s, mib = self.run("vpl-place", scene, "-o", self.folder / "c.vpl", "-n", "10k")
            print(f"| {n} | {s:.2f} | {mib:.0f} |", flush=True)

    def candidates(self) -> None:
        print(
            "\n| candidates | vpl-place: s | MiB | vpl-eliminate, a fifth, uniform: s | MiB | "
            "local: s | MiB |\n"
            "|---|---|---|---|---|---|---|"
        )
        for n in self.sizes(1_250_000, 5_000_000, 20_000_000):
            c, v = self.folder / "c.vpl", self.folder / "v.vpl"
            row = [*self.run("vpl-place", U_SHAPE, "-o", c, "-n", n)]
            for density in ("uniform", "local"):
                row += self.run(
                    "vpl-eliminate", c, "-o", v, "-n", max(1, n // 5), "--density", density
                )
            print(f"| {n} | " + " | ".join(f"{x:.4g}" for x in row) + " |", flush=True)

    def vpls(self) -> None:
        print(
            "\n| VPLs | vpl-estimate, 1M photons: s | MiB | vpl-render, 64x48, 1 spp: s | MiB "
            "|\n|---|---|---|---|---|"
        )
        for n in self.sizes(10_000, 100_000, 1_000_000):
            c, v, lit = (self.folder / f"{x}.vpl" for x in "cvl")
            self.run("vpl-place", U_SHAPE, "-o", c, "-n", 5 * n)
            self.run("vpl-eliminate", c, "-o", v, "-n", n)
            row = [
                *self.run("vpl-estimate", U_SHAPE, v, "-o", lit, "--photons", "1M"),
                *self.run(
                    "vpl-render",
                    U_SHAPE,
                    lit,
                    "-o",
                    self.folder / "i.exr",
                    "--size",
                    "64x48",
                    "--spp",
                    "1",
                ),
            ]
            print(f"| {n} | " + " | ".join(f"{x:.4g}" for x in row) + " |", flush=True)

    def lights(self) -> None:
        print(
            "\n| lights | vpl-estimate, 1M photons: s | path tracer, 64x48, 16 spp: s | MiB "
            "|\n|---|---|---|---|"
        )
        kinds: list[tuple[str, Callable[[int], Path], list[int]]] = [
            ("point lights", lambda n: self.room(10_000, 0, n), self.sizes(10, 100, 1000)),
            ("emissive triangles", lambda n: self.room(10_000, n, 0), self.sizes(64, 512, 4096)),
        ]
        for kind, make, sizes in kinds:
            for n in sizes:
                scene = make(n)
                c, v, lit = (self.folder / f"{x}.vpl" for x in "cvl")
                self.run("vpl-place", scene, "-o", c, "-n", "10k")
                self.run("vpl-eliminate", c, "-o", v, "-n", "1k")
                estimate, _ = self.run("vpl-estimate", scene, v, "-o", lit, "--photons", "1M")
                path, mib = self.run(
                    "vpl-render",
                    scene,
                    "-o",
                    self.folder / "i.exr",
                    "--integrator",
                    "path",
                    "--spp",
                    "16",
                )
                print(f"| {n} {kind} | {estimate:.2f} | {path:.2f} | {mib:.0f} |", flush=True)

    def instances(self) -> None:
        """Measures many instances of a bumpy sheet, in a scene of pbrt's format."""
        n = BUMPY
        points = " ".join(
            f"{i / n:.6g} {0.05 * math.sin(40 * i / n) * math.cos(40 * j / n):.6g} {j / n:.6g}"
            for j in range(n + 1)
            for i in range(n + 1)
        )
        corners = ((j * (n + 1) + i, (j + 1) * (n + 1) + i) for j in range(n) for i in range(n))
        indices = " ".join(f"{a} {b} {a + 1} {a + 1} {b} {b + 1}" for a, b in corners)
        print(
            "\n| triangles, of 100k stored | vpl-place -n 10k: s | MiB | path tracer, 64x48, 1 "
            "spp: s | MiB |\n|---|---|---|---|---|"
        )
        for copies in self.sizes(1, 20, 500, 5000):
            side = math.ceil(math.sqrt(copies))
            placed = "".join(
                f"AttributeBegin Translate {k % side} {0.2 * (k % 5)} {k // side} ObjectInstance "
                '"sheet" AttributeEnd\n'
                for k in range(copies)
            )
            scene = self.folder / "instances.pbrt"
            scene.write_text(
                f'LookAt {side / 2} 3 {-1} {side / 2} 0 {side / 2} 0 1 0\nCamera "perspective" '
                '"float fov" 60\n'
                'Film "rgb" "integer xresolution" 64 "integer yresolution" 48\nWorldBegin\n'
                f'LightSource "point" "point3 from" [{side / 2} 5 {side / 2}] "rgb I" [{side**2} '
                f"{side**2} {side**2}]\n"
                'Material "diffuse" "rgb reflectance" [.6 .6 .6]\nObjectBegin "sheet"\n'
                f'Shape "trianglemesh" "point3 P" [{points}] "integer indices" '
                f"[{indices}]\nObjectEnd\n{placed}"
            )
            place = self.run("vpl-place", scene, "-o", self.folder / "c.vpl", "-n", "10k")
            path = self.run(
                "vpl-render",
                scene,
                "-o",
                self.folder / "i.exr",
                "--integrator",
                "path",
                "--spp",
                "1",
            )
            print(
                f"| {2 * n * n * copies / 1e6:.1f}M | "
                + " | ".join(f"{x:.4g}" for x in (*place, *path))
                + " |",
                flush=True,
            )

    def many_vpls(self) -> None:
        """Measures many VPLs. vpl-place --method light makes them lit, so their number is free."""
        print(
            "\n| VPLs from the lamp | vpl-place: s | MiB | vpl-render, 64x48, 1 spp, no near "
            "field: s | MiB |\n|---|---|---|---|---|"
        )
        for n in self.sizes(100_000, 1_000_000, 10_000_000):
            lit = self.folder / "l.vpl"
            place = self.run("vpl-place", U_SHAPE, "--method", "light", "-o", lit, "-n", n)
            render = self.run(
                "vpl-render",
                U_SHAPE,
                lit,
                "-o",
                self.folder / "i.exr",
                "--size",
                "64x48",
                "--spp",
                "1",
                "--compensate",
                "none",
            )
            print(
                f"| {n} | " + " | ".join(f"{x:.4g}" for x in (*place, *render)) + " |", flush=True
            )

    def shard(self) -> None:
        """Measures one of 100 shards of 10^10 photons, a number above 2^32."""
        c, v, part = (self.folder / f"{x}" for x in ("c.vpl", "v.vpl", "1.shard"))
        self.run("vpl-place", U_SHAPE, "-o", c, "-n", "100k")
        self.run("vpl-eliminate", c, "-o", v, "-n", "3k")
        print(
            "\n| photons, one of 100 shards, guarded | s | MiB | all shards, s, were each like "
            "it |\n|---|---|---|---|"
        )
        for photons in self.sizes(10**9, 10**10):
            s, mib = self.run(
                "vpl-estimate",
                U_SHAPE,
                v,
                "-o",
                part,
                "--method",
                "guarded",
                "--photons",
                photons,
                "--shard",
                "37/100",
            )
            print(f"| {photons} | {s:.2f} | {mib:.0f} | {100 * s:.0f} |", flush=True)

    def file(self) -> None:
        """Measures writing and reading a file above 4 GiB."""
        c = self.folder / "c.vpl"
        print(
            "\n| candidates | file, bytes | vpl-place: s | MiB | vpl-inspect check: s | MiB "
            "|\n|---|---|---|---|---|---|"
        )
        for n in self.sizes(110_000_000):
            place = self.run("vpl-place", U_SHAPE, "-o", c, "-n", n)
            read = self.run("vpl-inspect", "check", c)
            print(
                f"| {n} | {c.stat().st_size} | "
                + " | ".join(f"{x:.4g}" for x in (*place, *read))
                + " |",
                flush=True,
            )

    def hundredth(self) -> None:
        """Measures the elimination of 99 % of the candidates, which yields the best spacing."""
        print("\n| candidates | VPLs | vpl-eliminate: s | MiB |\n|---|---|---|---|")
        for n in self.sizes(1_000_000, 10_000_000):
            c = self.folder / "c.vpl"
            self.run("vpl-place", U_SHAPE, "-o", c, "-n", n)
            s, mib = self.run(
                "vpl-eliminate", c, "-o", self.folder / "v.vpl", "-n", max(1, n // 100)
            )
            print(f"| {n} | {max(1, n // 100)} | {s:.4g} | {mib:.0f} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--parts", default=",".join(CORE_PARTS))
    parser.add_argument("--most", type=float, default=1.0, help="share of the full sizes")
    parser.add_argument(
        "--cpu", action="store_true", help="CPU seconds of all threads, user and system"
    )
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="bnvpl-size-") as folder:
        size = Size(options, Path(folder))
        for part in options.parts.split(","):
            if part not in CORE_PARTS + LARGE_PARTS:
                sys.exit(f"size.py: no part '{part}'")
            getattr(size, part)()


if __name__ == "__main__":
    main()
