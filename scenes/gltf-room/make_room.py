"""Writes room.glb, a small living room in late daylight, with Blender's own glTF exporter.

    blender --background --python scenes/gltf-room/make_room.py      # made with Blender 3.4.1

Lengths are in metres, and z points up as in Blender; the exporter makes y point up. The room spans
x -2.5..2.5, y -2..2, z 0..2.8. Its window in the wall at x = 2.5 opens on a courtyard with a sky
panel and a low sun. textures.py has the textures, materials.py the materials, shapes.py the shapes.
"""

import math
import pathlib
import random
import sys

import bpy
from mathutils import Matrix, Vector

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from materials import make_materials  # noqa: E402
from shapes import add, ball, boxes, lathe, sheet  # noqa: E402


def at(x: float, y: float, z=0.0, turn_deg=0.0):
    return Matrix.Translation((x, y, z)) @ Matrix.Rotation(math.radians(turn_deg), 4, "Z")


# fmt: off
def make_shell(mat):
    """Makes floor, ceiling and walls. The window's opening is y 0.35..1.45, z 0.8..2.2."""
    add("floor", boxes("floor", [mat.planks], [((-2.7, -2.2, -0.2), (2.85, 2.2, 0))],
        tile=(2.56, 1.28)))
    add("brick wall", boxes("brick wall", [mat.bricks], [((-2.7, 2, 0), (2.85, 2.2, 2.8))],
        tile=(1, 0.64)))
    add("walls", boxes("walls", [mat.plaster], [
        ((-2.7, -2.2, 2.8), (2.9, 2.2, 3)), ((-2.7, -2, 0), (-2.5, 2, 2.8)),
        ((-2.7, -2.2, 0), (2.85, -2, 2.8)), ((2.5, -2, 0), (2.9, 0.35, 2.8)),
        ((2.5, 1.45, 0), (2.9, 2, 2.8)), ((2.5, 0.35, 0), (2.9, 1.45, 0.8)),
        ((2.5, 0.35, 2.2), (2.9, 1.45, 2.8))]))
    add("beams", boxes("beams", [mat.oak], [((x, -2, 2.64), (x + 0.14, 2, 2.8))
                                            for x in (-1.75, -0.07, 1.61)], bevel=0.01))
    add("skirting", boxes("skirting", [mat.paint], [
        ((-2.5, 1.985, 0), (2.5, 2, 0.09)), ((-2.5, -2, 0), (-2.485, 1.985, 0.09)),
        ((2.485, -2, 0), (2.5, 1.985, 0.09))]))


def make_window(mat):
    bars = [((2.76, y, 0.8), (2.81, y + w, 2.2))
            for y, w in ((0.35, 0.06), (0.885, 0.03), (1.39, 0.06))]
    bars += [((2.765, 0.36, z), (2.805, 1.44, z + w))
             for z, w in ((0.8, 0.06), (1.70, 0.03), (2.14, 0.06))]
    add("window frame", boxes("window frame", [mat.paint], bars))
    add("window sill", boxes("window sill", [mat.oak], [((2.44, 0.30, 0.79), (2.76, 1.50, 0.825))],
        bevel=0.006))
    add("courtyard", boxes("courtyard", [mat.bricks], [
        ((6.2, -3, -0.2), (6.4, 5, 3.6)), ((2.9, 4, -0.2), (6.2, 4.2, 3.6))], tile=(1, 0.64)))
    add("courtyard floor", boxes("courtyard floor", [mat.clay],
        [((2.9, -3, -0.4), (6.4, 5, -0.2))]))

    def folds(u, v):
        wave = 0.1 * math.sin(5 * v)
        return 0.035 * math.sin(2 * math.pi * (4 * u + wave)), 0.42 * (u - 0.5), 2.36 * v
    curtain = sheet("curtain", mat.linen, folds, 48, 6)
    for y in (0.19, 1.61):
        add("curtain", curtain, matrix=at(2.42, y, 0.03))
    rod = lathe("curtain rod", mat.brass, [(0, -0.98), (0.012, -0.98), (0.012, 0.98), (0, 0.98)],
        12)
    add("curtain rod", rod, matrix=at(2.42, 0.9, 2.4) @ Matrix.Rotation(math.pi / 2, 4, "X"))


