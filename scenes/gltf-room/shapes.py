"""Makes the room's meshes: boxes, sheets and turned shapes with normals and uv."""

import math

import bmesh
import bpy
from mathutils import Matrix, Vector


def add(name: str, mesh, parent=None, matrix=None):
    made = bpy.data.objects.new(name, mesh)
    made.parent, made.matrix_local = parent, Matrix() if matrix is None else matrix
    bpy.context.collection.objects.link(made)
    return made


def finish(bm, name: str, materials, smooth_deg):
    """Turns `bm` into a mesh that is smooth across edges of up to `smooth_deg`."""
    mesh = bpy.data.meshes.new(name)
    bm.to_mesh(mesh)
    bm.free()
    for of in materials:
        mesh.materials.append(of)
    mesh.polygons.foreach_set("use_smooth", [smooth_deg > 0] * len(mesh.polygons))
    mesh.use_auto_smooth, mesh.auto_smooth_angle = True, math.radians(smooth_deg)
    return mesh


def boxes(name: str, materials, parts, bevel=0.0, segments=2, tile=(1, 1), smooth_deg=0):
    """Makes one mesh of boxes (low corner, high corner, index of the material if not 0).

    Texture coordinates are metres over `tile`, with u along a face's longer side.
    """
    whole = bmesh.new()
    layer = whole.loops.layers.uv.new("UVMap")
    for low, high, *slot in parts:
        size = [b - a for a, b in zip(low, high, strict=True)]
        centre = (Vector(low) + Vector(high)) / 2
        bm = bmesh.new()
        bmesh.ops.create_cube(
            bm, size=1, matrix=Matrix.Translation(centre) @ Matrix.Diagonal((*size, 1))
        )
        if bevel:
            bmesh.ops.bevel(
                bm,
                geom=bm.edges[:],
                offset=bevel,
                segments=segments,
                profile=0.5,
                affect="EDGES",
                clamp_overlap=True,
            )
        for face in bm.faces:
            axis = max(range(3), key=lambda i: float(abs(face.normal[i])))
            u, v = sorted((i for i in range(3) if i != axis), key=lambda i: float(-size[i]))
            copy = whole.faces.new([whole.verts.new(vert.co) for vert in face.verts])
            copy.material_index = slot[0] if slot else 0
            for loop in copy.loops:
                loop[layer].uv = loop.vert.co[u] / tile[0], loop.vert.co[v] / tile[1]
        bm.free()
    bmesh.ops.remove_doubles(whole, verts=whole.verts, dist=1e-5)
    return finish(whole, name, materials, smooth_deg)


def sheet(name: str, of, point, columns, rows, smooth_deg=60):
    """Makes a mesh of the surface point(u, v), whose front is where v is to the left of u."""
    bm = bmesh.new()
    layer = bm.loops.layers.uv.new("UVMap")
    grid = [
        [bm.verts.new(point(i / columns, j / rows)) for i in range(columns + 1)]
        for j in range(rows + 1)
    ]
    for j in range(rows):
        for i in range(columns):
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            face = bm.faces.new([grid[b][a] for a, b in corners])
            for loop, (a, b) in zip(face.loops, corners, strict=True):
                loop[layer].uv = a / columns, b / rows
    bmesh.ops.remove_doubles(bm, verts=bm.verts, dist=1e-5)
    return finish(bm, name, [of], smooth_deg)


def lathe(name: str, of, profile, steps=32, smooth_deg=40):
    """Makes a mesh by turning the profile (radius, height) about z; upwards gives an outside."""

    def point(u: float, v: float):
        radius, z = profile[round(v * (len(profile) - 1))]
        return radius * math.cos(2 * math.pi * u), radius * math.sin(2 * math.pi * u), z

    return sheet(name, of, point, steps, len(profile) - 1, smooth_deg)


def ball(radius, rings=12):
    angles = (math.pi * (i / rings - 0.5) for i in range(rings + 1))
    return [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
