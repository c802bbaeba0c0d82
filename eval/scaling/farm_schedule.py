"""Simulates jobs on a farm of equal nodes, which may fail. Jobs start in the order of the graph.

A failing node ends the jobs that run on it and comes back after the repair time. These jobs begin
again on any node: they repeat start and set-up, and resume their work from the last checkpoint.
"""

import dataclasses
import heapq
import itertools
import math
import random
from collections.abc import Callable, Iterator
from typing import Any

from farm_graph import Job

MOST_ATTEMPTS = 1000


@dataclasses.dataclass
class Farm:
    nodes: int = 100
    cores: int = 16
    start_s: float = 1.0  # time of each attempt from a free node to a running task
    checkpoint_s: float = 60.0
    failure_s: float = math.inf  # mean time of a node between failures
    repair_s: float = 600.0
    seed: int = 1

    def failures(self, node: int) -> Iterator[float]:
        """Yields the times for which the node runs between its failures."""
        chance = random.Random(f"{self.seed}/node {node}")
        while self.failure_s < math.inf:
            yield chance.expovariate(1 / self.failure_s)


@dataclasses.dataclass
class Attempt:
    job: int
    node: int
    begin_s: float
    end_s: float
    done: bool


@dataclasses.dataclass
class Outcome:
    wall_s: float
    attempts: list[Attempt]
    failures: int


class Nodes:
    """Free cores of each node. Jobs go to the fullest node with room, and the first of these."""

    def __init__(self, count: int, cores: int) -> None:
        self.free = [cores] * count
        self.by_free: list[list[int]] = [[] for _ in range(cores + 1)]
        self.by_free[cores] = list(range(count))

    def set(self, node: int, free: int) -> None:
        self.free[node] = free
        heapq.heappush(self.by_free[free], node)

    def with_room(self, cores: int) -> int | None:
        for free in range(max(1, cores), len(self.by_free)):
            heap = self.by_free[free]
            while heap and self.free[heap[0]] != free:  # this entry is stale
                heapq.heappop(heap)
            if heap:
                return heap[0]
        return None


class Simulation:
    def __init__(self, jobs: list[Job], farm: Farm) -> None:
        self.jobs, self.farm = jobs, farm
        if (widest := max((job.cores for job in jobs), default=0)) > farm.cores:
            raise ValueError(f"a task wants {widest} cores, a node has {farm.cores}")
        self.missing = [len(set(job.needs)) for job in jobs]
        self.then: list[list[int]] = [[] for _ in jobs]
        for k, job in enumerate(jobs):
            for need in set(job.needs):
                self.then[need].append(k)
        self.left = [job.work_s for job in jobs]
        self.begun = [0] * len(jobs)
        self.ready: dict[int, list[int]] = {}  # heap of the waiting jobs, by their cores
        self.nodes = Nodes(farm.nodes, farm.cores)
        self.running: list[dict[int, Attempt]] = [{} for _ in range(farm.nodes)]
        self.attempts: list[Attempt] = []
        self.failed, self.now, self.finished = 0, 0.0, 0
        self.order = itertools.count()
        self.events: list[tuple[float, int, Callable[..., None], tuple[Any, ...]]] = []
        self.fails = [farm.failures(node) for node in range(farm.nodes)]

    def at(self, time: float, what: Callable[..., None], *about: Any) -> None:
        heapq.heappush(self.events, (time, next(self.order), what, about))

    def fail_later(self, node: int) -> None:
        if (lasts := next(self.fails[node], None)) is not None:
            self.at(self.now + lasts, self.fail, node)

    def release(self, k: int) -> None:
        """Makes job k, whose needs are all done, ready to run."""
        if self.jobs[k].cores == 0:
            self.complete(k)
        else:
            heapq.heappush(self.ready.setdefault(self.jobs[k].cores, []), k)

    def complete(self, k: int) -> None:
        self.finished += 1
        for follower in self.then[k]:
            self.missing[follower] -= 1
            if self.missing[follower] == 0:
                self.release(follower)

    def begin_all(self) -> None:
        while True:
            fits = [
                (heap[0], node)
                for cores, heap in self.ready.items()
                if heap and (node := self.nodes.with_room(cores)) is not None
            ]
            if not fits:
                return
            k, node = min(fits)
            job = self.jobs[k]
            heapq.heappop(self.ready[job.cores])
            self.begun[k] += 1
            if self.begun[k] > MOST_ATTEMPTS:
                raise ValueError(
                    f"{job.name} has failed {MOST_ATTEMPTS} times: nodes do not last as long as "
                    "it takes"
                )
            attempt = Attempt(k, node, self.now, math.nan, False)
            self.attempts.append(attempt)
            self.running[node][k] = attempt
            self.nodes.set(node, self.nodes.free[node] - job.cores)
            self.at(self.now + self.farm.start_s + job.setup_s + self.left[k], self.end, attempt)

    def end(self, attempt: Attempt) -> None:
        if not math.isnan(attempt.end_s):
            return  # its node had failed
        attempt.end_s, attempt.done = self.now, True
        del self.running[attempt.node][attempt.job]
        self.nodes.set(attempt.node, self.nodes.free[attempt.node] + self.jobs[attempt.job].cores)
        self.complete(attempt.job)

    def fail(self, node: int) -> None:
        self.failed += 1
        for k, attempt in self.running[node].items():
            attempt.end_s = self.now
            worked = self.now - attempt.begin_s - self.farm.start_s - self.jobs[k].setup_s
            if self.jobs[k].checkpoints and worked > 0:
                self.left[k] -= math.floor(worked / self.farm.checkpoint_s) * self.farm.checkpoint_s
            heapq.heappush(self.ready[self.jobs[k].cores], k)
        self.running[node].clear()
        self.nodes.set(node, 0)
        self.at(self.now + self.farm.repair_s, self.come_back, node)

    def come_back(self, node: int) -> None:
        self.nodes.set(node, self.farm.cores)
        self.fail_later(node)

    def run(self) -> Outcome:
        for node in range(self.farm.nodes):
            self.fail_later(node)
        for k, missing in enumerate(self.missing):
            if missing == 0:
                self.release(k)
        self.begin_all()
        while self.finished < len(self.jobs):
            self.now, _, what, about = heapq.heappop(self.events)
            what(*about)
            while self.events and self.events[0][0] == self.now:
                _, _, what, about = heapq.heappop(self.events)
                what(*about)
            self.begin_all()
        return Outcome(self.now, self.attempts, self.failed)


def simulate(jobs: list[Job], farm: Farm) -> Outcome:
    return Simulation(jobs, farm).run()
