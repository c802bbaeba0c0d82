"""Jobs of a simulated farm: the tasks of stages.py, each with the cost that the model predicts."""

import dataclasses
import random
from collections.abc import Sequence

import cost
import stages


@dataclasses.dataclass
class Job:
    name: str
    stage: str
    needs: list[int]  # positions of the jobs that end before it begins
    cores: int = 1  # 0 marks the end of a stage, which takes no time and no node
    setup_s: float = 0.0  # wall time on its cores that each attempt spends again
    work_s: float = 0.0  # wall time on its cores
    checkpoints: bool = False  # whether it resumes from its last checkpoint after a failure
    cpu_s: float = 0.0
    memory_mib: float = 0.0
    file_bytes: float = 0.0

    @property
    def wall_s(self) -> float:
        return self.setup_s + self.work_s


@dataclasses.dataclass
class Conditions:
    cores: dict[str, int]  # cores of one task, by stage; "merge" stands for all merges
    efficiency: float = (
        0.95  # CPU seconds of one thread over cores times wall time, where threads share work
    )
    scatter: float = 0.1  # standard deviation of log(time)
    # Factors of the stages' times without loading, for scenes unlike that of the model.
    scales: dict[str, float] = dataclasses.field(default_factory=dict)
    seed: int = 1


Row = tuple[stages.Task | None, str, list[int]]


def needs_by_files(tasks: list[stages.Task]) -> list[list[int]]:
    """Needs of each task under ninja: the tasks that make its inputs."""
    maker = {output: i for i, task in enumerate(tasks) for output in task.outputs}
    return [sorted({maker[name] for name in task.inputs if name in maker}) for task in tasks]


def with_stages(tasks: list[stages.Task]) -> list[Row]:
    """Rows (task, stage, needs) under Slurm, where a task waits for all tasks of earlier stages.

    After the tasks of each stage follows a row without a task, which stands for the stage's end.
    """
    rows: list[Row] = []
    end_of: dict[str, int] = {}
    for stage in dict.fromkeys(task.stage for task in tasks):
        members = [task for task in tasks if task.stage == stage]
        first = len(rows)
        rows += [(task, stage, [end_of[name] for name in task.after]) for task in members]
        end_of[stage] = len(rows)
        rows.append((None, stage, list(range(first, len(rows)))))
    return rows


def counts_of(task: stages.Task, whole: cost.Counts, shards: dict[str, int]) -> cost.Counts:
    kind = task.stage.removeprefix("merge-")
    divided = task.shard or task.stage != kind
    return cost.with_shards(whole, task.stage, shards if divided else {})


def job_of(
    task: stages.Task,
    needs: list[int],
    model: cost.Model,
    whole: cost.Counts,
    shards: dict[str, int],
    conditions: Conditions,
) -> Job:
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
        model.predict(kind, "memory_MiB", dataclasses.replace(counts, threads=cores)),
        model.predict(kind, "file_bytes", counts) if "file_bytes" in terms else 0.0,
    )


def jobs_of(
    tasks: list[stages.Task],
    order: str,
    model: cost.Model,
    whole: cost.Counts,
    shards: dict[str, int],
    conditions: Conditions,
) -> list[Job]:
    """Jobs in an order that respects their needs. `order` is "files" or "stages"."""
    rows = (
        with_stages(tasks)
        if order == "stages"
        else [
            (task, task.stage, needs)
            for task, needs in zip(tasks, needs_by_files(tasks), strict=True)
        ]
    )
    return [
        job_of(task, needs, model, whole, shards, conditions)
        if task
        else Job(f"end of {stage}", stage, needs, 0)
        for task, stage, needs in rows
    ]


def critical_path(jobs: Sequence[Job]) -> list[Job]:
    """Jobs of the longest chain, first to last. Its time bounds any farm's from below."""
    end: list[float] = []
    before: list[int | None] = []
    for job in jobs:
        last = max(job.needs, key=lambda k: end[k]) if job.needs else None
        before.append(last)
        end.append((end[last] if last is not None else 0.0) + job.wall_s)
    at = max(range(len(jobs)), key=lambda k: end[k]) if jobs else None
    path = []
    while at is not None:
        path.append(jobs[at])
        at = before[at]
    return [job for job in reversed(path) if job.cores]
