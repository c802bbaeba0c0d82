"""Scenes of any number of triangles: those of scenes/ with each triangle cut into smaller ones.

The geometry, and so the light, stays; what changes is what rays and loading cost.
"""

import math
import re
from pathlib import Path


def faces_of(obj):
    """(vertices, normals, [(material, [(vertex, normal or None), ...])]) of an OBJ without textures."""
    vertices, normals, faces, material = [], [], [], ""
    for line in obj.read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append(tuple(map(float, words[1:4])))
        elif words[0] == "vn":
            normals.append(tuple(map(float, words[1:4])))
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


def mixed(corners, a, b, c):
    return tuple(a * x + b * y + c * z for x, y, z in zip(*corners))


def area(vertices, corners):
    a, b, c = (vertices[v] for v, _ in corners)
    u, w = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
    return 0.5 * math.hypot(
        u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]
    )


def write_cut(obj, target, triangles):
    """About so many triangles, shared out by area; lamps stay whole. Returns their number."""
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
                out.write("v %.7g %.7g %.7g\n" % mixed(places, 1 - (i + j) / n, j / n, i / n))
            if smooth:
                turned = [normals[k] for _, k in corners]
                for i, j in grid:
                    out.write("vn %.5g %.5g %.5g\n" % mixed(turned, 1 - (i + j) / n, j / n, i / n))
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


def cut_scene(scene, folder, triangles):
    """A copy of a scene of so many triangles. Returns (its file, their number)."""
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
