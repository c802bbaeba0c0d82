"""Makes the room's materials and the images that they use."""

import pathlib
import tempfile
import types
from typing import Any

import bpy
import numpy as np

import textures

IMAGES = tempfile.TemporaryDirectory()  # the exporter reads this folder


def image(name: str, pixels, kind="png", colour=True) -> Any:
    """Makes a texture of an array, through a file so that the exporter keeps its format."""
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[..., None], 3, -1)
    height, width, channels = pixels.shape
    drawn = bpy.data.images.new(name, width, height, alpha=channels == 4)
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :channels] = pixels
    drawn.pixels.foreach_set(rgba.ravel())
    drawn.filepath_raw = str(pathlib.Path(IMAGES.name) / f"{name}.{kind}")
    drawn.file_format = {"png": "PNG", "jpg": "JPEG"}[kind]
    drawn.save()
    made = bpy.data.images.load(drawn.filepath_raw)
    bpy.data.images.remove(drawn)
    made.name = name
    made.colorspace_settings.name = "sRGB" if colour else "Non-Color"
    return made


def material(
    name: str, colour=(1, 1, 1), base=None, normal=None, rough=None, cutout=False, **inputs
) -> Any:
    """Makes a Principled material. `colour` is linear; `base`, `normal` and `rough` are images."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, link = made.node_tree.nodes, made.node_tree.links.new
    shader = nodes["Principled BSDF"].inputs
    shader["Base Color"].default_value = (*colour, 1)
    for key, value in inputs.items():
        shader[key.replace("_", " ")].default_value = value

    def texture(of) -> Any:
        node = nodes.new("ShaderNodeTexImage")
        node.image = of
        return node.outputs

    if base:
        outputs = texture(base)
        link(outputs["Color"], shader["Base Color"])
        if cutout:
            link(outputs["Alpha"], shader["Alpha"])
            made.blend_method = "CLIP"
    if normal:
        bump = nodes.new("ShaderNodeNormalMap")
        link(texture(normal)["Color"], bump.inputs["Color"])
        link(bump.outputs["Normal"], shader["Normal"])
    if rough:
        split = nodes.new("ShaderNodeSeparateColor")
        link(texture(rough)["Color"], split.inputs["Color"])
        link(split.outputs["Green"], shader["Roughness"])
    return made


def light_material(name: str, colour, radiance, both_sides=False) -> Any:
    made = material(name, (0.8, 0.8, 0.8), Emission=(*colour, 1), Emission_Strength=radiance)
    made.use_backface_culling = not both_sides
    return made


def add_plain(mat: types.SimpleNamespace) -> None:
    """Adds materials without images."""
    mat.linen = material("linen", (0.72, 0.66, 0.55), Roughness=1.0)
    mat.plaster = material("plaster", (0.80, 0.77, 0.71), Roughness=0.95)
    mat.paint = material("paint", (0.78, 0.77, 0.73), Roughness=0.35)
    mat.clay = material("clay", (0.45, 0.36, 0.28), Roughness=1.0)
    mat.lacquer = material(
        "lacquer", (0.12, 0.035, 0.025), Roughness=0.5, Clearcoat=1.0, Clearcoat_Roughness=0.05
    )
    mat.steel = material("steel", (0.25, 0.25, 0.26), Metallic=1.0, Roughness=0.4)
    mat.brass = material("brass", (0.87, 0.66, 0.30), Metallic=1.0, Roughness=0.28)
    mat.copper = material("copper", (0.93, 0.55, 0.42), Metallic=1.0, Roughness=0.15)
    mat.glaze = material("glaze", (0.10, 0.22, 0.34), Roughness=0.15)
    mat.glass = material("glass", (0.70, 0.90, 0.82), Transmission=1.0, Roughness=0.0)
    mat.soil = material("soil", (0.05, 0.035, 0.025), Roughness=1.0)
    mat.black = material("black", (0.03, 0.03, 0.03), Roughness=0.4)
    mat.paper = material("paper", (0.80, 0.77, 0.68), Roughness=0.9)


def add_sets(mat: types.SimpleNamespace) -> None:
    """Adds the covers of the books and the balls from rough to smooth, from clay to metal."""
    mat.books = [
        material(f"cover {i}", of, Roughness=0.6)
        for i, of in enumerate(
            (
                (0.42, 0.09, 0.07),
                (0.07, 0.13, 0.26),
                (0.55, 0.38, 0.14),
                (0.10, 0.22, 0.13),
                (0.60, 0.55, 0.46),
            )
        )
    ]
    mat.balls = [
        material(
            f"ball {i}",
            (0.95, 0.64 + 0.025 * i, 0.38 + 0.025 * i),
            Metallic=i / 4,
            Roughness=0.6 - 0.125 * i,
        )
        for i in range(5)
    ]


def make_materials() -> types.SimpleNamespace:
    mat = types.SimpleNamespace()
    colour, normal, rough = textures.planks()
    mat.planks = material(
        "planks",
        base=image("planks", colour, "jpg"),
        normal=image("planks normal", normal, "jpg", False),
        rough=image("planks rough", rough, "jpg", False),
    )
    colour, normal = textures.bricks()
    mat.bricks = material(
        "bricks",
        base=image("bricks", colour, "jpg"),
        Roughness=0.9,
        normal=image("bricks normal", normal, "jpg", False),
    )
    mat.oak = material("oak", base=image("oak", textures.oak(), "jpg"), Roughness=0.45)
    weave = image("weave", textures.weave(), "png", False)
    mat.cloth = material("cloth", (0.16, 0.26, 0.27), normal=weave, Roughness=0.95)
    mat.rust = material("rust", (0.50, 0.19, 0.08), normal=weave, Roughness=0.95)
    add_plain(mat)
    add_sets(mat)
    mat.rug = material("rug", base=image("rug", textures.rug(), "jpg"), Roughness=1.0)
    mat.picture = material(
        "picture", base=image("picture", textures.landscape(), "jpg"), Roughness=0.5
    )
    mat.leaf = material("leaf", base=image("frond", textures.frond()), cutout=True, Roughness=0.5)
    mat.sky = light_material("sky", (0.78, 0.89, 1.0), 45)
    mat.bulb = light_material("bulb", (1.0, 0.75, 0.48), 700)
    mat.shade = light_material("shade", (1.0, 0.68, 0.36), 1.2, both_sides=True)
    return mat
