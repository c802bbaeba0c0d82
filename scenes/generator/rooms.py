"""Makes the rooms: U-shape, Veach door, Cornell box, furnace.

Walls with rooms on both sides have a thickness. They extend by SUNK into the floor, ceiling and
walls at their ends, so no two faces share a plane there, and no light leaks through cracks.
"""

import math
from collections.abc import Sequence
from typing import Any

from .mesh import Mesh, Vector, grey, mtl
from .png import png

SUNK = 0.05  # m
LAMP = "Lamp"


def lamp_box(mesh: Mesh, low: Vector, high: Vector) -> None:
    """Adds a lamp, a box of which only the bottom emits, downwards."""
    mesh.box(low, high, "Housing", {"-y": LAMP})


def u_shape() -> dict[str, str | bytes]:
    mesh = Mesh("Two rooms joined at one end; made by scenes/generate.py", "room.mtl")
    mesh.object("Shell")
    walls = {"-y": "Floor", "+y": "Ceiling", "-x": "RedWall", "-z": "FarWall"}
    mesh.box((-4, 0, -1.5), (4, 3, 6.5), "Wall", walls, inward=True)
    mesh.object("Divider")
    mesh.box((-0.05, -SUNK, 0), (0.05, 3 + SUNK, 6.5 + SUNK), "Divider")
    # The wing hides all that the camera sees from the lamp, so the view is indirect light only.
    mesh.object("Wing")
    mesh.box((0, -SUNK, 0.02), (2.6, 3 + SUNK, 0.12), "Divider")
    mesh.object("Lamp")
    lamp_box(mesh, (2.5, 2.9, 1.2), (3.5, 3 + SUNK, 2.2))
    mesh.object("Table")
    mesh.box((-2.7, -SUNK, 2.0), (-1.1, 0.6, 3.0), "Table")
    mesh.object("GreenBox")
    mesh.box((-3.55, -SUNK, 0.6), (-2.85, 1.5, 1.3), "GreenBox", turn_deg=20)
    mesh.object("TallBox")
    mesh.box((-1.25, -SUNK, 0.2), (-0.55, 1.9, 0.9), "WhiteBox", turn_deg=-25)
    mesh.object("SmallBox")
    mesh.box((-3.5, -SUNK, 3.3), (-3.0, 0.45, 3.8), "OchreBox", turn_deg=35)
    materials = {
        "Floor": {"Kd": grey(0.7)},
        "Ceiling": {"Kd": grey(0.75)},
        "Wall": {"Kd": grey(0.75)},
        "FarWall": {"Kd": grey(0.75)},
        "Divider": {"Kd": grey(0.75)},
        "RedWall": {"Kd": (0.63, 0.065, 0.05)},
        "Table": {"Kd": grey(0.75)},
        "WhiteBox": {"Kd": grey(0.75)},
        "GreenBox": {"Kd": (0.14, 0.45, 0.091)},
        "OchreBox": {"Kd": (0.65, 0.45, 0.15)},
        "Housing": {"Kd": grey(0.7)},
        LAMP: {"Ke": grey(30)},
    }
    return {
        "u-shape/room.obj": mesh.text(),
        "u-shape/room.mtl": mtl("Diffuse throughout; Ke in W/(m2 sr)", materials),
    }


def tiles(begin: float, end: float, size: float) -> list[float]:
    """Borders of tiles from begin to end. The outer ones extend by SUNK into the walls."""
    count = round((end - begin) / size)
    inner = [begin + size * i for i in range(1, count)]
    return [begin - SUNK, *inner, end + SUNK]


def landscape(x: int, y: int) -> tuple[int, int, int]:
    """Colour of the painting in the Veach door room, a lake under a hill of 96 x 48 pixels."""
    ridge = 17 + 5 * math.sin(0.09 * x) + 3 * math.sin(0.23 * x + 1)
    shore = 30 + 3 * math.sin(0.07 * x + 2)
    if y < ridge:
        return (120 + 3 * y, 170 + 2 * y, 225)
    if y < 24 + 2 * math.sin(0.15 * x):
        return (70, 105, 60)
    if y < shore:
        return (60, 100 + (x + 2 * y) % 7 * 3, 150)
    return (95 + (3 * x + 5 * y) % 11 * 3, 130, 45)


def door_leaf(mesh: Mesh, hinge: tuple[float, float], width: float, turn_deg: float) -> None:
    """Adds leaf, knobs and stem of a door. Closed, it fills the opening right of `hinge` (x, z)."""
    hx, hz = hinge
    mesh.object("Door")
    mesh.box((hx, 0.01, hz - 0.04), (hx + width, 2.09, hz), "Door", turn_deg=turn_deg, pivot=hinge)
    mesh.object("DoorHandle")
    along, height = width - 0.08, 1.02
    stem = (
        (hx + along - 0.012, height - 0.012, hz - 0.1),
        (hx + along + 0.012, height + 0.012, hz + 0.06),
    )
    mesh.box(*stem, "Brass", turn_deg=turn_deg, pivot=hinge)
    c, s = math.cos(math.radians(turn_deg)), math.sin(math.radians(turn_deg))
    for off in (0.06, -0.1):
        centre = (hx + c * along + s * off, height, hz - s * along + c * off)
        mesh.ball(centre, 0.04, "Brass")


