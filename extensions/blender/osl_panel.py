# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel for users of Cycles who only want the lens: it writes a camera shader and uses it."""

from collections.abc import Iterator
from typing import Any

import bpy

from . import osl_camera
from .panels import LensPanel
from .reports import told

CYCLES = "CYCLES"


def _camera(context: Any) -> Any:
    """Camera object of the panel, or of the scene; None: there is none."""
    thing: Any = getattr(context, "object", None)
    is_shown = getattr(context, "camera", None) is not None and thing is not None
    return thing if is_shown and thing.type == "CAMERA" else context.scene.camera


class DAGUERRE_OT_write_osl(bpy.types.Operator):
    """Write the lens as a camera shader for Cycles, and use it; this takes some seconds."""

    bl_idname = "daguerre.write_osl"
    bl_label = "Use Lens in Cycles"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Any) -> bool:
        return _camera(context) is not None

    def execute(self, context: Any) -> set[str]:
        try:
            done = osl_camera.put_on(_camera(context), context.scene)
        except Exception as error:  # whatever it is, the user gets a sentence
            self.report({"ERROR"}, told(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"Daguerre: {done}")
        return {"FINISHED"}


class DAGUERRE_PT_osl(LensPanel, bpy.types.Panel):
    """Lens for Cycles."""

    bl_label = "Daguerre lens (OSL)"
    COMPAT_ENGINES = {CYCLES}

    def foot(self, context: Any) -> None:
        depth = context.camera.dof
        self.layout.prop(depth, "focus_object")
        if depth.focus_object is None:
            self.layout.prop(depth, "focus_distance")
        self.layout.operator("daguerre.write_osl", icon="CAMERA_DATA")
        if context.scene.cycles.device == "GPU":
            self.layout.label(text="Of all GPUs, those with OptiX run camera shaders", icon="INFO")

    def shown(self, group: Any) -> Iterator[str]:
        if group.lens == "file":
            yield "lens_file"
        yield from ("zoom", "use_t_stop", "t_stop" if group.use_t_stop else "f_stop")
        yield "blades"
        if group.blades:
            yield from ("blade_rotation", "blade_curvature")
        yield from ("sensor", "dispersion")


_CLASSES = (DAGUERRE_OT_write_osl, DAGUERRE_PT_osl)


def register() -> None:
    """Adds operator and panel."""
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    """Removes them."""
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
