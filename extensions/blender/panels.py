# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels in the Properties editor: the camera's and the render's, and Blender's own that fit."""

from collections.abc import Iterator
from typing import Any

import bpy

from daguerre.camera.exposure_mode import AUTOMATIC

from . import choices, denoising, lens_facts, lens_picture, translation
from .engine import ENGINE

#: Blender's panels that show for its simplest engine, but set what Daguerre does not have.
_NOT_OURS = {"DATA_PT_light", "NODE_DATA_PT_light", "RENDER_PT_simplify", "VIEWLAYER_PT_filter"}
#: Panels of another engine whose values Daguerre reads: materials, lights, worlds, focus, blur.
_OURS_TOO = {
    "DATA_PT_EEVEE_light", "DATA_PT_camera_dof", "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface",
    "MATERIAL_PT_preview", "RENDER_PT_eevee_film", "RENDER_PT_eevee_motion_blur",
}  # fmt: skip
#: Side of the picture of a lens, in lines of the panel.
PICTURE_SCALE = 12.0


class _Panel:
    """A panel of rows of properties, which shows for this engine alone."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {ENGINE}
    rows: tuple[str, ...] = ()
    layout: Any

    @classmethod
    def poll(cls, context: Any) -> bool:
        return context.engine in cls.COMPAT_ENGINES and cls.group(context) is not None

    @classmethod
    def group(cls, context: Any) -> Any:
        """Group of the properties that it shows; None: there is none here."""
        return context.scene.daguerre

    def draw(self, context: Any) -> None:
        self.layout.use_property_split = True
        self.head(context)
        group, warnings = self.group(context), self.warnings(context)
        for name in self.shown(group):
            self.layout.prop(group, name)
            if name in warnings:
                self.layout.label(text=warnings[name], icon="ERROR")
        self.foot(context)

    def head(self, context: Any) -> None:
        """Draws what stands above the properties."""

    def foot(self, context: Any) -> None:
        """Draws what stands below them."""

    def warnings(self, context: Any) -> dict[str, str]:
        """Sentences below properties that cannot work, by their names."""
        return {}

    def shown(self, group: Any) -> Iterator[str]:
        """Names of the properties that matter now."""
        yield from self.rows


class _CameraPanel(_Panel):
    bl_context = "data"

    @classmethod
    def group(cls, context: Any) -> Any:
        return context.camera.daguerre if context.camera else None

    def warnings(self, context: Any) -> dict[str, str]:
        reach = translation.film_reach_mm(context.camera, context.scene.render)
        return lens_facts.warnings(self.group(context), reach)


class LensPanel(_CameraPanel):
    """A panel below the chosen lens, its picture and its facts."""

    def head(self, context: Any) -> None:
        group = self.group(context)
        name = next(name for key, name, _ in choices.LENSES if key == group.lens)
        self.layout.operator("daguerre.choose_lens", text=name, icon="VIEWZOOM")
        facts = lens_facts.of(group)
        if isinstance(facts, lens_facts.Facts):
            self._draw_facts(group, facts)
        elif facts:
            self.layout.label(text=facts, icon="ERROR")

    def _draw_facts(self, group: Any, facts: lens_facts.Facts) -> None:
        picture = lens_picture.shown(group, facts)
        if isinstance(picture, int):
            self.layout.template_icon(icon_value=picture, scale=PICTURE_SCALE)
        else:
            self.layout.label(text=picture, icon="ERROR")
        rows = self.layout.column(align=True)
        for name, value in facts.lines():
            row = rows.split(factor=0.4)
            row.label(text=name)
            row.label(text=value)


class DAGUERRE_PT_lens(LensPanel, bpy.types.Panel):
    """Lens of the camera."""

    bl_label = "Lens (Daguerre)"

    def shown(self, group: Any) -> Iterator[str]:
        if group.lens == "file":
            yield "lens_file"
        if group.lens not in ("blender", "pinhole"):
            yield from ("lens_model", "zoom", "focus_mode", "tilt_x", "tilt_y")


class DAGUERRE_PT_iris(_CameraPanel, bpy.types.Panel):
    """Opening of the lens."""

    bl_label = "Iris"

    def shown(self, group: Any) -> Iterator[str]:
        if group.lens in ("blender", "pinhole"):
            return
        if group.exposure_mode not in ("S", "P"):  # which choose the stop
            yield "use_t_stop"
            yield "t_stop" if group.use_t_stop else "f_stop"
        yield "blades"
        if group.blades:
            yield from ("blade_rotation", "blade_curvature")


class DAGUERRE_PT_body(_CameraPanel, bpy.types.Panel):
    """Sensor and exposure."""

    bl_label = "Sensor and Exposure"

    def shown(self, group: Any) -> Iterator[str]:
        yield from ("sensor", "exposure_mode")
        if group.exposure_mode in AUTOMATIC:
            yield "meter"
        if group.exposure_mode != "auto":
            yield "iso"
        yield "ev"


class DAGUERRE_PT_shutter(_CameraPanel, bpy.types.Panel):
    """Shutter."""

    bl_label = "Shutter"

    def shown(self, group: Any) -> Iterator[str]:
        if group.exposure_mode not in ("A", "P"):  # which choose the time
            yield "shutter_mode"
            if group.shutter_mode != "blender":
                yield f"shutter_{group.shutter_mode}"
        yield from ("shutter_type", "rolling_side")
        if group.rolling_side != "off":
            yield "rolling_time"


class DAGUERRE_PT_stray(_CameraPanel, bpy.types.Panel):
    """Light that the lens adds."""

    bl_label = "Flare, Diffraction and Dispersion"
    rows = ("flare", "scatter", "diffraction", "dispersion")


class DAGUERRE_PT_sampling(_Panel, bpy.types.Panel):
    """Samples and light paths."""

    bl_label = "Sampling"
    bl_context = "render"
    rows = ("spp", "noise", "light_paths", "denoise")

    def warnings(self, context: Any) -> dict[str, str]:
        if not self.group(context).denoise or denoising.is_there():
            return {}
        return {"denoise": "No denoiser here: use the compositor's Denoise node"}


class DAGUERRE_PT_photograph(_Panel, bpy.types.Panel):
    """Photograph beside the render."""

    bl_label = "Photograph"
    bl_context = "output"

    def shown(self, group: Any) -> Iterator[str]:
        yield "photograph"
        if group.photograph:
            yield from ("look", "raw")


class DAGUERRE_PT_passes(_Panel, bpy.types.Panel):
    """Passes of the picture."""

    bl_label = "Passes (Daguerre)"
    bl_context = "view_layer"
    rows = ("passes",)


def compatible() -> Iterator[Any]:
    """Blender's own panels whose values Daguerre reads."""
    for panel in bpy.types.Panel.__subclasses__():
        engines: set[str] = getattr(panel, "COMPAT_ENGINES", set())
        name = panel.__name__
        if name in _OURS_TOO or ("BLENDER_RENDER" in engines and name not in _NOT_OURS):
            yield panel


_CLASSES = (
    DAGUERRE_PT_lens, DAGUERRE_PT_iris, DAGUERRE_PT_body, DAGUERRE_PT_shutter, DAGUERRE_PT_stray,
    DAGUERRE_PT_sampling, DAGUERRE_PT_photograph, DAGUERRE_PT_passes,
)  # fmt: skip


def register() -> None:
    """Adds the panels."""
    lens_picture.register()
    for one in _CLASSES:
        bpy.utils.register_class(one)
    for panel in compatible():
        panel.COMPAT_ENGINES.add(ENGINE)


def unregister() -> None:
    """Removes the panels."""
    for panel in compatible():
        panel.COMPAT_ENGINES.discard(ENGINE)
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
    lens_picture.unregister()
