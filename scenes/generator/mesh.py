"""Polygon soup with shared vertices, written as OBJ and MTL.

Lengths are metres, y is up. A face is seen from the side where its corners run anti-clockwise;
that side is also the one an emissive face lights.
"""

import math


def number(value):
    """Six significant digits, no exponent for what rounds to zero, never '-0'."""
    if abs(value) < 1e-9:
        return "0"
    return f"{value:.6g}"


def line(tag, values):
    return " ".join([tag, *map(number, values)])


class Mesh:
    """Positions, texture coordinates and normals are shared when they print alike."""

    def __init__(self, comment, mtllib):
        self.comment = comment
        self.mtllib = mtllib
        self.pools = {"v": {}, "vt": {}, "vn": {}}
        self.body = []
        self.material = None

    def _index(self, tag, values):
        pool = self.pools[tag]
        return pool.setdefault(line(tag, values), len(pool) + 1)

    def object(self, name):
        self.body.append(f"o {name}")
        self.material = None

    def face(self, material, corners, normals=None, uvs=None):
        """Adds one polygon; a triangle that collapses to an edge is left out."""
        v = [self._index("v", c) for c in corners]
        if len(v) == 3 and len(set(v)) < 3:
            return
        vt = [self._index("vt", t) for t in uvs] if uvs else [""] * len(v)
        vn = [self._index("vn", n) for n in normals] if normals else None
        if material != self.material:
            self.body.append(f"usemtl {material}")
            self.material = material
        if vn:
            words = [f"{a}/{b}/{c}" for a, b, c in zip(v, vt, vn)]
        elif uvs:
            words = [f"{a}/{b}" for a, b in zip(v, vt)]
        else:
            words = [str(a) for a in v]
        self.body.append("f " + " ".join(words))

    def box(self, low, high, material, faces=None, inward=False, turn_deg=0.0, pivot=None):
        """Closed box. `faces` names other materials by side ('-y': 'Lamp').

        `inward` makes a room; `turn_deg` turns it about the vertical through `pivot` (x, z),
        its own middle unless given.
        """
        x, y, z = zip(low, high)
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

    def slab(self, xs, ys, z0, z1, is_solid, material):
        """Closed upright slab between z0 < z1 on the grid xs * ys, with holes where not is_solid.

        All cells share their vertices, so that the slab has no cracks round its holes.
        """
        columns, rows = len(xs) - 1, len(ys) - 1

        def solid(i, j):
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

    def checker(self, xs, zs, y, materials):
        """Floor of tiles that face up, in two materials by turns."""
        for i, (x0, x1) in enumerate(zip(xs, xs[1:])):
            for k, (z0, z1) in enumerate(zip(zs, zs[1:])):
                corners = [(x0, y, z0), (x0, y, z1), (x1, y, z1), (x1, y, z0)]
                self.face(materials[(i + k) % 2], corners)

    def ball(self, centre, radius, material, rings=12, around=20):
        """Sphere with smooth normals."""

        def normal(i, j):
            a, b = math.pi * i / rings, 2 * math.pi * (j % around) / around
            s = 0.0 if i in (0, rings) else math.sin(a)
            return (s * math.cos(b), math.cos(a), s * math.sin(b))

        def add(*corners):
            normals = [normal(i, j) for i, j in corners]
            points = [tuple(c + radius * n for c, n in zip(centre, m)) for m in normals]
            self.face(material, points, normals)

        for i in range(rings):
            for j in range(around):
                add((i, j), (i, j + 1), (i + 1, j + 1))
                add((i, j), (i + 1, j + 1), (i + 1, j))

    def text(self):
        head = [f"# {row}" for row in self.comment.splitlines()] + [f"mtllib {self.mtllib}"]
        pools = [row for tag in ("v", "vt", "vn") for row in self.pools[tag]]
        return "\n".join(head + pools + self.body) + "\n"


def turn_y(degrees, px=0.0, pz=0.0):
    """Function that turns a point about the vertical line through (px, pz), right-handed."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    if degrees == 0.0:
        return lambda p: p

    def place(p):
        x, z = p[0] - px, p[2] - pz
        return (px + c * x + s * z, p[1], pz - s * x + c * z)

    return place


def grey(value):
    return (value, value, value)


def mtl(comment, materials):
    """MTL text; `materials` maps a name to its fields. Kd and illum 1 (plain diffuse) are implied."""
    rows = [f"# {row}" for row in comment.splitlines()]
    for name, fields in materials.items():
        rows += ["", f"newmtl {name}"]
        for key, value in {"Kd": (0, 0, 0), "illum": 1, **fields}.items():
            if isinstance(value, str):
                rows.append(f"{key} {value}")
            else:
                rows.append(line(key, value if isinstance(value, tuple) else (value,)))
    return "\n".join(rows).lstrip() + "\n"
