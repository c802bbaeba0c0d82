# SPDX-License-Identifier: GPL-3.0-or-later
"""The render engine: writes the scene, runs the tools, shows the image."""

from __future__ import annotations

import json
import shutil
import tempfile
from pathlib import Path

import bpy
import numpy as np

from .exr_file import ExrError, layer, read_exr
from .materials import exported_names
from .scene_data import SceneError, film_size, render_region, scene_data
from .settings import TEMPORARY_PREFIX, is_unsaved, kept_folder, request_of, tools_folder
from .tools import (
    MARK,
    NOTHING_BOUNCES,
    TOOLS,
    Cancelled,
    ToolError,
    commands,
    find_tool,
    make_folder,
    path_command,
    run_lines,
    run_tool,
    script,
)

# Passes: property of the view layer, name, channels, type, our layer and its components.
PASSES = (
    ("use_pass_z", "Depth", "Z", "VALUE", "Z", "Z"),
    ("use_pass_normal", "Normal", "XYZ", "VECTOR", "N", "XYZ"),
    ("use_pass_position", "Position", "XYZ", "VECTOR", "P", "XYZ"),
    ("use_pass_diffuse_color", "DiffCol", "RGB", "COLOR", "albedo", "RGB"),
)
LIGHT_PASSES = (
    ("", "Direct", "RGB", "COLOR", "direct", "RGB"),
    ("", "Indirect", "RGB", "COLOR", "indirect", "RGB"),
)
DENOISER_PASSES = (
    ("", "Denoising Albedo", "RGB", "COLOR", "denoise_albedo", "RGB"),
    ("", "Denoising Normal", "XYZ", "VECTOR", "denoise_normal", "XYZ"),
)
FAR = 1e10  # Blender's depth of the background
# The phases that take most of their tools' time; others do not move the bar.
MAIN_PHASES = ("VPLs", "candidates", "photons", "samples")
# Shares of the whole time, by which the bar of progress moves.
SHARES = dict(zip(("export", *TOOLS), (0.05, 0.05, 0.05, 0.25, 0.6), strict=True))


def passes_of(scene, view_layer):
    chosen = [p for p in PASSES if getattr(view_layer, p[0], False)]
    chosen += LIGHT_PASSES if scene.bnvpl.light_passes else ()
    chosen += DENOISER_PASSES if scene.bnvpl.for_denoiser else ()
    return chosen


def _values(image, name: str, components: str, kind: str) -> np.ndarray:
    """A layer in Blender's axes and its value for nothing."""
    values = layer(image, name, components)
    if kind == "VECTOR":
        values = np.stack([values[..., 0], -values[..., 2], values[..., 1]], axis=2)
    if components == "Z":
        values = np.where(np.isfinite(values), values, FAR)
    return values


