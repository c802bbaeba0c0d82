"""Runs inside Blender: imports a PLY file and prints its content as one line of JSON.

blender --background --factory-startup --python blender_import.py -- FILE.ply
"""

import json
import sys

import bpy

file = sys.argv[-1]
if hasattr(bpy.ops.wm, "ply_import") and bpy.app.version >= (3, 6):
    # These options keep the axes of the file.
    bpy.ops.wm.ply_import(filepath=file, forward_axis="Y", up_axis="Z", import_colors="SRGB")
else:
    bpy.ops.import_mesh.ply(filepath=file)
mesh = bpy.context.selected_objects[0].data
colours = mesh.color_attributes[0] if mesh.color_attributes else None
corners = [loop.vertex_index for loop in mesh.loops]
colour_of = {}
if colours is not None:
    for i, item in enumerate(colours.data):
        colour_of[corners[i] if colours.domain == "CORNER" else i] = list(item.color_srgb)[:3]
print(
    "IMPORTED "
    + json.dumps(
        {
            "version": bpy.app.version_string,
            "positions": [list(v.co) for v in mesh.vertices],
            "normals": [list(v.normal) for v in mesh.vertices],
            "faces": len(mesh.polygons),
            "colours": [colour_of.get(i) for i in range(len(mesh.vertices))],
        }
    )
)
