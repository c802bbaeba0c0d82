# SPDX-License-Identifier: GPL-3.0-or-later
"""Light, camera and world of Blender as sections of a scene.toml: numbers in, numbers out.

Blender's z is up, ours is y: (x, y, z) becomes (x, z, -y), as in glTF.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass

from .toml_text import Section, Vector

Matrix = Sequence[Vector]  # rows, world from object


def area_share(blender_version: Sequence[int]) -> float:
    """The power of an area lamp over the watts that Blender shows.

    Before 4.0, Cycles divided the watts by four times the area to find the radiance, and a
    Lambertian surface of that radiance sends out pi/4 of them. Since then it divides by pi.
    """
    return math.pi / 4 if tuple(blender_version) < (4, 0) else 1.0


def y_up(v: Vector) -> list[float]:
    return [v[0], v[2], -v[1]]


def _column(matrix: Matrix, column: int) -> list[float]:
    return [matrix[row][column] for row in range(3)]


def _length(v: Vector) -> float:
    return math.sqrt(sum(x * x for x in v))


def _unit(v: Vector) -> list[float]:
    length = _length(v) or 1.0
    return [x / length for x in v]


def _towards(matrix: Matrix) -> list[float]:
    """The direction in which lamps shine and cameras look: their own -z."""
    return y_up([-x for x in _unit(_column(matrix, 2))])


@dataclass(frozen=True)
class Lamp:
    """A lamp in the world, with the names and units of bpy.types.Light but for its power."""

    name: str
    type: str  # POINT, SPOT, SUN, AREA
    matrix: Matrix
    power: Vector  # what it sends out in W; of a sun, irradiance in W/m2
    radius: float = 0.0  # a point's
    angle: float = 0.0  # diameter of a sun, radians
    spot_size: float = 0.0  # whole cone, radians
    spot_blend: float = 0.0  # soft share of the cone, 0 to 1
    shape: str = "SQUARE"  # an area's: SQUARE, RECTANGLE, DISK, ELLIPSE
    size: float = 0.0
    size_y: float = 0.0


def _point(lamp: Lamp) -> Section:
    if lamp.radius > 0.0:
        return {"type": "sphere", "radius": lamp.radius, "power": lamp.power}
    return {"type": "point", "power": lamp.power}


def _spot(lamp: Lamp) -> Section:
    """Blender's watts are those of a point. The rim is soft in the cosine, as in scene.toml."""
    half = lamp.spot_size / 2
    edge = math.cos(half)
    inner = math.acos(min(1.0, edge + (1.0 - edge) * lamp.spot_blend))
    return {
        "type": "spot",
        "power": lamp.power,
        "direction": _towards(lamp.matrix),
        "cone_deg": math.degrees(half),
        "falloff_deg": min(math.degrees(half - inner), math.degrees(half)),
    }


def _sun(lamp: Lamp) -> Section:
    return {
        "type": "sun",
        "irradiance": lamp.power,
        "direction": _towards(lamp.matrix),
        "angular_diameter_deg": min(math.degrees(lamp.angle), 170.0),
    }


def _area(lamp: Lamp) -> Section:
    """An ellipse becomes the rectangle of its area and proportions."""
    size_y = lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else lamp.size
    width = lamp.size * _length(_column(lamp.matrix, 0))
    height = size_y * _length(_column(lamp.matrix, 1))
    section: Section = {
        "power": lamp.power,
        "direction": _towards(lamp.matrix),
    }
    round_shape = lamp.shape in ("DISK", "ELLIPSE")
    if round_shape and math.isclose(width, height, rel_tol=1e-3):
        return {"type": "disk", "radius": (width + height) / 4, **section}
    side = math.sqrt(math.pi) / 2 if round_shape else 1.0
    up = y_up(_unit(_column(lamp.matrix, 1)))
    size: Section = {"width": side * width, "height": side * height, "up": up}
    return {"type": "rectangle", **size, **section}


def light_section(lamp: Lamp) -> Section:
    shape = {"POINT": _point, "SPOT": _spot, "SUN": _sun, "AREA": _area}[lamp.type](lamp)
    section: Section = {"name": lamp.name}
    if lamp.type != "SUN":
        section["position"] = y_up(_column(lamp.matrix, 3))
    return section | shape


@dataclass(frozen=True)
class Lens:
    """A thin lens, or a pinhole where its radius is 0."""

    radius: float = 0.0
    focus_distance: float = 0.0


def pixels_of(resolution: int, percentage: int) -> int:
    """Pixels of a film's side. Blender divides whole numbers: 29 % of 1600 are 464, not 463.99."""
    return max(1, resolution * percentage // 100)


def pixel_at(share: float, pixels: int) -> int:
    """The pixel at a share of the film's side, which Blender multiplies in single precision."""
    single = struct.unpack("f", struct.pack("f", share * pixels))[0]
    return int(single)


def camera_section(matrix: Matrix, projection: Matrix, aspect: float, lens: Lens) -> Section:
    """A camera from its place and its projection matrix, for a film of this width over height."""
    section: Section = {
        "position": y_up(_column(matrix, 3)),
        "forward": _towards(matrix),
        "up": y_up(_unit(_column(matrix, 1))),
        "vertical_fov_deg": math.degrees(2 * math.atan(1 / projection[1][1])),
        "shift": [projection[0][2] * aspect / 2, projection[1][2] / 2],
    }
    if lens.radius > 0.0:
        section |= {"lens_radius": lens.radius, "focus_distance": lens.focus_distance}
    return section


def viewport_projection(lens_mm: float, width: int, height: int) -> list[list[float]]:
    """The 3D view has a sensor of 72 mm along the longer side of the film."""
    focal = 2 * lens_mm / 72 * max(width, height)
    return [[focal / width, 0.0, 0.0], [0.0, focal / height, 0.0]]
