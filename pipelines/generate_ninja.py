#!/usr/bin/env python3
r"""Writes a build.ninja that renders scenes by the four stages and keeps every intermediate file.

    pipelines/generate_ninja.py scenes/u-shape/scene.toml --quality draft
    ninja -f out/build.ninja

With --shards N, place, estimate and render become N edges each and one of vpl-merge. The merged
files are the same. --shards place=4,estimate=16,render=64 gives each stage its own N. --launcher
starts the shards elsewhere:

    pipelines/generate_ninja.py scenes/u-shape/scene.toml --shards 16,render=64 \
        --launcher 'srun -n1 -c8'
    ninja -j 64 -f out/build.ninja

Ninja remembers each stage's command and reads its depfile, so a stage runs again when an input,
its executable or its own options have changed. Paths are relative to the folder in which both run.
"""

import argparse
import pathlib

import output_guard
import stage_options
import stages
import tool_options

# A stage uses all cores, so one runs at a time, whatever -j is. The same holds for shards, unless a
# launcher starts them elsewhere.
MARK = "# Made by generate_ninja.py"
HEADER = (
    MARK
    + """; run that again to change it.
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
)


def arguments() -> argparse.Namespace:
    p = argparse.ArgumentParser(description="Write OUT/build.ninja for one or more scenes.")
    p.add_argument(
        "scenes", nargs="+", metavar="SCENE", help="the scene: .toml, .pbrt, .gltf, .glb, .obj"
    )
    stage_options.add_arguments(p)
    p.add_argument(
        "--launcher",
        default="",
        metavar="COMMAND",
        help="goes before the command of each shard, such as 'srun -n1 -c8'; ninja -j says how "
        "many at once",
    )
    p.add_argument(
        "--record",
        action="store_true",
        help="each task writes what it took to OUT/SCENE/run, for vpl-inspect run",
    )
    options = p.parse_args()
    stage_options.complete(options)
    if options.launcher and max(options.shards.values()) == 1:
        p.error("--launcher starts shards; add --shards N")
    return options


def build(task: stages.Task, out: str, options: argparse.Namespace) -> list[str]:
    """One build statement."""
    command = task.command
    if options.record:
        after = [word for stage in task.after for word in ("--after", stage)]
        command = [
            stage_options.relative(stage_options.HERE / "record.py"),
            f"{out}/run",
            task.name,
            "--stage",
            task.stage,
            *after,
            *(["--checkpoint", task.checkpoint] if task.checkpoint else []),
            "--",
            *command,
        ]
    if task.shard:
        command = [*stage_options.words_of(options.launcher, "--launcher"), *command]
    rule = "shard" if task.shard else "read_scene" if task.depfile else "run"
    rows = [f"build {' | '.join(task.outputs)}: {rule} {' '.join(task.inputs)}"]
    if task.depfile:
        rows.append(f"  dep = {task.depfile}")
    rows.append("  cmd = " + stage_options.shell_command(command).replace("$", "$$"))
    return rows


def write_graph(target: pathlib.Path, text: str) -> None:
    """Writes the graph, but does not replace another program's, such as CMake's."""
    output_guard.or_exit(
        output_guard.write,
        target,
        text,
        output_guard.text_kind("a graph of this program", MARK),
        "--out",
    )


def main() -> None:
    options = arguments()
    for scene in options.scenes:
        stage_options.check_scene(scene)
    names = [stages.name_of(scene) for scene in options.scenes]
    if len(set(names)) < len(names):
        stage_options.refuse(
            "two scenes would share a folder; give them to two runs with different --out"
        )
    rows = [HEADER.format(out=options.out, shard_pool="" if options.launcher else "stage")]
    for scene in options.scenes:
        tasks, out = stages.tasks_of(scene, options), stages.folder_of(scene, options)
        rows += [
            "",
            *(row for task in tasks for row in build(task, out, options)),
            f"build {stages.name_of(scene)}: phony "
            f"{' '.join(image for image, _ in stages.images_in(scene, options))}",
        ]
    tool_options.check(options)
    target = pathlib.Path(options.out) / "build.ninja"
    text = "\n".join(rows) + "\n"
    output_guard.make_folder(target.parent, "--out")
    write_graph(target, text)
    print(f"ninja -f {target}")


if __name__ == "__main__":
    output_guard.run(main)
