#!/usr/bin/env python3
"""Tests the simulated farm on graphs and failures with known times."""

import contextlib
import io
import sys
import tempfile
import unittest
from collections.abc import Iterator
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path[:0] = [str(SOURCE / "pipelines"), str(SOURCE / "eval/scaling")]
import cost  # noqa: E402
import farm  # noqa: E402
import farm_graph  # noqa: E402
from farm_graph import Job  # noqa: E402
from farm_schedule import Farm, Simulation, simulate  # noqa: E402


def quick(nodes: int, cores: int = 1, **more: Any) -> Farm:
    return Farm(nodes, cores, start_s=0, **more)


class FailsAt(Farm):
    """A farm whose node 0 fails after these times of running. The others never fail."""

    times: list[float]

    def failures(self, node: int) -> Iterator[float]:
        return iter(self.times if node == 0 else [])


def failing(times: list[float], nodes: int = 1, cores: int = 1, **more: Any) -> FailsAt:
    made = FailsAt(nodes, cores, start_s=0, **more)
    made.times = times
    return made


FILM = [
    "--frames",
    "5",
    "--shards",
    "4,render=3",
    "--candidates",
    "1M",
    "--vpls",
    "10k",
    "--photons",
    "10M",
    "--size",
    "640x480",
]


def jobs(*words: str) -> list[Job]:
    return farm.jobs_of(farm.arguments([*FILM, *words]))


def printed(*words: str) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as out:
        farm.main([*FILM, *words])
    return out.getvalue()


class Schedule(unittest.TestCase):
    def test_one_node_takes_the_sum_of_all_work(self) -> None:
        found = simulate(
            [Job("a", "s", [], 1, 1, 2), Job("b", "s", [], 1, 0, 5), Job("c", "s", [0], 1, 1, 7)],
            quick(1),
        )
        self.assertAlmostEqual(found.wall_s, 16)

    def test_nodes_without_end_take_the_critical_path(self) -> None:
        graph = jobs()
        path = farm_graph.critical_path(graph)
        self.assertAlmostEqual(
            simulate(graph, quick(1000, 16)).wall_s, sum(job.wall_s for job in path), places=6
        )
        self.assertEqual(
            [job.stage for job in path],
            [
                "place",
                "merge-place",
                "eliminate",
                "estimate",
                "merge-estimate",
                "render",
                "merge-render",
            ],
        )

    def test_each_task_is_done_once_after_those_that_it_needs(self) -> None:
        for order in "stages", "files":
            graph = jobs("--order", order)
            found = simulate(graph, Farm(3, 8, failure_s=15, repair_s=5, checkpoint_s=1))
            done = [a for a in found.attempts if a.done]
            self.assertEqual(
                sorted(a.job for a in done), [k for k, job in enumerate(graph) if job.cores]
            )
            self.assertGreater(
                len(found.attempts), len(done), "no failure met a task: the test has lost its point"
            )
            end = {a.job: a.end_s for a in done}

            def ended(k: int, end: dict[int, float] = end, graph: list[Job] = graph) -> float:
                return end[k] if k in end else max(ended(need) for need in graph[k].needs)

            for a in found.attempts:
                for need in graph[a.job].needs:
                    self.assertLessEqual(ended(need), a.begin_s)

    def test_no_node_holds_more_than_its_cores(self) -> None:
        graph = jobs()
        found = simulate(graph, Farm(3, 6, failure_s=15, repair_s=5))
        for moment in {a.begin_s for a in found.attempts}:
            for node in range(3):
                held = sum(
                    graph[a.job].cores
                    for a in found.attempts
                    if a.node == node and a.begin_s <= moment < a.end_s
                )
                self.assertLessEqual(held, 6)

    def test_a_task_goes_on_from_its_last_checkpoint(self) -> None:
        # A job of 10 s of set-up and 100 s of work saves every 20 s. It fails after 55 s: 40 s are
        # kept.
        job = Job("a", "s", [], 1, 10, 100, checkpoints=True)
        found = simulate([job], failing([55], checkpoint_s=20, repair_s=7))
        self.assertAlmostEqual(found.wall_s, 55 + 7 + 10 + 60)

    def test_a_task_without_checkpoints_begins_anew(self) -> None:
        found = simulate(
            [Job("a", "s", [], 1, 10, 100)], failing([55], checkpoint_s=20, repair_s=7)
        )
        self.assertAlmostEqual(found.wall_s, 55 + 7 + 110)
        self.assertEqual([a.done for a in found.attempts], [False, True])

    def test_a_failure_in_the_set_up_saves_nothing(self) -> None:
        job = Job("a", "s", [], 1, 10, 100, checkpoints=True)
        self.assertAlmostEqual(
            simulate([job], failing([9], checkpoint_s=1, repair_s=7)).wall_s, 9 + 7 + 110
        )

    def test_another_node_takes_over(self) -> None:
        found = simulate([Job("a", "s", [], 1, 0, 100)], failing([40], nodes=2, repair_s=1000))
        self.assertAlmostEqual(found.wall_s, 140)

    def test_a_failure_takes_all_tasks_of_the_node(self) -> None:
        found = simulate(
            [
                Job("a", "s", [], 1, 0, 100),
                Job("b", "s", [], 1, 0, 30),
                Job("c", "s", [], 1, 0, 100),
            ],
            failing([40], cores=3, repair_s=10),
        )
        self.assertEqual(len(found.attempts), 5)  # b had ended
        self.assertAlmostEqual(found.wall_s, 150)

    def test_failures_only_lengthen(self) -> None:
        graph = jobs()
        for nodes in 1, 4, 50:
            sound = simulate(graph, Farm(nodes, 8)).wall_s
            for seed in range(5):
                found = simulate(graph, Farm(nodes, 8, failure_s=40, repair_s=20, seed=seed))
                if found.failures:
                    self.assertGreaterEqual(found.wall_s, sound * (1 - 1e-9))
        self.assertGreater(found.failures, 0)

    def test_nodes_that_never_last_are_named(self) -> None:
        with self.assertRaisesRegex(ValueError, "a has failed"):
            simulate([Job("a", "s", [], 1, 0, 100)], quick(1, failure_s=0.1, repair_s=0.1))

    def test_a_task_wider_than_a_node_is_refused(self) -> None:
        with self.assertRaisesRegex(ValueError, "8 cores"):
            Simulation([Job("a", "s", [], 8)], quick(1, 4))


