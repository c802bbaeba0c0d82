"""Makes the scenes for claims of many-light methods: a glossy kitchen, and a hall of many lamps."""

from typing import Any

from .mesh import Mesh, grey, mtl
from .rooms import LAMP, SUNK, tiles


def drawers(mesh: Mesh, x0: float, x1: float, y0: float, y1: float, depth: float) -> None:
    """Adds a row of lacquered fronts before the wall z = 0, each with a steel handle."""
    count = round((x1 - x0) / 0.6)
    width = (x1 - x0) / count
    mesh.box((x0, y0, -SUNK), (x1, y1, depth), "Carcass")
    for k in range(count):
        left, right = x0 + k * width + 0.004, x0 + (k + 1) * width - 0.004
        mesh.box((left, y0 + 0.004, depth - 0.002), (right, y1 - 0.004, depth + 0.018), "Lacquer")
        mesh.box(
            (left + 0.15, y1 - 0.07, depth + 0.017),
            (right - 0.15, y1 - 0.055, depth + 0.045),
            "Steel",
        )


def kitchen() -> dict[str, str | bytes]:
    mesh = Mesh("A kitchen of gloss; made by scenes/generate.py", "kitchen.mtl")
    mesh.object("Shell")
    mesh.box((-2.1, -SUNK, 0), (2.1, 2.6, 4.5), "Wall", inward=True)
    mesh.object("Floor")
    mesh.checker(tiles(-2.1, 2.1, 0.3), tiles(0, 4.5, 0.3), 0.0, ("TileLight", "TileDark"))
    mesh.object("Splashback")
    for i in range(14):
        for k in range(3):
            x, y = -2.1 + 0.2 * i, 0.93 + 0.2 * k
            mesh.box((x + 0.003, y + 0.003, -SUNK), (x + 0.197, y + 0.197, 0.012), "TileLight")
    mesh.object("BaseUnits")
    drawers(mesh, -2.05, 1.25, 0.1, 0.88, 0.58)
    mesh.box((-2.1 - SUNK, 0.88, -SUNK), (1.28, 0.92, 0.62), "Steel")
    mesh.object("WallUnits")
    drawers(mesh, -2.05, -0.55, 1.55, 2.15, 0.34)
    mesh.object("Fridge")
    mesh.box((1.32, -SUNK, -SUNK), (2.02, 1.95, 0.66), "Steel")
    mesh.box((1.38, 0.9, 0.65), (1.41, 1.7, 0.7), "Chrome")
    mesh.object("Hood")
    mesh.box((-0.3, 1.6, -SUNK), (0.6, 1.68, 0.5), "Steel", {"-y": "Housing"})
    mesh.box((0.0, 1.67, -SUNK), (0.3, 2.6 + SUNK, 0.28), "Steel")
    mesh.object("HoodLamp")
    mesh.box((-0.1, 1.585, 0.2), (0.4, 1.61, 0.32), "Housing", {"-y": LAMP})
    mesh.object("Uplight")
    mesh.box((-1.9, 2.14, 0.06), (-0.7, 2.17, 0.2), "Housing", {"+y": "UpLamp"})
    mesh.object("Table")
    mesh.box((-0.9, 0.71, 1.9), (0.6, 0.75, 2.7), "Lacquer")
    for x in (-0.85, 0.49):
        for z in (1.95, 2.59):
            mesh.box((x, -SUNK, z), (x + 0.06, 0.72, z + 0.06), "Steel")
    mesh.object("Pots")
    mesh.ball((-1.4, 1.05, 0.3), 0.13, "Steel")
    mesh.ball((-1.05, 1.0, 0.36), 0.08, "Chrome")
    mesh.ball((0.95, 1.03, 0.3), 0.11, "Copper")
    mesh.ball((-0.3, 0.86, 2.3), 0.11, "Copper")
    mesh.ball((0.1, 0.82, 2.2), 0.07, "Porcelain")
    materials: dict[str, dict[str, Any]] = {
        "Wall": {"Kd": (0.72, 0.7, 0.66), "Pr": 1, "illum": 0},
        "Carcass": {"Kd": grey(0.3), "Pr": 1, "illum": 0},
        "Housing": {"Kd": grey(0.6), "Pr": 1, "illum": 0},
        "TileLight": {"Kd": (0.7, 0.72, 0.7), "Pr": 0.25, "illum": 2},
        "TileDark": {"Kd": (0.1, 0.16, 0.2), "Pr": 0.25, "illum": 2},
        "Lacquer": {"Kd": (0.5, 0.07, 0.05), "Pr": 0.56, "Pc": 1, "Pcr": 0.2, "illum": 2},
        "Steel": {"Kd": (0.62, 0.6, 0.57), "Pr": 0.6, "Pm": 1, "illum": 2},
        "Chrome": {"Kd": grey(0.7), "Pr": 0.2, "Pm": 1, "illum": 2},
        "Copper": {"Kd": (0.8, 0.45, 0.3), "Pr": 0.56, "Pm": 1, "illum": 2},
        "Porcelain": {"Kd": grey(0.75), "Pr": 0.3, "illum": 2},
        LAMP: {"Ke": (60, 52, 40)},
        "UpLamp": {"Ke": (60, 54, 45)},
    }
    return {
        "kitchen/kitchen.obj": mesh.text(),
        "kitchen/kitchen.mtl": mtl("Roughness and metal; Ke in W/(m2 sr)", materials),
    }


