# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators: the search for a lens, the export of the scene, and the copied command line."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import EnumProperty, StringProperty

from daguerre.errors import InputError
from daguerre.files.atomic import write_bytes
from daguerre.scene.packed.chunk import embed

from . import choices, taking, translation
from .command import command
from .engine import ENGINE
from .reports import told


class DAGUERRE_OT_choose_lens(bpy.types.Operator):
    """Search the lenses of the library."""

    bl_idname = "daguerre.choose_lens"
    bl_label = "Choose a Lens"
    bl_options = {"REGISTER", "UNDO"}
    bl_property = "lens"
    __annotations__ = {"lens": EnumProperty(name="Lens", items=choices.SEARCHED)}
    if TYPE_CHECKING:
        lens: str

    @classmethod
    def poll(cls, context: Any) -> bool:
        return _camera(context) is not None

    def invoke(self, context: Any, event: Any) -> set[str]:
        context.window_manager.invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Any) -> set[str]:
        group = _camera(context).daguerre
        if self.lens == "blender":
            group.property_unset("lens")  # whose values rule again
        else:
            group.lens = self.lens
        return {"FINISHED"}


def _camera(context: Any) -> Any:
    """Camera data of the panel, or of the scene; None: there is none."""
    shown = getattr(context, "camera", None)
    scene = context.scene.camera
    return shown or (scene.data if scene is not None else None)


class _OnScene:
    """An operator on the translated scene; errors become reports."""

    report: Any

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.scene.camera is not None

    def execute(self, context: Any) -> set[str]:
        try:
            self.work(context, taking.shot_of(context, ENGINE))
        except Exception as error:  # whatever it is, the user gets a sentence
            self.report({"ERROR"}, told(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def work(self, context: Any, shot: translation.Shot) -> None:
        """Works on the picture of the scene's camera."""
        raise NotImplementedError


class DAGUERRE_OT_export_scene(_OnScene, bpy.types.Operator):
    """Write the scene as .glb, and the command line that draws the picture of F12."""

    bl_idname = "daguerre.export_scene"
    bl_label = "Daguerre scene (.glb + camera)"
    __annotations__ = {
        "filepath": StringProperty(name="File", subtype="FILE_PATH"),
        "filter_glob": StringProperty(default="*.glb", options={"HIDDEN"}),
    }
    if TYPE_CHECKING:
        filepath: str

    def invoke(self, context: Any, event: Any) -> set[str]:
        self.filepath = self.filepath or str(_scene_file())
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def work(self, context: Any, shot: translation.Shot) -> None:
        path = Path(bpy.path.abspath(self.filepath)).with_suffix(".glb")
        text = _command(path, context.scene, shot)
        write_glb(path)
        embed(path, shot.scene)
        for loss in shot.scene.warnings:
            self.report({"WARNING"}, f"Daguerre: {loss}")
        write_bytes(path.with_suffix(".sh"), f"#!/bin/sh\n{text}\n".encode())
        self.report({"INFO"}, f"Daguerre: wrote {path} and {path.with_suffix('.sh').name}")


class DAGUERRE_OT_copy_command(_OnScene, bpy.types.Operator):
    """Copy the command line that renders the exported scene through this camera."""

    bl_idname = "daguerre.copy_command"
    bl_label = "Copy command line"

    def work(self, context: Any, shot: translation.Shot) -> None:
        text = _command(_scene_file(), context.scene, shot)
        context.window_manager.clipboard = text
        self.report({"INFO"}, f"Daguerre: copied: {text}")


def _command(path: Path, scene: Any, shot: translation.Shot) -> str:
    """Command line that draws a shot from the file that the export writes."""
    name, denoises = scene.camera.name_full, scene.daguerre.denoise
    return command(path, name, shot.camera, shot.settings, shot.camera, denoises=denoises)


def _scene_file() -> Path:
    """File that the export suggests: beside the .blend, if that is saved."""
    return Path(bpy.data.filepath or "scene.blend").with_suffix(".glb")


def write_glb(path: Path) -> None:
    """Writes the scene by Blender's glTF exporter, with lights in lumens.

    Raises:
        InputError: Blender cannot write it.
    """
    try:
        bpy.ops.export_scene.gltf(
            filepath=str(path),
            export_format="GLB",
            export_apply=True,
            export_cameras=True,
            export_lights=True,
            export_import_convert_lighting_mode="SPEC",
        )
    except RuntimeError as error:
        raise InputError(f"{path}: wanted a scene that glTF can hold: {error}") from None


def _menu(menu: Any, context: Any) -> None:
    if context.engine == ENGINE:
        menu.layout.operator(DAGUERRE_OT_export_scene.bl_idname)
        menu.layout.operator(DAGUERRE_OT_copy_command.bl_idname)


_CLASSES = (DAGUERRE_OT_choose_lens, DAGUERRE_OT_export_scene, DAGUERRE_OT_copy_command)


def register() -> None:
    """Adds the operators."""
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.TOPBAR_MT_file_export.append(_menu)


def unregister() -> None:
    """Removes the operators."""
    bpy.types.TOPBAR_MT_file_export.remove(_menu)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