class Graph(unittest.TestCase):
    def test_tasks_are_those_of_the_pipelines(self) -> None:
        names = [job.name for job in jobs() if job.cores]
        self.assertEqual(len(names), 4 + 1 + 1 + 4 + 1 + 5 * (3 + 1))
        self.assertIn("render-000005-3-of-3", names)
        self.assertIn("merge-render-000005", names)

    def test_files_wait_for_less_than_stages(self) -> None:
        graph = jobs("--order", "files")
        merge = next(job for job in graph if job.name == "merge-render-000001")
        self.assertEqual(
            sorted(graph[k].name for k in merge.needs),
            [f"render-000001-{n}-of-3" for n in (1, 2, 3)],
        )
        merge = next(job for job in jobs() if job.name == "merge-render-000001")
        self.assertEqual([jobs()[k].name for k in merge.needs], ["end of render"])

    def test_scatter_keeps_the_mean_and_the_seed_decides_it(self) -> None:
        plain, scattered = jobs("--scatter", "0"), jobs("--frames", "400")
        frames = [job.cpu_s for job in scattered if job.stage == "render"]
        expected = next(job.cpu_s for job in plain if job.stage == "render")
        self.assertAlmostEqual(sum(frames) / len(frames) / expected, 1, delta=0.03)
        self.assertGreater(max(frames), 1.1 * expected)
        self.assertEqual(scattered, jobs("--frames", "400"))
        self.assertNotEqual(scattered, jobs("--frames", "400", "--chance", "2"))

    def test_more_cores_take_less_wall_time_and_the_same_cpu_time(self) -> None:
        few, many = jobs("--scatter", "0"), jobs("--scatter", "0", "--cpus", "render=16")
        k = next(k for k, job in enumerate(few) if job.stage == "render")
        self.assertAlmostEqual(few[k].work_s / many[k].work_s, 4)
        self.assertAlmostEqual(few[k].cpu_s, many[k].cpu_s)

    def test_the_scale_is_of_all_but_loading(self) -> None:
        one, two = jobs("--scatter", "0"), jobs("--scatter", "0", "--scale", "render=2")
        k = next(k for k, job in enumerate(one) if job.stage == "render")
        loading = cost.load().loading_s("render", cost.Counts(triangles=1e6))
        self.assertAlmostEqual(two[k].cpu_s - loading, 2 * (one[k].cpu_s - loading))
        self.assertAlmostEqual(two[k].work_s, 2 * one[k].work_s)