class BNVPL_RenderEngine(bpy.types.RenderEngine):
    bl_idname = "BNVPL"
    bl_label = "bnvpl"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for _, name, channels, kind, _, _ in passes_of(scene, renderlayer):
            self.register_pass(scene, renderlayer, name, len(channels), channels, kind)

    def render(self, depsgraph):
        try:
            with tempfile.TemporaryDirectory(prefix=TEMPORARY_PREFIX) as temporary:
                self._render(depsgraph, Path(temporary))
        except (ToolError, SceneError, ExrError, OSError) as error:
            self.error_set(str(error))
            self.report({"ERROR"}, str(error))
        except Cancelled:
            pass

    def _render(self, depsgraph, temporary: Path) -> None:
        scene = depsgraph.scene
        for tool in TOOLS:
            find_tool(tool, tools_folder())
        folder = kept_folder(scene) if scene.bnvpl.keep_files else temporary / "files"
        make_folder(folder, scene.bnvpl.keep_files and is_unsaved(scene))
        passes = passes_of(scene, depsgraph.view_layer)
        request = request_of(scene, ("A", *(p[4] for p in passes)))
        self._export(depsgraph, temporary, folder)
        lines = commands(request)
        try:
            self._run(lines[0], folder)
        except ToolError as error:
            if NOTHING_BOUNCES not in str(error):
                raise
            self.report({"WARNING"}, f"{error}; rendering by paths, without VPLs")
            lines = [[], path_command(request)]
        for command in lines[1:]:
            self._run(command, folder)
        text = script([command for command in lines if command], tools_folder())
        (folder / "render.sh").write_text(text)
        (folder / "render.sh").chmod(0o755)
        self._take(depsgraph, read_exr(folder / "image.exr"), passes)

    def _run(self, command: list[str], folder: Path) -> None:
        for warning in run_tool(command, folder, tools_folder(), self._show, self.test_break):
            self.report({"WARNING"}, warning)

    def _export(self, depsgraph, temporary: Path, folder: Path) -> None:
        """Writes scene.glb, by a Blender of its own, and scene.toml."""
        self.update_stats("", "exporting the scene")
        told = scene_data(depsgraph)
        original = depsgraph.scene.original
        blend = temporary / "scene.blend"
        bpy.data.libraries.write(str(blend), {original}, path_remap="ABSOLUTE")
        request = {
            "blend": str(blend),
            "scene": original.name,
            "view_layer": depsgraph.view_layer.name,
            "frame": original.frame_current,
            "glb": str(temporary / "scene.glb"),
            "world": str(temporary / "world.exr") if told.bakes_world else None,
        }
        (temporary / "request.json").write_text(json.dumps(request))
        command = [bpy.app.binary_path, "--background", "--factory-startup"]
        command += ["--python-exit-code", "1"]
        command += ["--python", str(Path(__file__).with_name("child.py"))]
        command += ["--", str(temporary / "request.json")]
        lines: list[str] = []
        code = run_lines(command, temporary, lines.append, self.test_break)
        if code or not (temporary / "scene.glb").exists():
            raise SceneError("the export to glTF failed: " + "\n".join(lines[-5:]))
        told.add_materials(exported_names(temporary / "scene.glb"))
        for warning in told.warnings:
            self.report({"WARNING"}, warning)
        # It marks the folder as the add-on's, so that it comes before the other files.
        (folder / "scene.toml").write_text(f"{MARK}\n{told.text()}", encoding="utf-8")
        for name in ("scene.glb", "world.exr"):
            if (temporary / name).exists():
                shutil.move(temporary / name, folder / name)

    def _show(self, progress) -> None:
        before = list(SHARES)[: list(SHARES).index(progress.tool)]
        done = sum(SHARES[name] for name in before)
        if progress.phase in MAIN_PHASES:
            self.update_progress(done + SHARES[progress.tool] * progress.share)
        left = "" if progress.left_s is None else f", {progress.left_s:.0f} s left"
        self.update_stats(progress.tool, f"{progress.phase}: {100 * progress.share:.0f} %{left}")

    def _take(self, depsgraph, image, passes) -> None:
        """Gives the image, or its render region, to Blender, whose bottom row comes first."""
        width, height = film_size(depsgraph.scene)
        left, right, bottom, top = render_region(depsgraph.scene)
        for _, name, channels, kind, _, _ in passes:
            self.add_pass(name, len(channels), channels, layer=depsgraph.view_layer.name)
        size = (right - left, top - bottom)
        result = self.begin_result(0, 0, *size, layer=depsgraph.view_layer.name)
        taken = result.layers[0].passes
        transparent = depsgraph.scene.render.film_transparent
        alpha = layer(image, "A", "A") if transparent else np.ones((height, width, 1))
        combined = np.concatenate([layer(image, "", "RGB"), alpha], axis=2)
        arrays = {"Combined": combined}
        for _, name, _, kind, ours, components in passes:
            arrays[name] = _values(image, ours, components, kind)
        for name, values in arrays.items():
            rows = values[::-1][bottom:top, left:right].reshape(size[0] * size[1], -1)
            taken[name].rect = rows.astype(np.float32).tolist()
        self.end_result(result)


def register() -> None:
    bpy.utils.register_class(BNVPL_RenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(BNVPL_RenderEngine)
