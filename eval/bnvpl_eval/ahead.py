"""Runs scenes of an evaluation at the same time, each on a processor of its own."""

import argparse
import itertools
import os
import queue
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def run_ahead(program: Path, arguments: argparse.Namespace, scenes: list[str]) -> None:
    """Fills the cache by an evaluation of each scene, `--jobs` at a time.

    One thread a run keeps a processor busy while files are read or trees are built, and what two
    threads share is not counted. The tools take as many threads as processors that they may use.
    """
    processors = sorted(os.sched_getaffinity(0))[: arguments.jobs]
    free: queue.SimpleQueue[int] = queue.SimpleQueue()
    for processor in processors:
        free.put(processor)

    def evaluate(scene: str) -> None:
        processor = free.get()
        with tempfile.TemporaryDirectory() as folder:
            options = {
                "--size": arguments.size,
                "--parts": arguments.parts,
                "--settings": arguments.settings,
                "--scenes": scene,
                "--views": arguments.views,
                "--bin": arguments.bin,
                "--cache": arguments.cache,
                "--commit": arguments.commit,
                "--output": folder,
            }
            given = {name: value for name, value in options.items() if value}
            words = [str(word) for word in itertools.chain(*given.items())]
            words += ["--quiet"] if arguments.quiet else []
            pinned = ["taskset", "--cpu-list", str(processor), sys.executable, str(program)]
            try:
                done = subprocess.run([*pinned, *words], stdout=subprocess.DEVNULL)
            finally:
                free.put(processor)
        if done.returncode != 0:
            raise SystemExit(f"eval: scene '{scene}' failed; its messages stand above")

    with ThreadPoolExecutor(len(processors)) as pool:
        list(pool.map(evaluate, scenes))
