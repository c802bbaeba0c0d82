"""Makes tiny scenes for tests with known answers, and an OBJ file with unusual content."""

from typing import Any

from .mesh import Mesh, Vector, grey, mtl
from .png import png
from .rooms import LAMP, SUNK, lamp_box

MADE = "made by scenes/generate.py"
DIFFUSE = {
    "Floor": {"Kd": grey(0.7)},
    "Ceiling": {"Kd": grey(0.7)},
    "Wall": {"Kd": grey(0.7)},
    "Divider": {"Kd": grey(0.7)},
    "Housing": {"Kd": grey(0.7)},
    LAMP: {"Ke": grey(20)},
}
ROOM = {"-y": "Floor", "+y": "Ceiling"}


def only(*names: str) -> dict[str, dict[str, Any]]:
    return {name: DIFFUSE[name] for name in names}


def two_rooms() -> dict[str, str | bytes]:
    mesh = Mesh(f"Two closed rooms, 0.02 m apart, a lamp in the right one; {MADE}", "two-rooms.mtl")
    mesh.object("DarkRoom")
    mesh.box((-2.01, 0, 0), (-0.01, 2, 2), "Wall", ROOM, inward=True)
    mesh.object("LitRoom")
    mesh.box((0.01, 0, 0), (2.01, 2, 2), "Wall", ROOM, inward=True)
    mesh.object("Lamp")
    lamp_box(mesh, (0.75, 1.9, 0.75), (1.25, 2 + SUNK, 1.25))
    names = ("Floor", "Ceiling", "Wall", "Housing", LAMP)
    return {"test/two-rooms.obj": mesh.text(), "test/two-rooms.mtl": mtl("", only(*names))}


def divider() -> dict[str, str | bytes]:
    mesh = Mesh(
        f"One room cut in two by a 0.02 m divider over one common floor; {MADE}", "divider.mtl"
    )
    mesh.object("Shell")
    mesh.box((-2, 0, 0), (2, 2, 2), "Wall", ROOM, inward=True)
    mesh.object("Divider")
    mesh.box((-0.01, -SUNK, -SUNK), (0.01, 2 + SUNK, 2 + SUNK), "Divider")
    mesh.object("Lamp")
    lamp_box(mesh, (0.75, 1.9, 0.75), (1.25, 2 + SUNK, 1.25))
    return {"test/divider.obj": mesh.text(), "test/divider.mtl": mtl("", only(*DIFFUSE))}


def square(mesh: Mesh, material: str, corner: Vector, side_a: Vector, side_b: Vector) -> None:
    """Adds a parallelogram whose front is towards side_a x side_b."""
    a = tuple(c + s for c, s in zip(corner, side_a, strict=True))
    b = tuple(c + s for c, s in zip(a, side_b, strict=True))
    c = tuple(c + s for c, s in zip(corner, side_b, strict=True))
    mesh.face(material, [corner, a, b, c])


def two_patches() -> dict[str, str | bytes]:
    mesh = Mesh(
        f"A shining square 1 m above a diffuse one, face to face; {MADE}", "two-patches.mtl"
    )
    mesh.object("Emitter")
    square(mesh, "Emitter", (-0.1, 1, -0.1), (0.2, 0, 0), (0, 0, 0.2))
    mesh.object("Receiver")
    square(mesh, "Receiver", (-0.1, 0, -0.1), (0, 0, 0.2), (0.2, 0, 0))
    materials = {"Emitter": {"Ke": grey(10)}, "Receiver": {"Kd": grey(0.5)}}
    return {"test/two-patches.obj": mesh.text(), "test/two-patches.mtl": mtl("", materials)}


def one_bounce() -> dict[str, str | bytes]:
    mesh = Mesh(
        "Floor, wall, and a lamp that lies level with the floor and faces up: it reaches the\n"
        f"wall alone, so all light on the floor has bounced there; {MADE}",
        "one-bounce.mtl",
    )
    mesh.object("Floor")
    square(mesh, "Floor", (-1, 0, -1), (0, 0, 2), (2, 0, 0))
    mesh.object("Wall")
    square(mesh, "Wall", (-1, 0, -1), (0, 2, 0), (0, 0, 2))
    mesh.object("Lamp")
    square(mesh, LAMP, (1, 0, -0.5), (0, 0, 1), (0.5, 0, 0))
    materials = {
        "Floor": {"Kd": grey(0.6)},
        "Wall": {"Kd": (0.8, 0.4, 0.2)},
        LAMP: {"Ke": grey(10)},
    }
    return {"test/one-bounce.obj": mesh.text(), "test/one-bounce.mtl": mtl("", materials)}


# Its faces are, in order: a quad with negative indices, a quad, a concave pentagon, two triangles
# without area, one with an unknown material, one with a missing texture, one hidden by d 0.
QUIRKS_OBJ = """\
# Oddities on purpose; see README.md
mtllib quirks.mtl
o Quirks
v -1 0 1
v 1 0 1
v 1 0 -1
v -1 0 -1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl Checker
f -4/-4 -3/-3 -2/-2 -1/-1
v -1 0 -1
v 1 0 -1
v 1 2 -1
v -1 2 -1
usemtl BackslashPath
f 5/1 6/2 7/3 8/4
v -0.5 0.5 -0.9
v 0.5 0.5 -0.9
v 0.5 1.5 -0.9
v 0 0.8 -0.9
v -0.5 1.5 -0.9
usemtl Plain
f 9 10 11 12 13
f 9 9 10
f 1 2 2
usemtl NotInTheLibrary
f 9/1 10/2 11/3
usemtl MissingTexture
f 1/1 3/3 2/2
usemtl Hidden
f 1 3 4
"""

QUIRKS_MTL = """\
newmtl Checker
Kd 1 1 1
illum 1
map_Kd textures/checker.png
map_Bump -bm 0.5 textures/checker.png
newmtl BackslashPath
Kd 0.9 0.9 0.9
map_Kd textures\\checker.png
newmtl Plain
Kd 0.5 0.5 0.5
Ka 0.1 0.1 0.1
Ns 10
newmtl MissingTexture
Kd 0.4 0.4 0.4
map_Kd textures/missing.png
newmtl Hidden
Kd 0.4 0.4 0.4
d 0
"""


def dos(text: str) -> bytes:
    return text.replace("\n", "\r\n").encode()


def files() -> dict[str, str | bytes]:
    squares = png(8, 8, lambda x, y: (230,) * 3 if (x + y) % 2 else (40,) * 3)
    return {
        **two_rooms(),
        **divider(),
        **two_patches(),
        **one_bounce(),
        "test/quirks.obj": dos(QUIRKS_OBJ),
        "test/quirks.mtl": dos(QUIRKS_MTL),
        "test/textures/checker.png": squares,
    }
