"""Tessellates the Utah teapot from Martin Newell's bicubic Bezier patches.

Normals come from the derivatives of the patches. Newell's data has three openings. The bottom and
the tip of the spout stay open. The one between lid and rim would let light into the pot; a flat
ring, which is not Newell's, closes it.
"""

import math
from pathlib import Path

from .mesh import Mesh, Vector, grey, mtl

STEPS = 8  # segments along each side of a patch; 28 * 8 * 8 * 2 triangles in all
POINT_SIZE = 2e-3  # size below which a row of control points is one point (the tip of the knob)
NUDGE = 1e-4  # distance from such a point, in patch parameters, at which the normal is evaluated


def read_patches(path: Path) -> list[list[Vector]]:
    points: dict[int, Vector] = {}
    patches: list[list[Vector]] = []
    for row in path.read_text().splitlines():
        words = row.split()
        if words and words[0] == "v":
            points[int(words[1])] = tuple(map(float, words[2:]))
        elif words and words[0] == "p":
            patches.append([points[int(w)] for w in words[1:]])
    return [snap_points(patch) for patch in patches]


def snap_points(patch: list[Vector]) -> list[Vector]:
    """Replaces a border row that is a point up to rounding by that point."""
    for row in ((0, 1, 2, 3), (12, 13, 14, 15)):
        if all(math.dist(patch[row[0]], patch[i]) < POINT_SIZE for i in row):
            for i in row:
                patch[i] = patch[row[0]]
    return patch


def bernstein(t: float) -> Vector:
    s = 1 - t
    return (s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t)


def bernstein_slope(t: float) -> Vector:
    s = 1 - t
    return (-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t)


def blend(patch: list[Vector], row_weights: Vector, column_weights: Vector) -> Vector:
    return tuple(
        sum(
            row_weights[i] * column_weights[j] * patch[4 * i + j][axis]
            for i in range(4)
            for j in range(4)
        )
        for axis in range(3)
    )


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def normal_at(patch: list[Vector], row: float, column: float) -> Vector:
    """Unit normal, which points out of the pot, as all of Newell's patches have one orientation."""
    along_row = blend(patch, bernstein(row), bernstein_slope(column))
    along_column = blend(patch, bernstein_slope(row), bernstein(column))
    n = cross(along_column, along_row)
    size = math.hypot(*n)
    if size < 1e-7:  # a side of the patch is a point here: evaluate inside
        inside = NUDGE if row < 0.5 else 1 - NUDGE
        return normal_at(patch, inside, column)
    return tuple(c / size for c in n)


def add_patch(mesh: Mesh, patch: list[Vector], steps: int) -> None:
    def corner(i: int, j: int) -> tuple[Vector, Vector]:
        row, column = i / steps, j / steps
        return blend(patch, bernstein(row), bernstein(column)), normal_at(patch, row, column)

    grid = [[corner(i, j) for j in range(steps + 1)] for i in range(steps + 1)]
    for i in range(steps):
        for j in range(steps):
            a, b, c, d = grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]
            for triangle in ((a, b, c), (a, c, d)):
                mesh.face("Teapot", *zip(*triangle, strict=True))


def add_ring(mesh: Mesh, patches: list[list[Vector]], steps: int) -> None:
    """Joins the edge of the lid (last row of patches 24..27) to the rim (first row of 0..3)."""
    up = (0, 1, 0)
    for lid, rim in zip(patches[24:28], patches[0:4], strict=True):
        inner = [blend(lid, bernstein(1), bernstein(j / steps)) for j in range(steps + 1)]
        outer = [blend(rim, bernstein(0), bernstein(j / steps)) for j in range(steps + 1)]
        for j in range(steps):
            quad = (inner[j], outer[j], outer[j + 1], inner[j + 1])
            mesh.face("Teapot", quad, (up,) * 4)


def files(folder: Path) -> dict[str, str | bytes]:
    patches = read_patches(folder / "newell-patches.txt")
    mesh = Mesh(
        "Utah teapot, tessellated by scenes/generate.py from Newell's patches", "teapot.mtl"
    )
    mesh.object("Teapot")
    for patch in patches:
        add_patch(mesh, patch, STEPS)
    add_ring(mesh, patches, STEPS)
    note = "One material, 'Teapot'; a scene chooses which with `materials`."
    glossy = {"Kd": (0.35, 0.12, 0.04), "Ks": (0.4, 0.3, 0.2), "Ns": 30, "illum": 2}
    return {
        "teapot/teapot.obj": mesh.text(),
        "teapot/teapot.mtl": mtl(note, {"Teapot": {"Kd": grey(0.75)}}),
        "teapot/glossy.mtl": mtl(note, {"Teapot": glossy}),
        "teapot/mirror.mtl": mtl(note, {"Teapot": {"Ks": grey(0.9), "Ns": 1000, "illum": 3}}),
    }
