#!/usr/bin/env python3
"""Renders the references that are missing: eval/references.py [--film-width 80] [SCENE-VIEW ...]"""

import argparse
import sys
from pathlib import Path

from bnvpl_eval import references, settings
from bnvpl_eval.runner import Runner


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("views", nargs="*", help="such as u-shape-main; all unless given")
    parser.add_argument("--bin", type=Path, default=settings.ROOT / "build/release/bin")
    parser.add_argument("--cache", type=Path, default=settings.ROOT / "build/eval/cache")
    parser.add_argument("--film-width", type=int, default=80, help="pixels")
    parser.add_argument(
        "--spp", type=int, help="of a half; those of settings.toml, for 80 pixels, unless given"
    )
    arguments = parser.parse_args()
    runner = Runner(arguments.bin.resolve(), arguments.cache.resolve())
    scenes, _ = settings.load()
    views = {view.name: view for scene in scenes for view in scene.views}
    if unknown := [name for name in arguments.views if name not in views]:
        raise SystemExit(f"eval: no view '{unknown[0]}'; settings.toml has {', '.join(views)}")
    for view in (views[name] for name in arguments.views or views):
        if not view.scene.available:
            print(f"eval: {view.name} left out: set {view.scene.define}", file=sys.stderr)
            continue
        film = view.scene.film(arguments.film_width)
        for half in "ab":
            spp = arguments.spp or references.spp_of(view, film)
            references.render_half(runner, view, film, spp, half)
        references.require(view, film)
        halves = references.load(view, film, "indirect")
        print(
            f"{view.name} {film}: halves differ by {references.half_difference(halves):.4f} of "
            "the mean (RMS)",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
