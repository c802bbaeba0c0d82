"""VPLs that other programs made, and write_vpl(), which takes them as well."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .layout import StrPath
from .tools import run, scene_hash
from .vpl_read import read_vpl
from .vpl_write import contents, save
from .vpls import Vpls, complete

TWO_SQRT3 = 2 * math.sqrt(3)  # share of the surface = 2 sqrt(3) radius^2


def share_radii(position: npt.ArrayLike, normal: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """Radius of each VPL by the share of the surface that it stands for, as vpl-place gives it.

    The share follows from the distance to the 20th nearest VPL on a compatible surface. It is
    2 sqrt(3) radius^2. vpl-eliminate computes it: it keeps all VPLs here. Raises ValueError, with
    column and row, where a value is invalid.
    """
    candidates = complete({"position": position, "normal": normal})
    content = b"".join(contents(candidates))
    if len(candidates) == 0:
        return np.zeros(0, np.float32)
    with tempfile.TemporaryDirectory(prefix="bnvpl.") as folder:
        before, after = Path(folder) / "before.vpl", Path(folder) / "after.vpl"
        before.write_bytes(content)
        run(
            "vpl-eliminate",
            before,
            output=after,
            count=len(candidates),
            method="random",
            uniform_share=0,
        )
        return read_vpl(after).radius.copy()


def make_vpls(columns: Mapping[str, npt.ArrayLike], scene: StrPath | None = None) -> Vpls:
    """VPLs of the given columns: position and normal; with flux they are lit.

    What is not given: see complete(). Radii are those of share_radii(). Without `scene` they belong
    to no scene, and a tool refuses them.
    """
    given = dict(columns)
    if "flux" in given and "radius" not in given and {"position", "normal"} <= given.keys():
        given["radius"] = share_radii(given["position"], given["normal"])
    vpls = complete(given)
    if "radius" in vpls.columns:
        vpls.area = TWO_SQRT3 * float(np.square(vpls.radius, dtype=float).sum())
        vpls.r_max = math.sqrt(vpls.area / (TWO_SQRT3 * max(1, len(vpls))))
    if scene is not None:
        vpls.scene_hash = scene_hash(scene)
    return vpls


def write_vpl(
    path: StrPath, vpls: Vpls | Mapping[str, npt.ArrayLike], scene: StrPath | None = None
) -> None:
    """Writes VPLs, whole or not at all.

    Columns alone are enough, as {"position": ..., "normal": ..., "flux": ...}: make_vpls()
    completes them. `scene` tells whose VPLs they are; the tools refuse those of another scene.
    Without it VPLs keep the scene that they were read with. Raises ValueError, with column and row,
    where a value is invalid.
    """
    if not isinstance(vpls, Vpls):
        try:
            vpls = make_vpls(vpls, scene)
        except ValueError as error:
            raise ValueError(f"{os.fspath(path)}: not written: {error}") from None
    elif scene is not None:
        vpls = replace(vpls, scene_hash=scene_hash(scene))
    save(path, vpls)