class Command(unittest.TestCase):
    def test_the_same_options_print_the_same(self) -> None:
        words = ["--nodes", "2,30", "--failure-hours", "0.01"]
        self.assertEqual(printed(*words), printed(*words))
        self.assertNotEqual(printed(*words), printed(*words, "--chance", "2"))

    def test_what_failures_lose_is_counted(self) -> None:
        graph = [Job("a", "s", [], 2, 10, 100, checkpoints=True)]
        site = failing([55], cores=2, checkpoint_s=20, repair_s=7)
        row = farm.row_of(graph, site, simulate(graph, site), 0)
        # The work since the checkpoint is lost, and the set-up is repeated.
        self.assertAlmostEqual(row["lost_h"] * 3600, 2 * (5 + 10))

    def test_the_picture_is_whole(self) -> None:
        import xml.etree.ElementTree

        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "farm.svg"
            printed("--nodes", "1,4,16,64", "--svg", str(picture))
            rows = list(xml.etree.ElementTree.parse(picture).iter())
        self.assertEqual(sum(row.tag.endswith("circle") for row in rows), 4)
        self.assertGreaterEqual(sum(row.tag.endswith("polygon") for row in rows), 4)

    def test_the_picture_replaces_only_a_picture(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            picture = Path(folder) / "farm.svg"
            for text in ("<svg></svg>", "<?xml version='1.0'?>\n<!DOCTYPE svg>\n<svg></svg>", ""):
                picture.write_text(text)
                printed("--nodes", "1", "--svg", str(picture))
                self.assertGreater(len(picture.read_text()), 1000)
            model = Path(folder) / "model.json"
            model.write_bytes(cost.MODEL.read_bytes())
            picture.write_bytes(b"\x89VPL\r\n\x1a\n")
            for file, problem in (
                (picture, "is not an SVG picture, which --svg would replace it with; name another"),
                (model, "is the file of --model, which the run reads; name another file for --svg"),
                (Path(folder), "is a folder; name a file for --svg"),
            ):
                before = file.read_bytes() if file.is_file() else None
                with self.assertRaises(SystemExit) as refused:
                    printed("--nodes", "1", "--model", str(model), "--svg", str(file))
                self.assertRegex(str(refused.exception), f"^[^\n]*: {file}: {problem}")
                self.assertEqual(file.read_bytes() if file.is_file() else None, before)
            self.assertEqual(len(list(Path(folder).iterdir())), 2)

    def test_wrong_options_are_refused(self) -> None:
        for words in (
            ["--nodes", "0"],
            ["--quality", "final"],
            ["--render-flags=--gather all"],
            ["--size", "640"],
            ["--cpus", "64"],
            ["--frames", "0"],
        ):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                farm.arguments([*FILM, *words])
        for words, problem in (
            (["--vpls", "100x"], "--vpls: '100x' is no count"),
            (["--spp", ""], "--spp: '' is no count"),
        ):
            with self.assertRaises(SystemExit) as refused:
                printed("--nodes", "1", *words)
            self.assertIn(problem, str(refused.exception))


if __name__ == "__main__":
    unittest.main()
