#!/usr/bin/env python3
r"""Renders a scene on a Slurm cluster: place, estimate and render as arrays of shards with a merge.

    pipelines/slurm/submit.py scenes/u-shape/scene.toml --shards 16,render=64 \
        --memory 8G,eliminate=32G --time 2:00:00

Run it in a folder that all nodes see at the same path; paths are relative to it. The images equal
those of a run on one machine, byte for byte. Logs, records and a summary go to OUT/SCENE/run. The
same command again submits only what is missing.
"""

import argparse
import dataclasses
import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Collection, Iterable

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import needs  # noqa: E402
import output_guard  # noqa: E402
import record  # noqa: E402
import stage_options  # noqa: E402
import stages  # noqa: E402
import task as task_program  # noqa: E402
import tool_options  # noqa: E402

KINDS = ("place", "eliminate", "estimate", "render", "merge")
SECONDS_TO_SAVE = 60  # time before the limit at which a task begins to save its checkpoint
JOB = output_guard.json_object("a job of this program", "threads", "retries", "tasks")
IDS = output_guard.json_kind(
    "a list of jobs of this program",
    lambda ids: (
        isinstance(ids, dict)
        and all(isinstance(job, str) and job.isdigit() for job in ids.values())
    ),
)


def per_stage(value: str, **others: str) -> dict[str, str]:
    return dict.fromkeys(KINDS, value) | others


def add_limits(p: argparse.ArgumentParser) -> None:
    """Options of what each stage's tasks may use."""
    p.add_argument(
        "--cpus",
        action=stage_options.PerStage,
        stages=KINDS,
        pattern=r"[1-9]\d*",
        what="a count from 1",
        default=per_stage("4", merge="1"),
        help="of a task; default 4, and merge=1",
    )
    p.add_argument(
        "--memory",
        action=stage_options.PerStage,
        stages=KINDS,
        pattern=r"\d+[KMGT]?|auto",
        what="a size such as 4G",
        default=per_stage("auto"),
        help="of a task; default auto: by what is known of the tools (eval/scaling/README.md)",
    )
    p.add_argument(
        "--time",
        action=stage_options.PerStage,
        stages=KINDS,
        pattern=r"\d+|\d+(:\d\d){1,2}|\d+-\d+(:\d\d){0,2}|auto",
        what="a time such as 90 (minutes), 2:00:00 or 1-12 (days and hours)",
        default=per_stage("auto"),
        help="limit of a task, as sbatch has it; default auto, as --memory; place, estimate and "
        "render are queued again when they reach it, and go on",
    )


def arguments() -> argparse.Namespace:
    p = argparse.ArgumentParser(
        description=__doc__.split("\n\n")[0] + "\n" + __doc__.split("\n\n")[2],
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=f"STAGE is one of {', '.join(KINDS)}; "
        f"of --shards {', '.join(stage_options.DIVIDED)}.",
    )
    p.add_argument("scene", metavar="SCENE", help="the scene: .toml, .pbrt, .gltf, .glb, .obj")
    stage_options.add_arguments(p, shards="16")
    add_limits(p)
    p.add_argument(
        "--at-once",
        type=int,
        metavar="N",
        help="most tasks of an array that run together; default: all",
    )
    p.add_argument(
        "--retries",
        type=int,
        default=3,
        metavar="N",
        help="times that a task whose tool is killed is queued again (default 3); failed nodes "
        "do not count",
    )
    p.add_argument(
        "--sbatch",
        default="",
        metavar="OPTIONS",
        help="for every job: --sbatch='--partition=long --account=x'",
    )
    p.add_argument("--dry-run", action="store_true", help="print what would be submitted")
    options = p.parse_args()
    if options.at_once is not None and options.at_once < 1:
        p.error(f"--at-once {options.at_once} is not 1 or more")
    if options.retries < 0:
        p.error(f"--retries {options.retries} is not 0 or more")
    stage_options.complete(options)
    stage_options.check_scene(options.scene)
    tool_options.check(options, must_run=False, runner_gives=("--threads",))
    return options


def kind_of(stage: str) -> str:
    return "merge" if stage.startswith("merge-") else stage


def jobs_of(scene: str, options: argparse.Namespace) -> list[tuple[str, list[stages.Task]]]:
    """Pairs (stage, its tasks) in the order in which they run."""
    jobs: dict[str, list[stages.Task]] = {}
    for task in stages.tasks_of(scene, options):
        jobs.setdefault(task.stage, []).append(task)
    return list(jobs.items())