# The hall has rooms of ROOM x ROOM on a grid, with walls of WALL between them.
ROOM, WALL, HEIGHT, ROWS, COLUMNS = 4.0, 0.2, 3.0, 4, 5


def lamp_hall() -> dict[str, str | bytes]:
    shell = Mesh("Twenty rooms, two of them joined; made by scenes/generate.py", "hall.mtl")
    width = COLUMNS * ROOM + (COLUMNS - 1) * WALL
    depth = ROWS * ROOM + (ROWS - 1) * WALL
    shell.object("Shell")
    sides = {"-y": "Floor", "+y": "Ceiling"}
    shell.box((0, 0, 0), (width, HEIGHT, depth), "Wall", sides, inward=True)
    shell.object("WallsAcross")
    for row in range(1, ROWS):
        z = row * (ROOM + WALL)
        shell.box((-SUNK, -SUNK, z - WALL), (width + SUNK, HEIGHT + SUNK, z), "Wall")
    shell.object("WallsAlong")
    for row in range(ROWS):
        z0, z1 = row * (ROOM + WALL) - SUNK, row * (ROOM + WALL) + ROOM + SUNK
        for column in range(1, COLUMNS):
            x = column * (ROOM + WALL)
            # The opening between the first two rooms, 2 m wide, goes up to a lintel.
            gap = (row, column) == (0, 1)
            for a, b, low in ((z0, 1.0, -SUNK), (1.0, 3.0, 2.3), (3.0, z1, -SUNK)):
                if gap:
                    shell.box((x - WALL, low, a), (x, HEIGHT + SUNK, b), "Wall")
            if not gap:
                shell.box((x - WALL, -SUNK, z0), (x, HEIGHT + SUNK, z1), "Wall")
    shell.object("Boxes")
    shell.box((2.3, -SUNK, 1.2), (3.1, 0.8, 2.0), "Red", turn_deg=25)
    shell.box((6.0, -SUNK, 2.2), (6.8, 1.3, 3.0), "Green", turn_deg=-15)
    lamps = Mesh("200 lamps of 4 cm below a ceiling; made by scenes/generate.py", "hall.mtl")
    lamps.object("Lamps")
    for i in range(20):
        for k in range(10):
            x, z = 0.2 * (i + 0.5), 0.4 * (k + 0.5)
            y, r = HEIGHT - 0.05, 0.02
            corners = [(x - r, y, z - r), (x + r, y, z - r), (x + r, y, z + r), (x - r, y, z + r)]
            lamps.face(LAMP, corners)
    materials: dict[str, dict[str, Any]] = {
        "Wall": {"Kd": grey(0.6)},
        "Floor": {"Kd": (0.4, 0.3, 0.2)},
        "Ceiling": {"Kd": grey(0.7)},
        "Red": {"Kd": (0.6, 0.1, 0.07)},
        "Green": {"Kd": (0.15, 0.45, 0.12)},
        LAMP: {"Ke": grey(60)},
    }
    return {
        "lamp-hall/shell.obj": shell.text(),
        "lamp-hall/lamps.obj": lamps.text(),
        "lamp-hall/hall.mtl": mtl("Ke in W/(m2 sr)", materials),
    }


def files() -> dict[str, str | bytes]:
    return {**kitchen(), **lamp_hall()}
