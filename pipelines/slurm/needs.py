"""Memory and time to ask Slurm for, where none is given: what cost.py predicts for the scene's triangles, the counts
and the film, with room for scenes in which light takes more work than in that to which its rates were fitted.
"""

import json
import math
import re
import shlex
import subprocess

import cost
import stages

ROOM_MEMORY, SPARE_MIB = 1.5, 256
ROOM_TIME, SPARE_MIN = 4, 10


def look(scene, options, *more):
    """What vpl-inspect understands of the scene."""
    defines = [word for pair in options.define for word in ("--define", pair)]
    command = [f"{options.bin}/vpl-inspect", "scene", scene, "--json", *defines, *more]
    try:
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    except FileNotFoundError:
        stages.refuse(
            f"there is no {command[0]}, which looks at the scene; build the tools, or give --memory and --time"
        )
    if done.returncode:
        stages.refuse(done.stderr.strip() + "; or give --memory and --time")
    return json.loads(done.stdout)


def pixels_of(seen, options):
    """Of the largest film."""
    words = shlex.split(options.render_flags)
    if "--size" in words[:-1]:
        films = [words[words.index("--size") + 1]]
    elif options.views:
        films = [
            look(options.scene, options, "--view", view)["cameras"][0]["film"]
            for view in options.views
        ]
    else:
        films = [seen["cameras"][0]["film"]]
    sizes = [re.fullmatch(r"(\d+)x(\d+)", film) for film in films]
    return max((int(size[1]) * int(size[2]) for size in sizes if size), default=0)


class Needs:
    """Looks at the scene when it is first asked."""

    def __init__(self, options):
        self.options, self.model, self.whole = options, cost.load(), None

    def predict(self, stage, figure):
        if self.whole is None:
            o = self.options
            seen = look(o.scene, o)
            try:
                counts = [
                    cost.count(text) for text in (o.candidates, o.vpls, o.photons, o.spp or "256")
                ]
            except ValueError as problem:
                stages.refuse(str(problem))
            self.whole = cost.Counts(seen["triangles"], *counts[:3], pixels_of(seen, o), counts[3])
        return self.model.predict(
            stage, figure, cost.with_shards(self.whole, stage, self.options.shards)
        )

    def memory(self, stage):
        """As of sbatch --mem."""
        mib = 0 if stage == "summary" else self.predict(stage, "memory_MiB")
        return f"{math.ceil((ROOM_MEMORY * mib + SPARE_MIB) / 64) * 64}M"

    def time(self, stage, cores):
        """In minutes, as of sbatch --time."""
        seconds = 0 if stage == "summary" else self.predict(stage, "cpu_s") / cores
        return str(SPARE_MIN + math.ceil(ROOM_TIME * seconds / 60))
