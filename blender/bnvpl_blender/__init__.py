# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders Blender's scenes with the tools of bnvpl: docs/blender.md."""

bl_info = {
    "name": "bnvpl",
    "author": "the bnvpl developers",
    "version": (0, 3, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Render > Render Engine",
    "description": "Global illumination by blue-noise virtual point lights",
    "category": "Render",
}


def register() -> None:
    from . import engine, panel, settings

    settings.register()
    engine.register()
    panel.register()


def unregister() -> None:
    from . import engine, panel, settings

    panel.unregister()
    engine.unregister()
    settings.unregister()
