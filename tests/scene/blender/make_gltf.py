"""Writes gltf room.glb with Blender's exporter.

It has two cameras, a lamp of 40 W, a panel, a mirror of rough metal, instances of a mesh, a
texture, alpha and glass.

    blender --background --python tests/scene/blender/make_gltf.py      # made with Blender 3.4.1
"""

import math
import pathlib

import bpy

HERE = pathlib.Path(__file__).resolve().parent
bpy.ops.wm.read_factory_settings(use_empty=True)


def material(name: str, colour, **inputs):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    return made


def square(name: str, location, rotation, of, size=2):
    bpy.ops.mesh.primitive_plane_add(size=size, location=location, rotation=rotation)
    made = bpy.context.object
    made.name = name
    made.data.materials.append(of)
    return made


def look(name: str, location, rotation, angle):
    data = bpy.data.cameras.new(name)
    data.angle = angle
    made = bpy.data.objects.new(name, data)
    made.location, made.rotation_euler = location, rotation
    bpy.context.collection.objects.link(made)
    return made


tiles = material("Fußboden Kachel", (1, 1, 1), Roughness=0.8)
picture = bpy.data.images.new("blue", 2, 2)
picture.pixels = [0.0, 0.0, 1.0, 1.0] * 4
picture.pack()
node = tiles.node_tree.nodes.new("ShaderNodeTexImage")
node.image = picture
tiles.node_tree.links.new(
    node.outputs["Color"], tiles.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
)

square("Boden", (0, 0, 0), (0, 0, 0), tiles)
square("Wand links", (-1, 0, 1), (0, math.pi / 2, 0), material("red", (0.8, 0.1, 0.1)))
square(
    "Wand rechts",
    (1, 0, 1),
    (0, -math.pi / 2, 0),
    material("metal", (0.9, 0.7, 0.4), Metallic=1.0, Roughness=0.3),
)
panel = material("panel", (0, 0, 0), Emission=(1, 1, 1, 1), Emission_Strength=10.0)
panel.use_backface_culling = True
square("Lampe", (0, 0, 1.9), (math.pi, 0, 0), panel, 0.5)
square(
    "Glas",
    (0, -0.9, 1),
    (math.pi / 2, 0, 0),
    material("glass", (1, 1, 1), Transmission=1.0, Roughness=0.0),
    0.4,
)

bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=1, radius=0.1, location=(-0.5, 0, 0.1))
ball = bpy.context.object
ball.data.materials.append(material("paint", (0.2, 0.7, 0.3)))
for i in range(3):
    copy = ball.copy()  # shares the mesh
    copy.location.x += 0.3 * (i + 1)
    bpy.context.collection.objects.link(copy)

lamp = bpy.data.objects.new("Birne", bpy.data.lights.new("Birne", "POINT"))
lamp.data.energy = 40.0
lamp.location = (0, 0.5, 1.5)
bpy.context.collection.objects.link(lamp)
look("Tür", (0, -4, 1), (math.pi / 2, 0, 0), math.radians(50))
look("Fenster", (0, 4, 1), (math.pi / 2, 0, math.pi), math.radians(40))
bpy.ops.export_scene.gltf(
    filepath=str(HERE / "gltf room.glb"),
    export_format="GLB",
    export_cameras=True,
    export_lights=True,
)
