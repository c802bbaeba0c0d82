"""Guards the outputs as the pipelines do: a refusal ends the program in one line."""

import functools
import sys

from .settings import ROOT

sys.path.append(str(ROOT / "pipelines"))
import output_guard  # noqa: E402

__all__ = ["guarded", "output_guard"]

guarded = functools.partial(output_guard.or_exit, program="eval")
