#!/usr/bin/env python3
"""Tests pipelines/slurm/submit.py without Slurm: stand-ins for its commands run each task at once.

tests/cluster/test_submit.py build/release/bin
"""

import filecmp
import itertools
import json
import re
import subprocess

import slurm_stand_in
from slurm_stand_in import SIZES, SOURCE, SlurmTest


class SubmitTest(SlurmTest):
    def test_makes_what_one_run_makes_and_later_only_what_is_missing(self) -> None:
        done = self.submit("--shards", "3")
        self.assertEqual(done.returncode, 0, done.stdout)
        jobs = self.jobs()
        self.assertEqual(
            list(jobs),
            [
                "place",
                "merge-place",
                "eliminate",
                "estimate",
                "merge-estimate",
                "render",
                "merge-render",
                "summary",
            ],
        )
        self.assertTrue(all(job["well"] for job in jobs.values()), self.logs())
        self.assertEqual(jobs["render"]["tasks"], [1, 2, 3])
        self.assertIn("--dependency=afterok:105", jobs["render"]["words"])
        self.assertIn("--requeue", jobs["render"]["words"])
        self.assertIn("critical path", self.at("run/summary.log").read_text())
        self.assertTrue(self.at("run/timeline.svg").read_text().startswith("<svg"))
        whole = self.folder / "whole"
        self.call(
            "pipelines/generate_ninja.py",
            "scenes/u-shape/scene.toml",
            "--out",
            str(whole),
            "--bin",
            str(self.bin),
            *SIZES,
        )
        subprocess.run(
            ["ninja", "-f", str(whole / "build.ninja")],
            cwd=SOURCE,
            check=True,
            stdout=subprocess.DEVNULL,
        )
        for name in ("candidates.vpl", "vpls.vpl", "lit.vpl", "image.exr", "image.png"):
            self.assertTrue(
                filecmp.cmp(self.at(name), whole / "u-shape" / name, shallow=False), name
            )

        again = self.submit("--shards", "3")
        self.assertIn("is up to date", again.stdout)
        self.assertEqual(self.jobs(), {})
        self.at("shards/render-2-of-3.shard").unlink()
        self.assertEqual(self.submit("--shards", "3").returncode, 0)
        jobs = self.jobs()
        self.assertEqual(list(jobs), ["render", "merge-render", "summary"])
        self.assertEqual(jobs["render"]["tasks"], [2])
        self.assertEqual(self.submit("--shards", "3", "--photons", "30k").returncode, 0)
        self.assertEqual(
            list(self.jobs()), ["estimate", "merge-estimate", "render", "merge-render", "summary"]
        )
        # A task that is done does nothing when Slurm starts it again.
        task = self.call("pipelines/slurm/task.py", str(self.at("run/eliminate.job.json")))
        self.assertIn("is up to date", task.stdout)

    def test_what_fails_stops_what_comes_after_it_and_is_made_by_the_next_submission(self) -> None:
        self.submit("--shards", "2", "--estimate-flags=--method even --paths 3")
        jobs = self.jobs()
        self.assertFalse(jobs["estimate"]["well"])
        self.assertFalse(jobs["render"]["well"])
        self.assertTrue(jobs["summary"]["well"])
        self.assertIn(
            "not done: estimate-1-of-2, exit code 2", self.at("run/summary.log").read_text()
        )
        self.assertFalse(self.at("lit.vpl").exists())
        self.submit("--shards", "2")
        jobs = self.jobs()
        self.assertEqual(
            list(jobs), ["estimate", "merge-estimate", "render", "merge-render", "summary"]
        )
        self.assertTrue(all(job["well"] for job in jobs.values()), self.logs())
        self.assertNotIn(
            "not done", self.at("run/summary.log").read_text().rpartition("tasks in")[2]
        )

    def test_ninja_records_what_its_tasks_take(self) -> None:
        self.call(
            "pipelines/generate_ninja.py",
            "scenes/u-shape/scene.toml",
            "--out",
            str(self.folder / "out"),
            "--bin",
            str(self.bin),
            "--shards",
            "2",
            "--record",
            *SIZES,
        )
        ninja = ["ninja", "-f", str(self.folder / "out/build.ninja")]
        subprocess.run(ninja, cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)
        inspected = subprocess.run(
            [SOURCE / self.bin / "vpl-inspect", "run", self.at("run"), "--json"],
            text=True,
            stdout=subprocess.PIPE,
        )
        run = json.loads(inspected.stdout)
        self.assertEqual(
            [(stage["stage"], stage["tasks"]) for stage in run["stages"]],
            [
                ("place", 2),
                ("merge-place", 1),
                ("eliminate", 1),
                ("estimate", 2),
                ("merge-estimate", 1),
                ("render", 2),
                ("merge-render", 1),
            ],
        )
        self.assertEqual(len(run["critical_path"]["tasks"]), 7)
        again = subprocess.run(ninja, cwd=SOURCE, text=True, stdout=subprocess.PIPE)
        self.assertIn("no work to do", again.stdout)

    def test_records_of_other_shards_are_put_aside(self) -> None:
        self.submit("--shards", "2")
        self.submit("--shards", "3")
        names = {file.name.split(".")[0] for file in self.at("run").glob("*.task.json")}
        self.assertIn("place-1-of-3", names)
        self.assertNotIn("place-1-of-2", names)
        self.assertTrue(self.at("run/earlier/place-1-of-2.1.task.json").exists())
        self.submit("--shards", "2")  # whose shards are up to date
        self.assertTrue(self.at("run/place-1-of-2.1.task.json").exists())
        self.assertFalse(self.at("run/place-1-of-2.2.task.json").exists())
        self.assertTrue(self.at("run/earlier/place-1-of-3.1.task.json").exists())

    def test_shards_of_each_stage(self) -> None:
        done = self.submit("--dry-run", "--shards", "place=2,render=5")
        rows = {
            row.split("--job-name=u-shape-")[1].split()[0]: row for row in done.stdout.splitlines()
        }
        self.assertIn("--array=1-2 ", rows["place"])
        self.assertIn("--array=1-16 ", rows["estimate"])
        self.assertIn("--array=1-5 ", rows["render"])
        done = self.submit("--shards", "1", "--shards", "render=2")
        self.assertEqual(done.returncode, 0, done.stdout)
        jobs = self.jobs()
        self.assertEqual(
            list(jobs), ["place", "eliminate", "estimate", "render", "merge-render", "summary"]
        )
        self.assertTrue(all(job["well"] for job in jobs.values()), self.logs())
        self.assertEqual(jobs["render"]["tasks"], [1, 2])

    def test_limits_of_each_stage(self) -> None:
        done = self.submit(
            "--dry-run",
            "--memory",
            "2G,eliminate=9G",
            "--time",
            "render=2:00:00",
            "--cpus",
            "8",
            "--sbatch=--partition=long --nice",
            "--at-once",
            "5",
        )
        rows = {
            row.split("--job-name=u-shape-")[1].split()[0]: row for row in done.stdout.splitlines()
        }
        self.assertIn("--mem=9G --time=11 ", rows["eliminate"])
        self.assertIn("--mem=2G --time=2:00:00", rows["render"])
        self.assertIn("--cpus-per-task=8", rows["merge-place"])
        self.assertIn("--array=1-16%5", rows["place"])
        self.assertTrue(all("--partition=long --nice" in row for row in rows.values()))
        self.assertFalse(self.at("run").exists())

    def test_memory_and_time_follow_the_counts(self) -> None:
        def asked(*more: str) -> dict[str, list[int]]:
            done = self.submit("--dry-run", *more)
            self.assertEqual(done.returncode, 0, done.stdout)
            rows = {
                row.split("--job-name=u-shape-")[1].split()[0]: row
                for row in done.stdout.splitlines()
            }
            return {
                name: [int(re.findall(f"--{what}=(\\d+)", row)[0]) for what in ("mem", "time")]
                for name, row in rows.items()
            }

        small = asked()
        self.assertTrue(all(memory <= 384 and time <= 11 for memory, time in small.values()), small)
        large = asked(
            "--candidates",
            "100M",
            "--vpls",
            "1M",
            "--photons",
            "10G",
            "--spp",
            "64",
            "--render-flags=--size 3840x2160",
            "--shards",
            "estimate=4,render=4",
        )
        counts = ("100000k", "1000K", "1e10")
        others = dict(zip(("--candidates", "--vpls", "--photons"), counts, strict=True))
        again = asked(*itertools.chain(*others.items()))
        self.assertEqual(again["eliminate"], large["eliminate"])
        self.assertEqual(asked("--render-flags=--size=99x9"), asked("--render-flags=--size 99x9"))
        self.assertNotEqual(
            asked("--render-flags=--size=9000x9000"), asked("--render-flags=--size=99x9")
        )
        for stage in ("place", "eliminate", "estimate", "render", "merge-render"):
            self.assertGreater(large[stage][0], small[stage][0], stage)
        self.assertGreater(large["eliminate"][0], 15000)  # 100M candidates need 15 GiB
        for stage in ("eliminate", "estimate", "render"):
            self.assertGreater(large[stage][1], small[stage][1] + 5, stage)
        done = self.submit("--dry-run", "--bin", "nowhere")
        self.assertIn("nowhere/vpl-inspect", done.stdout)
        self.assertIn("--memory and --time", done.stdout)

    def test_errors_name_what_is_wrong(self) -> None:
        for more, problem in (
            (["--memory", "much"], "'much' is not a size"),
            (["--time", "paint=3"], "'paint' is none of"),
            (["--cpus", "0"], "'0' is not a count"),
            (["--shards", "0"], "--shards 0"),
            (["--shards", "merge=2"], "'merge' is none of place, estimate, render"),
            (["--place-flags=--method light"], "no work to vpl-estimate"),
            (["--at-once", "0"], "--at-once 0"),
            (["--out", "a b"], "'a b' contains a space"),
            (["--retries", "-1"], "--retries -1"),
            (["--spp", "1.5"], "--spp '1.5' is not a whole number"),
            (["--memory=1G", "--time=9", "--vpls=0"], "--vpls '0' is out of range"),
            (["--render-flags=--siz 3x3"], "--siz is no option of vpl-render; did you mean"),
        ):
            done = self.submit(*more)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(problem, done.stdout)
        limits = ["--memory", "1G", "--time", "9", "--dry-run", "--bin", "nowhere"]
        self.assertEqual(self.submit(*limits).returncode, 0)  # only nodes may have the tools
        for text, problem in (("many", "is not a whole number"), ("1e999", "is out of range")):
            self.assertIn(f"'{text}' {problem}", self.submit(*limits, "--photons", text).stdout)
        (self.folder / "slurm/sbatch").unlink()
        self.environment["PATH"] = f"{self.folder}/slurm"
        self.assertIn("there is no sbatch here", self.submit().stdout)

    def test_arrays_that_the_cluster_does_not_take_are_refused(self) -> None:
        def allow(size: int) -> None:
            shown = f"#!/bin/sh\necho 'MaxArraySize            = {size}'\n"
            self.program("slurm/scontrol", shown)

        allow(4)  # indices up to 3
        done = self.submit("--shards", "2,render=4")
        self.assertIn("'render' has 4 tasks, and the cluster's MaxArraySize allows 3", done.stdout)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(self.jobs(), {})
        allow(5)
        self.assertEqual(self.submit("--shards", "2,render=4").returncode, 0)

    def test_what_is_refused_moves_no_records_and_submits_nothing(self) -> None:
        self.submit("--shards", "2")
        before = sorted(file.name for file in self.at("run").rglob("*"))
        self.jobs()
        done = self.submit("--shards", "3", "--photons", "many", "--bin", str(self.bin.resolve()))
        self.assertNotEqual(done.returncode, 0)
        (self.folder / "slurm/sbatch").unlink()
        self.assertIn("there is no sbatch here", self.submit("--shards", "3").stdout)
        self.assertEqual(sorted(file.name for file in self.at("run").rglob("*")), before)
        self.assertEqual(self.jobs(), {})

    def test_files_of_others_stay(self) -> None:
        self.submit("--shards", "2")
        # A run replaces its own files.
        self.assertEqual(self.submit("--shards", "2", "--seed", "3").returncode, 0)
        self.jobs()
        for name, content in (
            ("jobs.json", '{"asset": {"version": "2.0"}}'),
            ("jobs.json", "[1"),
            ("render.job.json", "{}"),
            ("place.job.json", "\x89VPL"),
        ):
            file = self.at(f"run/{name}")
            own = file.read_bytes()
            file.write_text(content)
            done = self.submit("--shards", "2", "--seed", "4")
            self.assertRegex(
                done.stdout,
                rf"\Asubmit.py: \S*/{name}: is not a .* of this program, [^\n]*; name another "
                r"[^\n]*\n\Z",
            )
            self.assertEqual(done.returncode, 1)
            self.assertEqual(file.read_text(), content)
            file.write_bytes(own)
        self.assertEqual(self.jobs(), {})
        other = self.folder / "other/u-shape/run"
        other.parent.mkdir(parents=True)
        other.write_text("a file")
        self.assertIn(
            "is no folder, which the run needs there",
            self.submit("--out", str(self.folder / "other")).stdout,
        )

    def test_a_run_that_is_queued_is_not_submitted_again(self) -> None:
        self.submit("--shards", "1")
        (self.folder / "queued").write_text("101 101")
        done = self.submit("--shards", "1")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("101 of this run are still queued", done.stdout)


if __name__ == "__main__":
    slurm_stand_in.main()