def make_sofa(mat, name, width, seats, matrix):
    """Makes a sofa of `seats` cushions that faces -y."""
    group, half = add(name, None, matrix=matrix), width / 2
    add("frame", boxes(name + " frame", [mat.cloth], [
        ((-half, -0.42, 0.14), (half, 0.42, 0.30)), ((-half, 0.22, 0.16), (half, 0.42, 0.78)),
        ((-half, -0.42, 0.16), (-half + 0.16, 0.42, 0.58)),
        ((half - 0.16, -0.42, 0.16), (half, 0.42, 0.58))], 0.05, 4, (0.4, 0.4), 180), group)
    seat = (width - 0.34) / seats
    cushion = boxes(name + " cushion", [mat.cloth],
        [((-seat / 2, -0.34, 0), (seat / 2, 0.34, 0.17))],
                    0.06, 4, (0.4, 0.4), 180)
    for i in range(seats):
        x = (i - (seats - 1) / 2) * (seat + 0.005)
        add("seat", cushion, group, at(x, -0.11, 0.295))
        lean = Matrix.Rotation(math.radians(78), 4, "X")
        add("back", cushion, group, at(x, 0.17, 0.72) @ lean @ Matrix.Diagonal((0.98, 0.62, 0.95,
            1)))
    leg = lathe("leg", mat.oak, [(0, 0), (0.018, 0), (0.028, 0.16), (0, 0.16)], 12)
    for x in (-half + 0.1, half - 0.1):
        for y in (-0.33, 0.33):
            add("leg", leg, group, at(x, y))
    return group


def make_throw_cushions(mat, sofa):
    pad = boxes("throw cushion", [mat.rust], [((-0.21, -0.07, -0.21), (0.21, 0.07, 0.21))],
        0.065, 4,
                (0.4, 0.4), 180)
    for x, turn in ((-0.58, 14), (0.52, -20)):
        lean = Matrix.Rotation(math.radians(-22), 4, "X")
        add("throw cushion", pad, sofa, at(x, -0.10, 0.665, turn) @ lean)


def make_table(mat):
    group = add("coffee table", None, matrix=at(-0.15, 0.30))
    add("top", boxes("table top", [mat.lacquer], [((-0.6, -0.31, 0.39), (0.6, 0.31, 0.425))],
        0.012, 3,
                     smooth_deg=50), group)
    add("legs", boxes("table legs", [mat.steel], [
        ((x - 0.015, y - 0.015, 0), (x + 0.015, y + 0.015, 0.39))
        for x in (-0.54, 0.54) for y in (-0.25, 0.25)]), group)
    for i, of in enumerate(mat.balls):
        add("ball", lathe(of.name, of, ball(0.062), 24, 180),
            group, at(-0.46 + 0.15 * i, -0.12, 0.487))
    shape = [(0, 0.004), (0.05, 0), (0.075, 0.03), (0.085, 0.09), (0.07, 0.16), (0.04, 0.22),
        (0.035, 0.26),
             (0.05, 0.30)]
    add("glass vase", lathe("glass vase", mat.glass, shape, 40, 180), group, at(0.42, 0.04, 0.426))
    add("magazines", boxes("magazines", [mat.books[2], mat.paper], [
        ((-0.12, -0.15, 0), (0.10, 0.14, 0.008), 1), ((-0.10, -0.14, 0.008), (0.11, 0.14, 0.02),
            0)]),
        group, at(0.08, 0.14, 0.4255, 12))


