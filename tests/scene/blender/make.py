"""Writes my room.obj and .mtl with Blender's exporter: names with blanks, umlauts and dots.

blender --background --python tests/scene/blender/make.py      # made with Blender 3.4.1
"""

import pathlib

import bpy

HERE = pathlib.Path(__file__).resolve().parent
bpy.ops.wm.read_factory_settings(use_empty=True)


def material(name: str, colour, emission=0.0):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Specular"].default_value = 0
    if emission:
        shader.inputs["Emission"].default_value = (1, 1, 1, 1)
        shader.inputs["Emission Strength"].default_value = emission
    return made


def square(name: str, location, rotation, materials, size=2):
    bpy.ops.mesh.primitive_plane_add(size=size, location=location, rotation=rotation)
    made = bpy.context.object
    made.name = name
    for one in materials:
        made.data.materials.append(one)
    return made


tiles = material("Fußboden Kachel", (1, 1, 1))
picture = bpy.data.images.new("blue", 2, 2)
picture.pixels = [0.0, 0.0, 1.0, 1.0] * 4
picture.filepath_raw = str(HERE / "meine texturen" / "kachel blau.001.png")
picture.file_format = "PNG"
picture.save()
node = tiles.node_tree.nodes.new("ShaderNodeTexImage")
node.image = picture
tiles.node_tree.links.new(
    node.outputs["Color"], tiles.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
)

square("Boden", (0, 0, 0), (0, 0, 0), [tiles])
square("Wände & Türen.001", (-1, 0, 1), (0, 1.5707963, 0), [material("my left", (0.8, 0.1, 0.1))])
square(
    "Wände & Türen.002", (1, 0, 1), (0, -1.5707963, 0), [material("my.right 2", (0.1, 0.8, 0.1))]
)
square(
    "Lampe 40 W", (0, 0, 1.9), (3.1415927, 0, 0), [material("Lampe  weiß.001", (0, 0, 0), 10)], 0.5
)
bpy.ops.wm.obj_export(filepath=str(HERE / "my room.obj"), path_mode="RELATIVE")
