"""Writes polygons with shared vertices as OBJ and MTL.

Lengths are in metres, and y points up. The front of a face is where its corners run anti-clockwise.
An emissive face emits from its front.
"""

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

Vector = Sequence[float]


def number(value: float) -> str:
    """A number with six significant digits. Values that round to zero become '0', never '-0'."""
    if abs(value) < 1e-9:
        return "0"
    return f"{value:.6g}"


def line(tag: str, values: Iterable[float]) -> str:
    return " ".join([tag, *map(number, values)])


class Mesh:
    """A mesh whose positions, texture coordinates and normals are shared when they print alike."""

    def __init__(self, comment: str, mtllib: str) -> None:
        self.comment = comment
        self.mtllib = mtllib
        self.pools: dict[str, dict[str, int]] = {"v": {}, "vt": {}, "vn": {}}
        self.body: list[str] = []
        self.material: str | None = None

    def _index(self, tag: str, values: Vector) -> int:
        pool = self.pools[tag]
        return pool.setdefault(line(tag, values), len(pool) + 1)

    def object(self, name: str) -> None:
        self.body.append(f"o {name}")
        self.material = None

    def face(
        self,
        material: str,
        corners: Sequence[Vector],
        normals: Sequence[Vector] | None = None,
        uvs: Sequence[Vector] | None = None,
    ) -> None:
        """Adds a polygon. A triangle that collapses to an edge is left out."""
        v = [self._index("v", c) for c in corners]
        if len(v) == 3 and len(set(v)) < 3:
            return
        vt: list[Any] = [self._index("vt", t) for t in uvs] if uvs else [""] * len(v)
        vn = [self._index("vn", n) for n in normals] if normals else None
        if material != self.material:
            self.body.append(f"usemtl {material}")
            self.material = material
        if vn:
            words = [f"{a}/{b}/{c}" for a, b, c in zip(v, vt, vn, strict=True)]
        elif uvs:
            words = [f"{a}/{b}" for a, b in zip(v, vt, strict=True)]
        else:
            words = [str(a) for a in v]
        self.body.append("f " + " ".join(words))

    def box(
        self,
        low: Vector,
        high: Vector,
        material: str,
        faces: Mapping[str, str] | None = None,
        inward: bool = False,
        turn_deg: float = 0.0,
        pivot: tuple[float, float] | None = None,
    ) -> None:
        """Adds a closed box. `faces` names other materials by side ('-y': 'Lamp').

        With `inward` the box is a room. `turn_deg` rotates it about the vertical axis through
        `pivot` (x, z), by default its centre.
        """
        x, y, z = zip(low, high, strict=True)
        px, pz = pivot or (sum(x) / 2, sum(z) / 2)
        place = turn_y(turn_deg, px, pz)
        sides = {
            "-x": [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
            "+x": [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
            "-y": [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
            "+y": [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
            "-z": [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
            "+z": [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
        }
        for side, bits in sides.items():
            corners = [place((x[i], y[j], z[k])) for i, j, k in bits]
            if inward:
                corners.reverse()
            self.face((faces or {}).get(side, material), corners)

    def slab(
        self,
        xs: Vector,
        ys: Vector,
        z0: float,
        z1: float,
        is_solid: Callable[[int, int], bool],
        material: str,
    ) -> None:
        """Adds a closed upright slab between z0 < z1 on the grid xs * ys, with holes by is_solid.

        Neighbouring cells share their vertices, so the slab has no cracks around its holes.
        """
        columns, rows = len(xs) - 1, len(ys) - 1

        def solid(i: int, j: int) -> bool:
            return 0 <= i < columns and 0 <= j < rows and is_solid(i, j)

        for i in range(columns):
            for j in range(rows):
                if not solid(i, j):
                    continue
                x0, x1, y0, y1 = xs[i], xs[i + 1], ys[j], ys[j + 1]
                self.face(material, [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)])
                self.face(material, [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)])
                if not solid(i - 1, j):
                    self.face(material, [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)])
                if not solid(i + 1, j):
                    self.face(material, [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)])
                if not solid(i, j - 1):
                    self.face(material, [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)])
                if not solid(i, j + 1):
                    self.face(material, [(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)])

    def checker(self, xs: Vector, zs: Vector, y: float, materials: Sequence[str]) -> None:
        """Adds a checkerboard floor of tiles that face up, in two materials."""
        for i, (x0, x1) in enumerate(itertools.pairwise(xs)):
            for k, (z0, z1) in enumerate(itertools.pairwise(zs)):
                corners = [(x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0)]
                self.face(materials[(i + k) % 2], corners)

    def ball(
        self, centre: Vector, radius: float, material: str, rings: int = 12, around: int = 20
    ) -> None:
        """Adds a sphere with smooth normals."""

        def normal(i: int, j: int) -> Vector:
            a, b = math.pi * i / rings, 2 * math.pi * (j % around) / around
            s = 0.0 if i in (0, rings) else math.sin(a)
            return (s * math.cos(b), math.cos(a), s * math.sin(b))

        def add(*corners: tuple[int, int]) -> None:
            normals = [normal(i, j) for i, j in corners]
            points = [
                tuple(c + radius * n for c, n in zip(centre, m, strict=True)) for m in normals
            ]
            self.face(material, points, normals)

        for i in range(rings):
            for j in range(around):
                add((i, j), (i, j + 1), (i + 1, j + 1))
                add((i, j), (i + 1, j + 1), (i + 1, j))

    def text(self) -> str:
        head = [f"# {row}" for row in self.comment.splitlines()] + [f"mtllib {self.mtllib}"]
        pools = [row for tag in ("v", "vt", "vn") for row in self.pools[tag]]
        return "\n".join(head + pools + self.body) + "\n"


def turn_y(degrees: float, px: float = 0.0, pz: float = 0.0) -> Callable[[Vector], Vector]:
    """Function that rotates a point about the vertical through (px, pz), right-handed."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    if degrees == 0.0:
        return lambda p: p

    def place(p: Vector) -> Vector:
        x, z = p[0] - px, p[2] - pz
        return (px + c * x + s * z, p[1], pz - s * x + c * z)

    return place


def grey(value: float) -> tuple[float, float, float]:
    return (value, value, value)


def mtl(comment: str, materials: Mapping[str, Mapping[str, Any]]) -> str:
    """MTL text. `materials` maps names to fields; the default is Kd 0 0 0 and illum 1 (diffuse)."""
    rows = [f"# {row}" for row in comment.splitlines()]
    for name, fields in materials.items():
        rows += ["", f"newmtl {name}"]
        for key, value in {"Kd": (0, 0, 0), "illum": 1, **fields}.items():
            if isinstance(value, str):
                rows.append(f"{key} {value}")
            else:
                rows.append(line(key, value if isinstance(value, tuple) else (value,)))
    return "\n".join(rows).lstrip() + "\n"
