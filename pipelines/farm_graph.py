"""The tasks of stages.py with what each takes by the cost model: what a simulated farm runs."""

import dataclasses
import random

import cost


@dataclasses.dataclass
class Job:
    name: str
    stage: str
    needs: list  # positions of the jobs that end before it begins
    cores: int = 1  # 0: takes no time and no node; it stands for the end of a stage
    setup_s: float = 0.0  # wall time on its cores that each attempt takes again
    work_s: float = 0.0  # wall time on its cores
    checkpoints: bool = False  # goes on after a failure from the last one
    cpu_s: float = 0.0
    memory_mib: float = 0.0
    file_bytes: float = 0.0

    @property
    def wall_s(self):
        return self.setup_s + self.work_s


@dataclasses.dataclass
class Conditions:
    cores: dict  # of a task, by stage, with "merge" for all merges
    efficiency: float = (
        0.95  # CPU seconds of one thread over cores times wall time, where threads share work
    )
    scatter: float = 0.1  # standard deviation of log(time)
    scales: dict = dataclasses.field(
        default_factory=dict
    )  # of a stage but for loading, in scenes unlike the model's
    seed: int = 1


def needs_by_files(tasks):
    """As ninja: a task waits for those that make its inputs."""
    maker = {output: i for i, task in enumerate(tasks) for output in task.outputs}
    return [sorted({maker[name] for name in task.inputs if name in maker}) for task in tasks]


def with_stages(tasks):
    """As Slurm: a task waits for all tasks of the stages before it. [(task or None, stage, needs)]"""
    order, rows, end_of = list(dict.fromkeys(task.stage for task in tasks)), [], {}
    for stage in order:
        members = [task for task in tasks if task.stage == stage]
        first = len(rows)
        rows += [(task, stage, [end_of[name] for name in task.after]) for task in members]
        end_of[stage] = len(rows)
        rows.append((None, stage, list(range(first, len(rows)))))
    return rows


def counts_of(task, whole, shards):
    kind = task.stage.removeprefix("merge-")
    divided = task.shard or task.stage != kind
    return cost.with_shards(whole, task.stage, shards if divided else {})


def job_of(task, needs, model, whole, shards, conditions):
    counts, kind = counts_of(task, whole, shards), task.stage
    cores = conditions.cores["merge" if kind.startswith("merge-") else kind]
    scale = conditions.scales.get(kind, 1.0)
    factor = random.Random(f"{conditions.seed}/{task.name}").lognormvariate(0.0, conditions.scatter)
    loading, before = model.loading_s(kind, counts), model.setup_s(kind, counts)
    setup, work = (
        loading + scale * (before - loading),
        scale * (model.predict(kind, "cpu_s", counts) - before),
    )
    many = cores * conditions.efficiency if cores > 1 else 1.0
    terms = cost.TERMS[kind]
    return Job(
        task.name,
        kind,
        needs,
        cores,
        factor * (loading + (setup - loading) / many),
        factor * work / many,
        bool(task.checkpoint),
        factor * (setup + work),
        model.predict(kind, "memory_MiB", counts),
        model.predict(kind, "file_bytes", counts) if "file_bytes" in terms else 0.0,
    )


def jobs_of(tasks, order, model, whole, shards, conditions):
    """Jobs, each after those that it needs; `order` is "files" or "stages"."""
    rows = (
        with_stages(tasks)
        if order == "stages"
        else [(task, task.stage, needs) for task, needs in zip(tasks, needs_by_files(tasks))]
    )
    return [
        job_of(task, needs, model, whole, shards, conditions)
        if task
        else Job(f"end of {stage}", stage, needs, 0)
        for task, stage, needs in rows
    ]


def critical_path(jobs):
    """The longest chain: its jobs, first to last. With any number of nodes the jobs take no less."""
    end, before = [], []
    for job in jobs:
        last = max(job.needs, key=lambda k: end[k], default=None)
        before.append(last)
        end.append((end[last] if last is not None else 0.0) + job.wall_s)
    at = max(range(len(jobs)), key=lambda k: end[k], default=None)
    path = []
    while at is not None:
        path.append(jobs[at])
        at = before[at]
    return [job for job in reversed(path) if job.cores]