def veach_door() -> dict[str, str | bytes]:
    mesh = Mesh(
        "A room lit through a door that stands ajar; made by scenes/generate.py", "room.mtl"
    )
    mesh.object("Shell")
    mesh.box((-3, -SUNK, -4), (3, 3, 5), "Wall", {"+y": "Ceiling"}, inward=True)
    mesh.object("Floor")
    mesh.checker(tiles(-3, 3, 0.5), tiles(-4, 5, 0.5), 0.0, ("FloorLight", "FloorDark"))
    mesh.object("DoorWall")
    xs, ys = (-3 - SUNK, 1.1, 2.0, 3 + SUNK), (-SUNK, 2.1, 3 + SUNK)
    mesh.slab(xs, ys, -0.12, 0.0, lambda i, j: (i, j) != (1, 0), "Wall")
    mesh.object("DoorFrame")
    xs, ys = (1.0, 1.095, 2.005, 2.1), (-SUNK, 2.105, 2.2)
    mesh.slab(xs, ys, -0.02, 0.025, lambda i, j: (i, j) != (1, 0), "Frame")
    door_leaf(mesh, (1.101, 0.0), 0.89, -28)
    mesh.object("Lamp")
    lamp_box(mesh, (-1.4, 2.9, -2.8), (-0.4, 3 + SUNK, -1.8))
    mesh.object("Table")
    mesh.box((-1.9, 0.68, 0.9), (0.75, 0.74, 2.0), "Table")
    for x in (-1.8, 0.57):
        for z in (1.0, 1.82):
            mesh.box((x, -SUNK, z), (x + 0.08, 0.69, z + 0.08), "Leg")
    mesh.object("Picture")
    low, high = (-1.55, 1.35, -SUNK), (0.05, 2.2, 0.04)
    mesh.box(low, high, "Frame")
    x0, x1, y0, y1, z = low[0] + 0.08, high[0] - 0.08, low[1] + 0.08, high[1] - 0.08, 0.043
    mesh.face(
        "Painting",
        [(x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z)],
        uvs=[(0, 0), (1, 0), (1, 1), (0, 1)],
    )
    materials: dict[str, dict[str, Any]] = {
        "Wall": {"Kd": grey(0.75)},
        "Ceiling": {"Kd": grey(0.75)},
        "FloorLight": {"Kd": grey(0.7)},
        "FloorDark": {"Kd": grey(0.12)},
        "Frame": {"Kd": (0.45, 0.36, 0.2)},
        "Door": {"Kd": (0.5, 0.23, 0.09)},
        "Brass": {"Kd": (0.3, 0.25, 0.12), "Ks": (0.4, 0.35, 0.2), "Ns": 60, "illum": 2},
        "Table": {"Kd": (0.6, 0.52, 0.27)},
        "Leg": {"Kd": grey(0.7)},
        "Housing": {"Kd": grey(0.7)},
        "Painting": {"Kd": grey(1), "map_Kd": "landscape.png"},
        LAMP: {"Ke": grey(200)},
    }
    return {
        "veach-door/room.obj": mesh.text(),
        "veach-door/room.mtl": mtl("Ke in W/(m2 sr)", materials),
        "veach-door/landscape.png": png(96, 48, landscape),
    }


def block(mesh: Mesh, material: str, top: Sequence[Vector]) -> None:
    """Adds a block of the Cornell box, sunk by 2 mm. `top` runs anti-clockwise seen from above."""
    bottom = [(x, -0.002, z) for x, _, z in top]
    mesh.face(material, top)
    mesh.face(material, bottom[::-1])
    for i in range(4):
        j = (i + 1) % 4
        mesh.face(material, [top[j], top[i], bottom[i], bottom[j]])


def millimetres(*points: Vector) -> list[Vector]:
    return [tuple(c / 1000 for c in p) for p in points]


def cornell() -> dict[str, str | bytes]:
    mesh = Mesh(
        "The Cornell box from its published measurements, in metres;\nmade by scenes/generate.py",
        "cornell.mtl",
    )
    mesh.object("Walls")
    mesh.face("White", millimetres((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)))
    mesh.face(
        "White", millimetres((556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0))
    )
    mesh.face(
        "White",
        millimetres((549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)),
    )
    mesh.face("Green", millimetres((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)))
    mesh.face(
        "Red", millimetres((552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0))
    )
    mesh.object("ShortBlock")
    block(
        mesh, "White", millimetres((130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114))
    )
    mesh.object("TallBlock")
    block(
        mesh,
        "White",
        millimetres((423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)),
    )
    mesh.object("Lamp")  # lies 5 mm below the ceiling; the lamp of the real box is a hole in it
    mesh.face(
        LAMP,
        millimetres((343, 543.8, 227), (343, 543.8, 332), (213, 543.8, 332), (213, 543.8, 227)),
    )
    materials = {
        "White": {"Kd": (0.725, 0.71, 0.68)},
        "Red": {"Kd": (0.63, 0.065, 0.05)},
        "Green": {"Kd": (0.14, 0.45, 0.091)},
        LAMP: {"Kd": grey(0.78), "Ke": (17, 12, 4)},
    }
    return {
        "cornell/cornell.obj": mesh.text(),
        "cornell/cornell.mtl": mtl("Linear sRGB", materials),
    }


def furnace() -> dict[str, str | bytes]:
    mesh = Mesh(
        "Closed unit cube, seen and lit from inside; made by scenes/generate.py", "furnace.mtl"
    )
    mesh.object("Cube")
    mesh.box((0, 0, 0), (1, 1, 1), "Glow", inward=True)
    out: dict[str, str | bytes] = {"furnace/furnace.obj": mesh.text()}
    for name, albedo in (("furnace", 0.5), ("white", 0.8)):
        note = f"Radiance is the same everywhere: 1 / (1 - {albedo}) with all bounces"
        out[f"furnace/{name}.mtl"] = mtl(note, {"Glow": {"Kd": grey(albedo), "Ke": grey(1)}})
    return out


def files() -> dict[str, str | bytes]:
    return {**u_shape(), **veach_door(), **cornell(), **furnace()}