def make_shelf(mat, chance):
    group = add("bookshelf", None, matrix=at(-2.0, 1.82))
    boards = [((-0.45, -0.15, z), (0.45, 0.15, z + 0.025)) for z in (0.10, 0.46, 0.82, 1.18, 1.54,
        1.90)]
    sides = [((x, -0.15, 0), (x + 0.025, 0.15, 1.925)) for x in (-0.475, 0.45)]
    back = [((-0.45, 0.13, 0.1), (0.45, 0.15, 1.9))]
    add("case", boxes("bookcase", [mat.oak], boards + sides + back, tile=(0.8, 0.8)), group)
    books = [boxes("book", [of, mat.paper], [
        ((0, -0.085, 0), (0.003, 0.085, 0.24)), ((0.027, -0.085, 0), (0.03, 0.085, 0.24)),
        ((0.003, -0.085, 0), (0.027, -0.082, 0.24)), ((0.003, -0.082, 0.004), (0.027, 0.08, 0.236),
            1)])
        for of in mat.books]
    for z in (0.125, 0.485, 0.845, 1.205, 1.565):
        x, end = -0.44, chance.uniform(0.0, 0.4)
        while x < end:
            thick, tall = chance.uniform(0.6, 1.6), chance.uniform(0.8, 1.15)
            add("book", chance.choice(books), group, at(x, -0.03 + chance.uniform(-0.02, 0.01), z)
                @ Matrix.Diagonal((thick, 0.95, tall, 1)))
            x += 0.03 * thick + 0.001


def make_sideboard(mat):
    group = add("sideboard", None, matrix=at(2.27, 0.90))
    add("body", boxes("sideboard body", [mat.oak, mat.paint], [
        ((-0.20, -0.50, 0.10), (0.20, 0.50, 0.64)), ((-0.215, -0.485, 0.115), (-0.2, -0.005, 0.61),
            1),
        ((-0.215, 0.005, 0.115), (-0.2, 0.485, 0.61), 1)], 0.004, 1, (0.8, 0.8)), group)
    add("feet", boxes("sideboard feet", [mat.steel], [
        ((x, y, 0), (x + 0.03, y + 0.03, 0.1)) for x in (-0.17, 0.14) for y in (-0.45, 0.42)]),
            group)
    shape = [(0, 0), (0.045, 0), (0.07, 0.05), (0.075, 0.11), (0.05, 0.18), (0.022, 0.24),
        (0.022, 0.29),
             (0.032, 0.31), (0.026, 0.31), (0.016, 0.29), (0.016, 0.20), (0, 0.20)]
    for y, scale, of in ((-0.36, 0.8, mat.brass), (-0.19, 1.0, mat.glaze), (0.36, 0.7, mat.copper)):
        add("vase", lathe("vase", of, shape, 32, 60), group,
            at(-0.02, y, 0.64) @ Matrix.Scale(scale, 4))


def make_lamp(mat):
    group = add("floor lamp", None, matrix=at(-1.30, 1.70))
    add("stand", lathe("lamp stand", mat.brass, [
        (0, 0), (0.14, 0), (0.14, 0.015), (0.012, 0.025), (0.012, 1.42), (0, 1.42)]), group)
    add("socket", lathe("lamp socket", mat.black, [
        (0, 1.42), (0.022, 1.42), (0.022, 1.53), (0, 1.53)], 16), group)
    add("shade", lathe("lamp shade", mat.shade, [(0.21, 1.42), (0.15, 1.74)], 40), group)
    add("bulb", lathe("bulb", mat.bulb, ball(0.035, 8), 12, 180), group, at(0, 0, 1.56))


