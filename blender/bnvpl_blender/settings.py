# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a scene, preferences of the add-on, and the folder where a render's files go."""

from __future__ import annotations

import tempfile
from pathlib import Path

import bpy

from .tools import PRESETS, Request

TEMPORARY_PREFIX = "bnvpl."


class BNVPL_Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    tools_folder: bpy.props.StringProperty(
        name="Folder of the Tools",
        description="Folder that holds vpl-place and the other tools; empty: those on the PATH",
        subtype="DIR_PATH",
    )

    def draw(self, context):
        self.layout.prop(self, "tools_folder")


class BNVPL_Settings(bpy.types.PropertyGroup):
    preset: bpy.props.EnumProperty(
        name="Preset",
        description="Counts and options of all stages",
        items=[(key, key.capitalize(), "") for key in PRESETS],
        default="DEFAULT",
    )
    vpls: bpy.props.IntProperty(
        name="VPLs",
        description="Virtual point lights; 0: the preset's",
        min=0,
        max=10_000_000,
    )
    samples: bpy.props.IntProperty(
        name="Samples", description="Samples of a pixel; 0: the preset's", min=0, max=1 << 20
    )
    seed: bpy.props.IntProperty(name="Seed", description="Seed of all stages", default=1, min=0)
    view: bpy.props.EnumProperty(
        name="View",
        items=[
            ("CAMERA", "Camera", "The active camera of the scene"),
            ("VIEWPORT", "Viewport", "What the first 3D viewport shows"),
        ],
    )
    light_passes: bpy.props.BoolProperty(
        name="Direct and Indirect", description="Direct and indirect light as passes"
    )
    for_denoiser: bpy.props.BoolProperty(
        name="For Denoiser",
        description="Noise that is independent between pixels, with albedo and normal as passes, "
        "for the Denoise node",
    )
    keep_files: bpy.props.BoolProperty(
        name="Keep Files",
        description="Keep scene, VPLs, image and a script that renders them again",
    )
    folder: bpy.props.StringProperty(
        name="Folder", description="Where files are kept", subtype="DIR_PATH", default="//bnvpl"
    )


def tools_folder() -> str:
    addon = bpy.context.preferences.addons.get(__package__)
    folder = addon.preferences.tools_folder if addon and addon.preferences else ""
    return bpy.path.abspath(folder) if folder else ""


def is_unsaved(scene: bpy.types.Scene) -> bool:
    """Whether the folder would be beside a .blend that does not exist yet."""
    return scene.bnvpl.folder.startswith("//") and not bpy.data.filepath


def kept_folder(scene: bpy.types.Scene) -> Path:
    """Where the scene's files are kept: beside the .blend, else in the temporary folder."""
    if is_unsaved(scene):
        return Path(tempfile.gettempdir()) / (TEMPORARY_PREFIX + bpy.path.clean_name(scene.name))
    return Path(bpy.path.abspath(scene.bnvpl.folder))


def request_of(scene: bpy.types.Scene, layers: tuple[str, ...]) -> Request:
    own, render = scene.bnvpl, scene.render
    return Request(
        preset=own.preset,
        vpls=own.vpls,
        samples=own.samples,
        seed=own.seed,
        threads=render.threads if render.threads_mode == "FIXED" else 0,
        layers=layers,
        transparent=render.film_transparent,
        for_denoiser=own.for_denoiser,
    )


CLASSES = (BNVPL_Preferences, BNVPL_Settings)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.bnvpl = bpy.props.PointerProperty(type=BNVPL_Settings)


def unregister() -> None:
    del bpy.types.Scene.bnvpl
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
