#!/usr/bin/env python3
"""Makes docs/index.html: the method in pictures, from runs of the tools, on one page.

    docs/make_index.py [--bin build/release/bin]    # a few minutes
    docs/make_index.py --text                       # a new template around the pictures of the page
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import io
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs/index.html"
TEMPLATE = ROOT / "docs/index.template.html"
U_SHAPE = ROOT / "scenes/u-shape/scene.toml"
ROOM = ROOT / "scenes/gltf-room/room.glb"
SIZE = "640x480"
ROOM_SIZE = "640x360"
VPLS = "400"
QUALITY = 82  # JPEG: a picture takes 20 to 100 kB

Values = dict[str, str]  # what the template's names stand for


class Tools:
    """The tools, run in a folder, with the CPU seconds that they took."""

    def __init__(self, binaries: Path, folder: Path) -> None:
        self.binaries, self.folder, self.cpu_s = binaries, folder, 0.0

    def run(self, line: str) -> None:
        before = os.times()
        tool, *words = line.split()
        subprocess.run([self.binaries / tool, *words, "--quiet"], cwd=self.folder, check=True)
        now = os.times()
        self.cpu_s += now.children_user - before.children_user
        self.cpu_s += now.children_system - before.children_system

    def picture(self, name: str, width: int = 640) -> str:
        """A PNG of the folder as a data URI of JPEG."""
        image = Image.open(self.folder / f"{name}.png").convert("RGB")
        height = round(image.height * width / image.width)
        packed = io.BytesIO()
        small = image.resize((width, height), Image.Resampling.LANCZOS)
        small.save(packed, "JPEG", quality=QUALITY, optimize=True)
        return "data:image/jpeg;base64," + base64.b64encode(packed.getvalue()).decode()


def stages(tools: Tools) -> Values:
    """The four stages on the U-shape, and what random VPLs make of it."""
    scene = str(U_SHAPE)
    plot = f"--scene {scene} --size {SIZE} --dot"
    tools.run(f"vpl-place {scene} -o c.vpl -n 15k")
    tools.run(f"vpl-inspect plot c.vpl -o candidates.png {plot} 3")
    for name, method in (("random", "random"), ("blue", "elimination")):
        tools.run(f"vpl-eliminate c.vpl -o {name}.vpl -n {VPLS} --method {method}")
        tools.run(f"vpl-inspect plot {name}.vpl -o {name}.png {plot} 8")
        tools.run(f"vpl-estimate {scene} {name}.vpl -o {name}-lit.vpl --photons 2M")
        tools.run(f"vpl-inspect plot {name}-lit.vpl -o {name}-lit.png {plot} 8")
        tools.run(
            f"vpl-render {scene} {name}-lit.vpl -o {name}.exr --size {SIZE} --spp 16 "
            f"--compensate none --fireflies keep --png {name}-image.png --exposure 4.5"
        )
    tools.run(
        f"vpl-render {scene} blue-lit.vpl -o whole.exr --size {SIZE} --spp 16 "
        "--png whole.png --exposure 4.5"
    )
    large = ("random", "blue", "random-image", "blue-image", "whole")
    values = {name: tools.picture(name) for name in large}
    small = {"candidates": "candidates", "kept": "blue", "lit": "blue-lit", "image": "whole"}
    return values | {f"step-{key}": tools.picture(name, 400) for key, name in small.items()}


def equal_time(tools: Tools) -> Values:
    """The room by VPLs, and by the path tracer in the same CPU time."""
    scene, begin = str(ROOM), tools.cpu_s
    tools.run(f"vpl-place {scene} -o r.vpl -n 40k")
    tools.run("vpl-eliminate r.vpl -o k.vpl -n 4k")
    tools.run(f"vpl-estimate {scene} k.vpl -o l.vpl --photons 4M")
    film = f"--size {ROOM_SIZE} --exposure 0.5"
    tools.run(f"vpl-render {scene} l.vpl -o o.exr --png ours.png --near-field-rays 4 {film}")
    ours_s, begin = tools.cpu_s - begin, tools.cpu_s
    path = f"vpl-render {scene} --integrator path -o p.exr --png path.png {film} --spp"
    tools.run(f"{path} 4")
    spp = max(1, round(4 * ours_s / (tools.cpu_s - begin)))
    tools.run(f"{path} {spp}")
    pictures = {"path": tools.picture("path"), "ours": tools.picture("ours")}
    return pictures | {"seconds": f"{ours_s:.0f}", "path-samples": str(spp)}


def kept_values(page: str) -> Values:
    """Pictures and figures of a page that was made before."""
    kept: Values = {}
    for name, value in re.findall(r'data-value="([\w-]+)"[^>]* src="([^"]+)"', page):
        kept[name] = value
    kept |= dict(re.findall(r'<span data-value="([\w-]+)">([^<]*)</span>', page))
    return kept


def page_html(values: Values) -> str:
    """The template with its {{names}} filled in. The policy refuses all use of the network."""
    text = TEMPLATE.read_text(encoding="utf-8")
    script = text.partition("<script>")[2].partition("</script>")[0]
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    values = values | {"script-hash": digest, "vpls": VPLS}
    return re.sub(r"\{\{([\w-]+)\}\}", lambda name: values[name[1]], text)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bin", type=Path, default=ROOT / "build/release/bin")
    parser.add_argument("--text", action="store_true", help="keep the pictures of the page")
    options = parser.parse_args()
    if options.text:
        values = kept_values(PAGE.read_text(encoding="utf-8"))
    else:
        with tempfile.TemporaryDirectory() as folder:
            tools = Tools(options.bin.resolve(), Path(folder))
            values = stages(tools) | equal_time(tools)
    PAGE.write_text(page_html(values), encoding="utf-8")
    print(f"{PAGE}: {PAGE.stat().st_size / 1e6:.2f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
