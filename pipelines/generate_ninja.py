#!/usr/bin/env python3
"""Writes a build.ninja that renders scenes by the four stages, keeping every intermediate file.

  pipelines/generate_ninja.py scenes/u-shape/scene.toml --quality draft
  ninja -f out/build.ninja

With --shards N place, estimate and render are N edges each and a vpl-merge, with the same files in the end;
--launcher starts the shards elsewhere:

  pipelines/generate_ninja.py scenes/u-shape/scene.toml --shards 64 --launcher 'srun -n1 -c8'
  ninja -j 64 -f out/build.ninja

Ninja remembers each stage's command and reads its depfile, so a stage runs again when an input,
its executable or its own options have changed. Paths are relative to the folder in which both run.
"""

import argparse
import pathlib
import re
import shlex
import sys

HERE = pathlib.Path(__file__).resolve().parent
MOST_SHARDS = 1500  # their names stand in one command, which Linux limits
OUTPUT, PREVIEW = object(), object()  # in the words of a stage: where its -o and --png go
DEFAULT_BIN = HERE.parent / "build" / "release" / "bin"

# Stages take all cores, so one runs at a time whatever -j says. So do shards, unless they are launched elsewhere.
HEADER = """\
# Made by generate_ninja.py; run that again to change it.
ninja_required_version = 1.7
builddir = {out}
pool stage
  depth = 1
rule run
  command = $cmd
  description = $out
  pool = stage
rule read_scene
  command = $cmd
  depfile = $dep
  description = $out
  pool = stage
rule shard
  command = $cmd
  depfile = $dep
  description = $out
  pool = {shard_pool}
"""


def presets():
    """{"draft": {"VPLS": "1500", ...}, ...} of quality.mk."""
    found = {}
    for line in (HERE / "quality.mk").read_text().splitlines():
        if assignment := re.fullmatch(r"(\w+)\.(\w+)\s*:=\s*(.*)", line):
            name, quality, value = assignment.groups()
            found.setdefault(quality, {})[name] = value
    return found


def arguments():
    qualities = presets()
    p = argparse.ArgumentParser(description="Write OUT/build.ninja for one or more scenes.")
    p.add_argument("scenes", nargs="+", metavar="SCENE", help="scene.toml")
    p.add_argument("--out", default="out", help="folder; each scene gets one below it (default out)")
    p.add_argument("--bin", default=relative(DEFAULT_BIN), help="folder of the executables (default %(default)s)")
    p.add_argument("--quality", default="default", choices=sorted(qualities),
                   help="counts and options of quality.mk (default %(default)s)")
    p.add_argument("--candidates", help="default: the quality's")
    p.add_argument("--vpls", help="default: the quality's")
    p.add_argument("--photons", help="default: the quality's")
    p.add_argument("--spp", help="samples per pixel; default: the quality's; '' for none, as with --render-flags='--time 2m'")
    p.add_argument("--seed", help="for place, estimate and render")
    p.add_argument("--define", action="append", default=[], metavar="NAME=VALUE", help="for ${NAME} in a scene")
    p.add_argument("--shards", type=int, default=1, metavar="N", help="parts of place, estimate and render (default 1)")
    p.add_argument("--launcher", default="", metavar="COMMAND",
                   help="goes before the command of each shard, such as 'srun -n1 -c8'; ninja -j says how many at once")
    for stage in ("place", "eliminate", "estimate", "render"):
        p.add_argument(f"--{stage}-flags", default="", metavar="FLAGS",
                       help=f"more options of vpl-{stage}; write --{stage}-flags='--x y'")
    options = p.parse_args()
    if not 1 <= options.shards <= MOST_SHARDS:
        p.error(f"--shards {options.shards} is not 1 to {MOST_SHARDS}")
    if options.launcher and options.shards == 1:
        p.error("--launcher starts shards; add --shards N")
    preset = qualities[options.quality]
    for name in ("candidates", "vpls", "photons", "spp"):
        if getattr(options, name) is None:
            setattr(options, name, preset[name.upper()])
    options.render_preset = preset["RENDER"]
    return options


def relative(path):
    """From here when it is below here: shorter to read, and the project may move."""
    here = pathlib.Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else str(path)


def check_path(path):
    if re.search(r"[\s$:|'\"]", path):
        sys.exit(f"generate_ninja.py: '{path}' contains a space or one of $ : | ' \"; choose another path")
    return path


def name_of(scene):
    """u-shape for u-shape/scene.toml, sponza-gallery for sponza/gallery.toml."""
    path = pathlib.Path(scene).resolve()
    return path.parent.name + ("" if path.stem == "scene" else f"-{path.stem}")


