"""Progress of a running tool."""

from __future__ import annotations

import json
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """How far a tool is with a phase of its work."""

    phase: str  # "photons"
    done: int
    total: int | None  # nothing if unknown
    elapsed_s: float  # since the phase began
    left_s: float | None  # expected until it ends

    @property
    def share(self) -> float:
        """Done part of the whole, 0 to 1; 0 if the whole is unknown."""
        return self.done / self.total if self.total else 0.0


def progress_of(line: str) -> Progress | None:
    """The progress that a line of --progress json tells; nothing for another line."""
    if not line.startswith("{"):
        return None
    told = json.loads(line)
    return Progress(*(told[name] for name in ("phase", "done", "total", "elapsed_s", "left_s")))