def ranges(numbers: Iterable[int]) -> str:
    """Ranges in the notation of sbatch --array: 1-3,7 for 1, 2, 3, 7."""
    parts: list[list[int]] = []
    for n in numbers:
        if parts and parts[-1][1] == n - 1:
            parts[-1][1] = n
        else:
            parts.append([n, n])
    return ",".join(str(a) if a == b else f"{a}-{b}" for a, b in parts)


def largest_index() -> int:
    """The largest index of a job array; 0 where Slurm does not tell."""
    if not shutil.which("scontrol"):
        return 0
    shown = subprocess.run(["scontrol", "show", "config"], text=True, capture_output=True)
    found = re.search(r"^MaxArraySize\s*=\s*(\d+)", shown.stdout, re.M)
    return int(found[1]) - 1 if found else 0


def task_of(file: pathlib.Path) -> str:
    """The task that a record NAME.ATTEMPT.task.json is of."""
    return file.name.removesuffix(record.SUFFIX).rpartition(".")[0]


class Submission:
    def __init__(self, scene: str, options: argparse.Namespace) -> None:
        self.options, self.scene = options, scene
        self.run = pathlib.Path(stages.folder_of(scene, options)) / "run"
        self.submitted: dict[str, str] = {}  # number of the Slurm job of each stage
        self.needs = needs.Needs(options)
        self.ids = self.run / "jobs.json"

    def job_file(self, name: str) -> pathlib.Path:
        return self.run / f"{name}.job.json"

    def check_files(self, names: Iterable[str]) -> None:
        """Checks every file that the run will write, before it writes any."""
        for folder in (self.run, self.run / "earlier"):
            if folder.exists() and not folder.is_dir():
                stage_options.refuse(
                    f"{folder}: is no folder, which the run needs there; give another --out, or "
                    "remove it"
                )
        for file, kind in [(self.ids, IDS), *((self.job_file(name), JOB) for name in names)]:
            output_guard.or_exit(output_guard.check, file, kind)

    def refuse_while_queued(self) -> None:
        """Refuses to submit while an earlier run of the scene is queued: it does the same work."""
        if not self.ids.exists():
            return
        known = set(json.loads(self.ids.read_text()).values())
        queued = {
            line for line in self.slurm("squeue", "--noheader", "--format=%A %F", "--me").split()
        } & known
        if queued:
            stage_options.refuse(
                f"jobs {', '.join(sorted(queued))} of this run are still queued; wait, or end "
                "them with scancel"
            )

    def put_aside(self, names: Collection[str]) -> None:
        """Moves away records of tasks that this run lacks, such as those of other shard counts.

        Records of its own tasks that an earlier run has put aside come back.
        """
        earlier = self.run / "earlier"
        for file in earlier.glob(f"*{record.SUFFIX}"):
            if task_of(file) in names:
                file.replace(self.run / file.name)
        for file in self.run.glob(f"*{record.SUFFIX}"):
            if task_of(file) not in names:
                earlier.mkdir(exist_ok=True)
                file.replace(earlier / file.name)

    def slurm(self, *command: str) -> str:
        try:
            done = subprocess.run(command, text=True, stdout=subprocess.PIPE)
        except FileNotFoundError:
            stage_options.refuse(
                f"there is no {command[0]} here; run this where Slurm's commands are"
            )
        if done.returncode:
            ended = "; no job of this run is left" if self.submitted else ""
            self.undo()
            stage_options.refuse(f"{command[0]} failed, as it says above{ended}")
        return done.stdout

    def undo(self) -> None:
        if self.submitted:
            subprocess.run(["scancel", *self.submitted.values()])

    def limits(self, name: str, kind: str) -> tuple[str, str, str]:
        memory, time, cores = (
            each[kind] for each in (self.options.memory, self.options.time, self.options.cpus)
        )
        return (
            self.needs.memory(name, int(cores)) if memory == "auto" else memory,
            self.needs.time(name, int(cores)) if time == "auto" else time,
            cores,
        )

    def submit(self, name: str, kind: str, words: list[str], command: list[str], note: str) -> None:
        chosen = self.options
        memory, time, cores = self.limits(name, kind)
        full = [
            "sbatch",
            "--parsable",
            f"--job-name={stages.name_of(self.scene)}-{name}",
            f"--cpus-per-task={cores}",
            f"--mem={memory}",
            f"--time={time}",
            "--requeue",
            "--open-mode=append",
            *words,
            *stage_options.words_of(chosen.sbatch, "--sbatch"),
            f"--wrap=exec {shlex.join(command)}",
        ]
        if chosen.dry_run:
            print(shlex.join(full))
            self.submitted[name] = f"ID_OF_{name}"
            return
        self.submitted[name] = self.slurm(*full).strip().split(";")[0]
        output_guard.or_exit(output_guard.write, self.ids, json.dumps(self.submitted) + "\n", IDS)
        print(f"{self.submitted[name]}  {name}: {note}", flush=True)

    def submit_stage(self, name: str, tasks: list[stages.Task]) -> None:
        before = [self.submitted[stage] for stage in tasks[0].after if stage in self.submitted]
        described = [dataclasses.asdict(task) for task in tasks]
        wanted = [
            i
            for i, task in enumerate(described, 1)
            if before or not task_program.up_to_date(self.run, task)
        ]
        if not wanted:
            return
        kind = kind_of(name)
        if not self.options.dry_run:
            job = {
                "threads": int(self.options.cpus[kind]),
                "retries": self.options.retries,
                "tasks": described,
            }
            output_guard.or_exit(
                output_guard.write, self.job_file(name), json.dumps(job, indent=1), JOB
            )
        words = (
            [f"--dependency=afterok:{':'.join(before)}", "--kill-on-invalid-dep=yes"]
            if before
            else []
        )
        if len(tasks) > 1:  # shards, and images of several views
            at_once = f"%{self.options.at_once}" if self.options.at_once else ""
            log = stages.shard_name(name, "%a", len(tasks))
            words.append(f"--array={ranges(wanted)}{at_once}")
        else:
            log = name
        words += [f"--signal=B:USR1@{SECONDS_TO_SAVE}"] if tasks[0].checkpoint else []
        words.append(f"--output={self.run}/{log}.log")
        note = (
            f"{len(wanted)} of {len(tasks)} tasks"
            if len(wanted) < len(tasks)
            else f"{len(tasks)} task{'s' if len(tasks) > 1 else ''}"
        )
        program = [sys.executable, str(HERE / "task.py"), str(self.job_file(name))]
        self.submit(name, kind, words, program, note)

    def submit_summary(self) -> None:
        command = [
            f"{self.options.bin}/vpl-inspect",
            "run",
            str(self.run),
            "--svg",
            f"{self.run}/timeline.svg",
        ]
        words = [
            f"--dependency=afterany:{':'.join(self.submitted.values())}",
            "--open-mode=truncate",
            f"--output={self.run}/summary.log",
        ]
        self.submit("summary", "merge", words, command, f"{self.run}/summary.log and timeline.svg")

    def refuse_long_arrays(self, jobs: list[tuple[str, list[stages.Task]]]) -> None:
        most = largest_index()
        for name, tasks in jobs:
            if most and len(tasks) > max(most, 1):
                stage_options.refuse(
                    f"'{name}' has {len(tasks)} tasks, and the cluster's MaxArraySize allows "
                    f"{most} in an array; give fewer --shards or --views"
                )

    def submit_all(self) -> None:
        jobs = jobs_of(self.scene, self.options)
        self.refuse_long_arrays(jobs)
        if not self.options.dry_run:
            for command in ("sbatch", "squeue", "scancel"):
                if not shutil.which(command):
                    stage_options.refuse(
                        f"there is no {command} here; run this where Slurm's commands are"
                    )
            self.check_files([name for name, _ in jobs])
            self.refuse_while_queued()
            for name, _ in jobs:  # refuses unknown needs before anything is written
                self.limits(name, kind_of(name))
            output_guard.make_folder(self.run, "--out")
            self.put_aside({task.name for _, tasks in jobs for task in tasks})
        for name, tasks in jobs:
            self.submit_stage(name, tasks)
        if not self.submitted:
            print(f"{self.run.parent} is up to date")
            return
        self.submit_summary()


def main() -> None:
    options = arguments()
    Submission(options.scene, options).submit_all()


if __name__ == "__main__":
    output_guard.run(main)
