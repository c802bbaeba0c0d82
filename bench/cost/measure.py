"""Runs the tools and measures them: CPU seconds of one thread, peak memory, size of the file."""

import json
import os
import subprocess
import sys


class Bench:
    """Makes what a run reads, once, and keeps it in the folder."""

    def __init__(self, bin_folder, folder):
        self.bin, self.folder, self.spent_s, self.made = bin_folder, folder, 0.0, {}

    def run(self, tool, *words):
        """(CPU seconds, MiB)"""
        stats = self.folder / "stats.json"
        command = [
            str(w) for w in (self.bin / tool, *words, "--quiet", "--threads", "1", "--stats", stats)
        ]
        # A shell between, which forks: Linux counts the memory of the process that starts a tool as the tool's.
        process = subprocess.Popen(
            ["sh", "-c", '"$@"; exit $?', "sh", *command], stderr=subprocess.PIPE, text=True
        )
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            sys.exit(f"cost_model.py: {said.strip()}")
        cpu_s = usage.ru_utime + usage.ru_stime
        self.spent_s += cpu_s
        return cpu_s, json.loads(stats.read_text())["peak_memory_MiB"]

    def once(self, name, make):
        """The file of this name, which make(file) writes the first time."""
        if name not in self.made:
            self.made[name] = self.folder / name
            make(self.made[name])
        return self.made[name]

    def candidates(self, scene, n):
        return self.once(
            f"{scene.name}.{n:.0f}.candidates.vpl",
            lambda file: self.run("vpl-place", scene.file, "-o", file, "-n", f"{n:.0f}"),
        )

    def vpls(self, scene, n):
        return self.once(
            f"{scene.name}.{n:.0f}.vpls.vpl",
            lambda file: self.run(
                "vpl-eliminate", self.candidates(scene, 10 * n), "-o", file, "-n", f"{n:.0f}"
            ),
        )

    def lit(self, scene, n):
        return self.once(
            f"{scene.name}.{n:.0f}.lit.vpl",
            lambda file: self.run(
                "vpl-estimate",
                scene.file,
                self.vpls(scene, n),
                "-o",
                file,
                "--method",
                "guarded",
                "--photons",
                f"{50 * n:.0f}",
            ),
        )

    def command(self, scene, stage, c, part=1):
        """(tool, words without -o, ending)"""
        shard = ["--shard", f"{part}/{c.shards}"] if c.shards > 1 else []
        if stage == "place":
            return "vpl-place", [scene.file, "-n", f"{c.candidates:.0f}", *shard], "vpl"
        if stage == "eliminate":
            return (
                "vpl-eliminate",
                [self.candidates(scene, c.candidates), "-n", f"{c.vpls:.0f}"],
                "vpl",
            )
        if stage == "estimate":
            return (
                "vpl-estimate",
                [
                    scene.file,
                    self.vpls(scene, c.vpls),
                    "--photons",
                    f"{c.photons:.0f}",
                    "--irradiance-error",
                    "0",
                    *shard,
                ],
                "vpl",
            )
        width = round((c.pixels * 4 / 3) ** 0.5)
        return (
            "vpl-render",
            [
                scene.file,
                self.lit(scene, c.vpls),
                "--size",
                f"{width}x{c.pixels / width:.0f}",
                "--spp",
                f"{c.spp:.0f}",
                *shard,
            ],
            "exr",
        )

    def shards(self, scene, stage, c):
        """Those that a merge reads. Pixels are the same whatever has lit them: path tracing is fast."""

        def make(file, part):
            tool, words, _ = self.command(scene, stage, c, part)
            words = [words[0], "--integrator", "path", *words[2:]] if stage == "render" else words
            self.run(tool, *words, "-o", file)

        beside = f"{scene.name}.{stage}.{c.candidates:.0f}-{c.vpls:.0f}-{c.pixels:.0f}"
        return [
            self.once(
                f"{beside}.{part}-of-{c.shards}.shard", lambda file, part=part: make(file, part)
            )
            for part in range(1, c.shards + 1)
        ]

    def measure(self, scene, stage, c):
        """{figure: value}, of one run."""
        if stage.startswith("merge-"):
            kind = stage.removeprefix("merge-")
            tool, words, ending = (
                "vpl-merge",
                self.shards(scene, kind, c),
                "exr" if kind == "render" else "vpl",
            )
        else:
            tool, words, ending = self.command(scene, stage, c)
        output = self.folder / f"out.{'shard' if tool != 'vpl-merge' and c.shards > 1 else ending}"
        cpu_s, memory = self.run(tool, *words, "-o", output)
        found = {"cpu_s": cpu_s, "memory_MiB": memory}
        return found | ({} if tool == "vpl-merge" else {"file_bytes": output.stat().st_size})


class Repeated:
    """A run that is measured until its two least CPU times agree: other work on the machine only adds to them."""

    AGREE, MOST = 1.04, 8

    def __init__(self, row):
        self.row, self.taken = row, []

    def wanted(self):
        least = sorted(each["cpu_s"] for each in self.taken)[:2]
        return len(self.taken) < self.MOST and (len(least) < 2 or least[1] > self.AGREE * least[0])

    def result(self):
        return (
            self.row
            | {
                figure: round(min(each[figure] for each in self.taken), 4)
                for figure in self.taken[0]
            }
            | {"repeats": len(self.taken)}
        )