def refuse_lit_placement(options):
    """VPLs from the lights have their flux, and rejection reads the scene: other files, other stages."""
    words = {"light", "--method=light"} & set(shlex.split(options.place_flags)) or \
            {"rejection", "--method=rejection"} & set(shlex.split(options.eliminate_flags))
    if words:
        sys.exit("generate_ninja.py: vpl-place --method light and vpl-eliminate --method rejection leave no work to "
                 "vpl-estimate; run these stages by hand, as pipelines/README.md shows")


def build(stage, outputs, inputs, words, scene_read, rule=None, launcher=()):
    """One build statement. The first input is the executable and does not repeat in `words`."""
    folder = outputs[0].rsplit("/", 1)[0]
    command = [*launcher, inputs[0], *words, "--stats", f"{folder}/{stage}.json"]
    rule = rule or ("read_scene" if scene_read else "run")
    rows = [f"build {' | '.join(outputs)}: {rule} {' '.join(inputs)}"]
    if scene_read:
        command += ["--depfile", f"{folder}/{stage}.d"]
        rows.append(f"  dep = {folder}/{stage}.d")
    rows.append("  cmd = " + shlex.join(command).replace("$", "$$"))
    return rows


def build_in_parts(stage, options, outputs, inputs, words):
    """A stage that reads the scene: one statement, or one for each shard and one that merges them."""
    product, preview = ["-o", outputs[0]], ["--png", outputs[-1]] if PREVIEW in words else []

    def filled(output, png):
        return [w for word in words for w in (output if word is OUTPUT else png if word is PREVIEW else [word])]

    if options.shards == 1:
        return build(stage, outputs, inputs, filled(product, preview), True)
    folder, of = outputs[0].rsplit("/", 1)[0] + "/shards", options.shards
    rows, parts = [], []
    for part in range(1, of + 1):
        name = f"{stage}-{part}-of-{of}"
        parts.append(f"{folder}/{name}.shard")
        saved = ["--checkpoint", f"{folder}/{name}.checkpoint"]
        rows += build(name, [parts[-1]], inputs, [*filled(["-o", parts[-1]], []), "--shard", f"{part}/{of}", *saved],
                      True, "shard", shlex.split(options.launcher))
    merge = f"{options.bin}/vpl-merge"
    return rows + build(stage, outputs, [merge, *parts], [*parts, *product, *preview], True)


def scene_rules(scene, options):
    out = check_path(f"{options.out}/{name_of(scene)}")
    seed = ["--seed", options.seed] if options.seed else []
    spp = ["--spp", options.spp] if options.spp else []
    defines = [word for define in options.define for word in ("--define", define)]
    candidates, vpls, lit = f"{out}/candidates.vpl", f"{out}/vpls.vpl", f"{out}/lit.vpl"
    image, preview = f"{out}/image.exr", f"{out}/image.png"

    def tool(stage):
        return f"{options.bin}/vpl-{stage}"

    def flags(stage):
        return shlex.split(getattr(options, f"{stage}_flags"))

    return [
        "",
        *build_in_parts("place", options, [candidates], [tool("place"), scene],
                        [scene, OUTPUT, "-n", options.candidates, *seed, *defines, *flags("place")]),
        *build("eliminate", [vpls], [tool("eliminate"), candidates],
               [candidates, "-o", vpls, "-n", options.vpls, *flags("eliminate")], False),
        *build_in_parts("estimate", options, [lit], [tool("estimate"), scene, vpls],
                        [scene, vpls, OUTPUT, "--photons", options.photons, *seed, *defines, *flags("estimate")]),
        *build_in_parts("render", options, [image, preview], [tool("render"), scene, lit],
                        [scene, lit, OUTPUT, *spp, PREVIEW, *seed, *defines,
                         *shlex.split(options.render_preset), *flags("render")]),
        f"build {name_of(scene)}: phony {image}",
    ]


def main():
    options = arguments()
    refuse_lit_placement(options)
    for path in (*options.scenes, options.out, options.bin):
        check_path(path)
    for scene in options.scenes:
        if not pathlib.Path(scene).is_file():
            sys.exit(f"generate_ninja.py: there is no scene '{scene}'")
    names = [name_of(scene) for scene in options.scenes]
    if len(set(names)) < len(names):
        sys.exit("generate_ninja.py: two scenes would share a folder; give them to two runs with different --out")
    rows = [HEADER.format(out=options.out, shard_pool="" if options.launcher else "stage")]
    for scene in options.scenes:
        rows += scene_rules(scene, options)
    target = pathlib.Path(options.out) / "build.ninja"
    text = "\n".join(rows) + "\n"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text)
    print(f"ninja -f {target}")


if __name__ == "__main__":
    main()