def make_palm(mat, chance):
    group = add("palm", None, matrix=at(2.02, 1.66))
    add("pot", lathe("pot", mat.glaze, [(0, 0), (0.12, 0), (0.17, 0.30), (0.155, 0.30),
        (0.145, 0.26)]), group)
    add("soil", lathe("soil", mat.soil, [(0.147, 0.26), (0, 0.27)]), group)

    def droop(u, v):
        along, down = math.sin(1.3 * v), 1 - math.cos(1.3 * v)
        return 0.36 * (u - 0.5), 0.73 * along, -0.73 * down - 0.12 * abs(u - 0.5)
    leaf = sheet("leaf", mat.leaf, droop, 2, 8, 180)
    for i in range(16):
        rise = math.radians(88 - 3.2 * i + chance.uniform(-4, 4))
        add("leaf", leaf, group, Matrix.Translation((0, 0, 0.26)) @ Matrix.Rotation(2.4 * i, 4, "Z")
            @ Matrix.Rotation(rise, 4, "X") @ Matrix.Scale(chance.uniform(0.8, 1.15), 4))


def make_pictures(mat):
    frame = boxes("picture frame", [mat.black, mat.paper], [
        ((-0.38, -0.03, -0.30), (0.38, 0, -0.28)), ((-0.38, -0.03, 0.28), (0.38, 0, 0.30)),
        ((-0.38, -0.03, -0.28), (-0.36, 0, 0.28)), ((0.36, -0.03, -0.28), (0.38, 0, 0.28)),
        ((-0.36, -0.015, -0.28), (0.36, 0, 0.28), 1)])
    scene = sheet("print", mat.picture, lambda u, v: (0.6 * u - 0.3, -0.017, 0.45 * v - 0.225),
        1, 1)
    for x, scale in ((-0.62, 1.0), (0.30, 0.8)):
        group = add("picture", None, matrix=at(x, 2, 1.62) @ Matrix.Scale(scale, 4))
        add("frame", frame, group)
        add("print", scene, group)


def make_rug(mat):
    add("rug", sheet("rug", mat.rug, lambda u, v: (2.5 * u - 1.4, 1.7 * v - 0.75, 0.008), 1, 1))
    add("rug edge", boxes("rug edge", [mat.linen], [((-1.4, -0.75, 0), (1.1, 0.95, 0.007))]))


def make_lights(mat):
    panel = sheet("sky", mat.sky, lambda u, v: (u - 0.5, 1.2 * (0.5 - v), 0), 1, 1)
    add("sky", panel, matrix=aimed((3.6, 0.1, 1.9), (2.6, 0.95, 1.5)))
    sun = bpy.data.lights.new("sun", "SPOT")
    sun.energy, sun.color = 20000, (1.0, 0.84, 0.64)
    sun.spot_size, sun.spot_blend = math.radians(26), 0.1
    add("sun", sun, matrix=aimed((5.8, 1.7, 3.3), (2.7, 0.9, 1.5)))
# fmt: on


def aimed(position, target):
    """Matrix of a camera or lamp at `position`, which looks along its -z at `target`."""
    toward = Vector(target) - Vector(position)
    return Matrix.Translation(position) @ toward.to_track_quat("-Z", "Y").to_matrix().to_4x4()


def make_camera(name: str, position, target, angle_deg) -> None:
    camera = bpy.data.cameras.new(name)
    camera.angle = math.radians(angle_deg)
    add(name, camera, matrix=aimed(position, target))


def main() -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    mat, chance = make_materials(), random.Random(11)
    make_shell(mat)
    make_window(mat)
    make_throw_cushions(mat, make_sofa(mat, "sofa", 1.95, 2, at(-0.05, 1.50)))
    make_sofa(mat, "armchair", 0.95, 1, at(-1.75, -0.15, 0, 72))
    make_table(mat)
    make_shelf(mat, chance)
    make_sideboard(mat)
    make_lamp(mat)
    make_palm(mat, chance)
    make_pictures(mat)
    make_rug(mat)
    make_lights(mat)
    make_camera("Room", (0.35, -1.90, 1.50), (0.02, 1.5, 0.97), 82)
    make_camera("Window", (-2.2, -1.7, 1.55), (2.2, 0.75, 0.95), 62)
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 1280, 720
    bpy.ops.export_scene.gltf(
        filepath=str(HERE / "room.glb"),
        export_format="GLB",
        export_cameras=True,
        export_lights=True,
        export_tangents=True,
    )


main()
