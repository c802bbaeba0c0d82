# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels: the render settings, the passes, and those of Blender that apply here, too."""

from __future__ import annotations

import bpy

from .engine import PASSES, BNVPL_RenderEngine
from .settings import kept_folder

ENGINE = BNVPL_RenderEngine.bl_idname
# Panels of EEVEE for lamps, materials and worlds, whose settings are read.
SHARED = {
    "DATA_PT_EEVEE_light",
    "DATA_PT_spot",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_WORLD_PT_surface",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
}


class BNVPL_OT_open_folder(bpy.types.Operator):
    bl_idname = "bnvpl.open_folder"
    bl_label = "Open the Folder"
    bl_description = "Show the kept files in the system's file manager"

    @classmethod
    def poll(cls, context):
        return kept_folder(context.scene).is_dir()

    def execute(self, context):
        return bpy.ops.wm.path_open(filepath=str(kept_folder(context.scene)))


class EnginePanel:
    """What the panels of this engine share."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


class BNVPL_PT_render(EnginePanel, bpy.types.Panel):
    bl_label = "bnvpl"
    bl_context = "render"

    def draw(self, context):
        layout, own = self.layout, context.scene.bnvpl
        layout.use_property_split = True
        for name in ("preset", "vpls", "samples", "seed", "view"):
            layout.prop(own, name)
        layout.prop(context.scene.render, "film_transparent")
        layout.prop(own, "for_denoiser")
        layout.prop(own, "keep_files")
        if own.keep_files:
            layout.prop(own, "folder")
            layout.operator(BNVPL_OT_open_folder.bl_idname, icon="FILE_FOLDER")


class BNVPL_PT_passes(EnginePanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.prop(context.scene.bnvpl, "light_passes")
        for name, *_ in PASSES:
            layout.prop(context.view_layer, name)


CLASSES = (BNVPL_OT_open_folder, BNVPL_PT_render, BNVPL_PT_passes)


def _blender_panels():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", set())
        if panel.__name__ in SHARED or "BLENDER_RENDER" in engines:
            yield panel


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for panel in _blender_panels():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    for panel in _blender_panels():
        panel.COMPAT_ENGINES.discard(ENGINE)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
