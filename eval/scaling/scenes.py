"""Makes scenes of any number of triangles, by subdividing the triangles of those in scenes/.

Geometry and light stay the same. Only the cost of rays and of loading changes.
"""

import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

Vec3 = tuple[float, float, float]
Corner = tuple[int, int | None]


def faces_of(obj: Path) -> tuple[list[Vec3], list[Vec3], list[tuple[str, list[Corner]]]]:
    """Vertices, normals and faces (material, corners) of an OBJ file without textures.

    Each corner holds the indices of its vertex and of its normal, which may be None.
    """
    vertices: list[Vec3] = []
    normals: list[Vec3] = []
    faces: list[tuple[str, list[Corner]]] = []
    material = ""
    for line in obj.read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append((float(words[1]), float(words[2]), float(words[3])))
        elif words[0] == "vn":
            normals.append((float(words[1]), float(words[2]), float(words[3])))
        elif words[0] == "usemtl":
            material = words[1]
        elif words[0] == "f":
            corners = [word.split("/") for word in words[1:]]
            faces.append(
                (
                    material,
                    [(int(c[0]) - 1, int(c[2]) - 1 if len(c) == 3 else None) for c in corners],
                )
            )
    return vertices, normals, faces


def mixed(corners: Sequence[Vec3], a: float, b: float, c: float) -> Vec3:
    x, y, z = (a * x + b * y + c * z for x, y, z in zip(*corners, strict=True))
    return x, y, z


def area(vertices: Sequence[Vec3], corners: Iterable[Corner]) -> float:
    a, b, c = (vertices[v] for v, _ in corners)
    u, w = [y - x for x, y in zip(a, b, strict=True)], [y - x for x, y in zip(a, c, strict=True)]
    return 0.5 * math.hypot(
        u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]
    )


def write_cut(obj: Path, target: Path, triangles: float) -> int:
    """Writes about `triangles` triangles of equal area; lamps stay whole. Returns their number."""
    vertices, normals, faces = faces_of(obj)
    whole = [
        (material, [face[0], face[i], face[i + 1]])
        for material, face in faces
        for i in range(1, len(face) - 1)
    ]

    per_area = triangles / sum(area(vertices, corners) for _, corners in whole)
    made, first_v, first_n = 0, 1, 1
    with open(target, "w") as out:
        out.write(f"mtllib {obj.stem}.mtl\n")
        for material, corners in whole:
            n = (
                1
                if material == "Lamp"
                else max(1, round(math.sqrt(area(vertices, corners) * per_area)))
            )
            grid = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]
            row = [sum(n + 1 - k for k in range(i)) for i in range(n + 2)]
            places = [vertices[v] for v, _ in corners]
            smooth = corners[0][1] is not None
            out.write(f"usemtl {material}\n")
            for i, j in grid:
                x, y, z = mixed(places, 1 - (i + j) / n, j / n, i / n)
                out.write(f"v {x:.7g} {y:.7g} {z:.7g}\n")
            if smooth:
                turned = [normals[k] for _, k in corners if k is not None]
                for i, j in grid:
                    x, y, z = mixed(turned, 1 - (i + j) / n, j / n, i / n)
                    out.write(f"vn {x:.5g} {y:.5g} {z:.5g}\n")
            for i, j in grid:
                lower, upper = row[i] + j, row[i + 1] + j
                cut = ([(lower, lower + 1, upper)] if i + j < n else []) + (
                    [(lower + 1, upper + 1, upper)] if i + j < n - 1 else []
                )
                for face in cut:
                    out.write(
                        "f "
                        + " ".join(
                            f"{v + first_v}//{v + first_n}" if smooth else f"{v + first_v}"
                            for v in face
                        )
                        + "\n"
                    )
                    made += 1
            first_v += len(grid)
            first_n += len(grid) if smooth else 0
    return made


def cut_scene(scene: Path, folder: Path, triangles: int) -> tuple[Path, int]:
    """Copies a scene with about `triangles` triangles. Returns its file and their number."""
    folder.mkdir(parents=True, exist_ok=True)
    text, made = scene.read_text(), 0
    names = re.findall(r'^file = "(.*\.obj)"', text, re.M)
    for name in names:
        obj = scene.parent / name
        made += write_cut(obj, folder / obj.name, triangles / len(names))
        (folder / f"{obj.stem}.mtl").write_text(obj.with_suffix(".mtl").read_text())
        text = text.replace(f'"{name}"', f'"{Path(name).name}"')
    (folder / "scene.toml").write_text(text)
    return folder / "scene.toml", made
