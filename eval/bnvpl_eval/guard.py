"""The guard of outputs, which the pipelines share: its problems end the program in one line."""

import functools
import sys

from .settings import ROOT

sys.path.append(str(ROOT / "pipelines"))
import output_guard  # noqa: E402

guarded = functools.partial(output_guard.or_exit, program="eval")
