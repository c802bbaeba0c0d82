#!/usr/bin/python3
"""Time and memory of the stages as the work grows: triangles, candidates, VPLs, lights.

  bench/size.py                          all, about four minutes and 3 GiB
  bench/size.py --parts lights,vpls      some
  bench/size.py --most 0.01              a hundredth of each size, to see that it works

Prints Markdown; docs/lab has former figures.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
U_SHAPE = ROOT / "scenes/u-shape/scene.toml"
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


class Size:
    def __init__(self, options: argparse.Namespace, folder: Path):
        self.bin, self.most, self.folder = options.bin, options.most, folder

    def run(self, tool: str, *words) -> tuple[float, float]:
        """Seconds and MiB."""
        stats = self.folder / "stats.json"
        done = subprocess.run([str(w) for w in (self.bin / tool, *words, "--quiet", "--stats", stats)],
                              capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"size.py: {done.stderr.strip()}")
        found = json.loads(stats.read_text())
        return found["time_s"], found["peak_memory_MiB"]

    def sizes(self, *full: int) -> list[int]:
        return [max(1, round(n * self.most)) for n in full]

    def room(self, triangles: int, lamps: int, lights: int) -> Path:
        """A wavy floor and ceiling of so many triangles, lamps among them, and point lights between them."""
        side = max(1, round(math.sqrt(triangles / 4)))
        with open(self.folder / "size.obj", "w") as obj:
            obj.write("mtllib size.mtl\nusemtl grey\n")
            for base in (0.0, 1.0):
                for j in range(side + 1):
                    z = 2 * j / side - 1
                    wave = 0.03 * math.cos(9 * z)
                    obj.write("".join(f"v {2 * i / side - 1:.7f} {base + wave * math.sin(9 * i / side):.7f} {z:.7f}\n"
                                      for i in range(side + 1)))
            for first, (a, b) in ((1, (1, side + 1)), ((side + 1)**2 + 1, (side + 1, 1))):
                for j in range(side):
                    row = first + j * (side + 1)
                    obj.write("".join(f"f {row + i} {row + i + b} {row + i + a}\nf {row + i + a} {row + i + b} "
                                      f"{row + i + side + 2}\n" for i in range(side)))
            obj.write("usemtl lamp\n")
            columns = max(1, math.ceil(math.sqrt(lamps)))
            for k in range(lamps):
                x, z = (2 * (v + 0.3) / columns - 1 for v in (k % columns, k // columns))
                obj.write(f"v {x} 0.9 {z}\nv {x + 0.3 / columns} 0.9 {z}\nv {x} 0.9 {z + 0.3 / columns}\nf -3 -2 -1\n")
        (self.folder / "size.mtl").write_text(MTL)
        toml = CAMERA
        for k in range(lights):
            angle = 2.4 * k  # the golden angle: no two close together
            r = 0.9 * math.sqrt((k + 0.5) / lights)
            toml += ("[[light]]\ntype = \"point\"\n"
                     f"position = [{r * math.cos(angle):.6f}, 0.5, {r * math.sin(angle):.6f}]\n"
                     f"intensity = [{1 / lights}, {1 / lights}, {1 / lights}]\n")
        (self.folder / "size.toml").write_text(toml)
        return self.folder / "size.toml"

    def triangles(self) -> None:
        print("\n| triangles | vpl-place -n 10k: s | MiB |\n|---|---|---|")
        for n in self.sizes(100_000, 1_000_000, 10_000_000):
            scene = self.room(n, 0, 1)
            s, mib = self.run("vpl-place", scene, "-o", self.folder / "c.vpl", "-n", "10k")
            print(f"| {n} | {s:.2f} | {mib:.0f} |", flush=True)

    def candidates(self) -> None:
        print("\n| candidates | vpl-place: s | MiB | vpl-eliminate, a fifth, uniform: s | MiB | local: s | MiB |\n"
              "|---|---|---|---|---|---|---|")
        for n in self.sizes(1_250_000, 5_000_000, 20_000_000):
            c, v = self.folder / "c.vpl", self.folder / "v.vpl"
            row = [*self.run("vpl-place", U_SHAPE, "-o", c, "-n", n)]
            for density in ("uniform", "local"):
                row += self.run("vpl-eliminate", c, "-o", v, "-n", max(1, n // 5), "--density", density)
            print(f"| {n} | " + " | ".join(f"{x:.4g}" for x in row) + " |", flush=True)

    def vpls(self) -> None:
        print("\n| VPLs | vpl-estimate, 1M photons: s | MiB | vpl-render, 64x48, 1 spp: s | MiB |\n|---|---|---|---|---|")
        for n in self.sizes(10_000, 100_000, 1_000_000):
            c, v, lit = (self.folder / f"{x}.vpl" for x in "cvl")
            self.run("vpl-place", U_SHAPE, "-o", c, "-n", 5 * n)
            self.run("vpl-eliminate", c, "-o", v, "-n", n)
            row = [*self.run("vpl-estimate", U_SHAPE, v, "-o", lit, "--photons", "1M"),
                   *self.run("vpl-render", U_SHAPE, lit, "-o", self.folder / "i.exr", "--size", "64x48", "--spp", "1")]
            print(f"| {n} | " + " | ".join(f"{x:.4g}" for x in row) + " |", flush=True)

    def lights(self) -> None:
        print("\n| lights | vpl-estimate, 1M photons: s | path tracer, 64x48, 16 spp: s | MiB |\n|---|---|---|---|")
        kinds = [("point lights", lambda n: self.room(10_000, 0, n), self.sizes(10, 100, 1000)),
                 ("emissive triangles", lambda n: self.room(10_000, n, 0), self.sizes(64, 512, 4096))]
        for kind, make, sizes in kinds:
            for n in sizes:
                scene = make(n)
                c, v, lit = (self.folder / f"{x}.vpl" for x in "cvl")
                self.run("vpl-place", scene, "-o", c, "-n", "10k")
                self.run("vpl-eliminate", c, "-o", v, "-n", "1k")
                estimate, _ = self.run("vpl-estimate", scene, v, "-o", lit, "--photons", "1M")
                path, mib = self.run("vpl-render", scene, "-o", self.folder / "i.exr", "--integrator", "path", "--spp", "16")
                print(f"| {n} {kind} | {estimate:.2f} | {path:.2f} | {mib:.0f} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", default="triangles,candidates,vpls,lights")
    parser.add_argument("--most", type=float, default=1.0, help="share of the full sizes")
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="bnvpl-size-") as folder:
        size = Size(options, Path(folder))
        for part in options.parts.split(","):
            if part not in ("triangles", "candidates", "vpls", "lights"):
                sys.exit(f"size.py: no part '{part}'")
            getattr(size, part)()


if __name__ == "__main__":
    main()
