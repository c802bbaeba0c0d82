# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests inside Blender: test_blender.py BIN [TEST...]; skipped where there is none."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

SKIPPED = 77


def main() -> int:
    blender = os.environ.get("BLENDER") or shutil.which("blender")
    if blender is None:
        print("skipped: no blender; apt-get install --no-install-recommends blender")
        return SKIPPED
    folder = Path(sys.argv[1]).resolve()
    command = [blender, "--background", "--factory-startup", "--python-exit-code", "1"]
    command += ["--python", str(Path(__file__).with_name("in_blender.py")), "--", *sys.argv[2:]]
    environment = os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"}
    return subprocess.run(command, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
