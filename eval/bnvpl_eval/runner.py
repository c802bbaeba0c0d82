"""Runs each command of the tools once: outputs are cached under a key of all that they depend on.

A key is the hash of the executable, the options, the number of threads, and the keys or bytes of
the inputs. A changed option, tool or scene reruns exactly the commands that depend on it. Each run
writes run.json beside its outputs: command, key, wall and CPU seconds, peak memory. What the tool
printed is in log.txt, its messages in messages.txt.
"""

import json
import math
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .scene_files import NAMING, digest, scene_key
from .settings import ROOT

DAY_S = 86400


class ToolFailed(SystemExit):
    """Ends the program with the tool's message, unless it is caught."""

    def __init__(self, command: list[str], code: int, message: str) -> None:
        super().__init__(f"eval: {' '.join(command)}\nfailed with exit code {code}: {message}")
        self.exit_code = code
        self.message = message


class TookTooLong(Exception):
    """A run was stopped at the limit of CPU seconds that Runner.limited set."""


@dataclass
class Run:
    folder: Path
    record: dict[str, Any]

    def __getitem__(self, name: str) -> Path:
        return self.folder / name

    @property
    def cpu_s(self) -> float:
        result: float = self.record["cpu_s"]
        return result


@dataclass
class Runner:
    bin: Path
    cache: Path
    quiet: bool = False
    # Commit, processor and date go into every run.json.
    provenance: dict[str, Any] = field(default_factory=dict)
    runs: dict[str, Run] = field(default_factory=dict)  # all requested runs, by key
    limited_tool: str = ""
    limit_cpu_s: float = math.inf  # a run of this tool that needs more is stopped
    _swept: bool = False  # whether what others left in the cache has been looked for
    _files: dict[Path, str] = field(default_factory=dict)
    # Time and size of each tool when it was first used.
    _tools: dict[Path, tuple[Any, ...]] = field(default_factory=dict)

    def file_key(self, path: Path) -> str:
        """Key of a file: that of the run that made it, or a hash of its bytes and of the files that
        it names."""
        if path.is_relative_to(self.cache):
            return path.parent.name + "/" + path.name
        if path not in self._files:
            self._files[path] = (
                scene_key(path) if path.name.endswith(NAMING) else digest(path.read_bytes())
            )
        return self._files[path]

    def run(
        self, tool: str, options: list[Any], inputs: dict[str, Path], outputs: list[str]
    ) -> Run:
        """Runs a command unless it is cached.

        `options` may hold '{name}' for an input and '@name' for an output in the run's folder.
        """
        words = [str(word) for word in options]
        executable = self.bin / tool
        self._require_unchanged(executable)
        key = digest(
            json.dumps(
                [
                    tool,
                    self.file_key(executable),
                    words,
                    self.provenance.get("threads"),  # CPU times depend on it
                    {name: self.file_key(path) for name, path in inputs.items()},
                ]
            ).encode()
        )
        if key in self.runs and self.runs[key].cpu_s <= self._limit_of(tool):
            return self.runs[key]
        folder = self.cache / key
        if not (folder / "run.json").is_file():
            if self._was_stopped(key, tool):
                raise TookTooLong
            self._execute(key, executable, words, inputs, folder)
        for name in outputs:
            if not (folder / name).is_file():
                raise SystemExit(
                    f"eval: {folder / name}: missing from the cache; delete {folder} and rerun"
                )
        run = Run(folder, json.loads((folder / "run.json").read_text()))
        if run.cpu_s > self._limit_of(tool):
            raise TookTooLong
        self.runs[key] = run
        return run

    @contextmanager
    def limited(self, tool: str, cpu_s: float) -> Iterator[None]:
        """Within it, runs of a tool that need more CPU time raise TookTooLong, cached ones too."""
        self.limited_tool, self.limit_cpu_s = tool, cpu_s
        try:
            yield
        finally:
            self.limited_tool, self.limit_cpu_s = "", math.inf

    def _limit_of(self, tool: str) -> float:
        return self.limit_cpu_s if tool == self.limited_tool else math.inf

    def _stopped(self, key: str) -> Path:
        """The file that remembers at which limit of CPU seconds a run was stopped."""
        return self.cache / f"{key}.stopped"

    def _was_stopped(self, key: str, tool: str) -> bool:
        stopped = self._stopped(key)
        return stopped.is_file() and float(stopped.read_text()) >= self._limit_of(tool)

    def _require_unchanged(self, executable: Path) -> None:
        """Ends the program if a tool has changed, so that no report mixes two versions of it."""
        now = executable.stat()
        if self._tools.setdefault(executable, (now.st_mtime_ns, now.st_size)) != (
            now.st_mtime_ns,
            now.st_size,
        ):
            raise SystemExit(
                f"eval: {executable}: was built anew during the run; start again, or evaluate a "
                "copy of "
                "the tools (--bin)"
            )

    def _set_limit(self) -> None:
        seconds = math.ceil(self.limit_cpu_s)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))

    def _execute(
        self, key: str, executable: Path, words: list[str], inputs: dict[str, Path], folder: Path
    ) -> None:
        self._sweep()
        partial = folder.with_name(f".{key}.partial-{os.getpid()}")
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
        try:
            self._execute_in(partial, key, executable, words, inputs)
            os.rename(partial, folder)
        except OSError:
            if not folder.is_dir():  # else another evaluation has made the same run, of equal bytes
                raise
        finally:
            shutil.rmtree(partial, ignore_errors=True)

    def _sweep(self) -> None:
        """Removes what processes that are gone left unfinished a day ago or before."""
        if self._swept:
            return
        self._swept = True
        for left in self.cache.glob(".*.partial-*"):
            process = left.name.rpartition("-")[2]
            if not Path("/proc", process).exists() and left.stat().st_mtime < time.time() - DAY_S:
                shutil.rmtree(left, ignore_errors=True)

    def _execute_in(
        self, partial: Path, key: str, executable: Path, words: list[str], inputs: dict[str, Path]
    ) -> None:
        command = [str(executable)]
        for word in words:
            if word.startswith("@"):
                word = str(partial / word[1:])
            elif word.startswith("{"):
                word = str(inputs[word[1:-1]])
            command.append(word)
        if not self.quiet:
            print(f"eval: {executable.name} {' '.join(words)}", file=sys.stderr, flush=True)
        begin = time.monotonic()
        with (
            (partial / "log.txt").open("wb") as log,
            (partial / "messages.txt").open("wb") as messages,
        ):
            child = subprocess.Popen(
                command,
                stdout=log,
                stderr=messages,
                cwd=ROOT,
                preexec_fn=self._set_limit if executable.name == self.limited_tool else None,
            )
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        wall = time.monotonic() - begin
        if child.returncode != 0:
            text = "\n".join(
                (partial / name).read_text(errors="replace").strip()
                for name in ("log.txt", "messages.txt")
            )
            if child.returncode == -signal.SIGXCPU:
                self._stopped(key).write_text(f"{self.limit_cpu_s}\n")
                raise TookTooLong
            raise ToolFailed(command, child.returncode, text.strip())
        stats = partial / "stats.json"
        peak_mib = usage.ru_maxrss / 1024  # that of this program where it is larger
        if stats.is_file():
            peak_mib = json.loads(stats.read_text()).get("peak_memory_MiB", peak_mib)
        record = {
            "tool": executable.name,
            "options": words,
            "inputs": {name: self.file_key(path) for name, path in inputs.items()},
            "key": key,
            "wall_s": round(wall, 3),
            "cpu_s": round(usage.ru_utime + usage.ru_stime, 3),
            "peak_mib": round(peak_mib, 1),
            **self.provenance,
        }
        with (partial / "run.json").open("w") as file:
            json.dump(record, file, indent=1)
            file.flush()
            os.fsync(file.fileno())
