# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties of cameras and scenes; texts and limits are those of Daguerre's own parameters.

Units are those of ``daguerre.Camera``: mm for lens and sensor, s for time, degrees for angles.
"""

from functools import partial
from typing import Any

import bpy
from bpy import props

from daguerre.camera.parameters import CAMERA
from daguerre.parameters.parameter import Parameter
from daguerre.rendering.parameters import TABLE

from . import choices


def _changed(group: Any, context: Any) -> None:
    """Tells Blender that camera or scene changed, which renders the viewport again."""
    group.id_data.update_tag()


BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty = (
    partial(kind, update=_changed)
    for kind in (
        props.BoolProperty,
        props.EnumProperty,
        props.FloatProperty,
        props.IntProperty,
        props.StringProperty,
    )
)
#: Widest range of a number in Blender.
_MOST = 1e9


def _words(row: Parameter) -> str:
    """Help text of a parameter, with the names of others written out."""
    return row.meaning.replace("{", "").replace("}", "").replace("_", " ")


def _number(row: Parameter, name: str, default: float, **more: Any) -> Any:
    """Property of a number, within the limits of its parameter."""
    whole = row.kind == "whole"
    most = 2**31 - 1 if whole else _MOST
    found = {
        "name": name,
        "description": _words(row),
        "default": default,
        "min": max(row.low, -most),
        "max": min(row.high, most),
        **({} if whole else {"precision": 3}),
        **more,
    }
    return IntProperty(**found) if whole else FloatProperty(**found)


def _choice(name: str, items: list[Any], words: str, **more: Any) -> Any:
    return EnumProperty(name=name, items=items, description=words, **more)


def _switch(row: Parameter, name: str, *, default: bool = False) -> Any:
    return BoolProperty(name=name, description=_words(row), default=default)


_LENS = {
    "lens": _choice("Lens", choices.LENSES, "Lens of the camera"),
    "lens_file": StringProperty(name="File", description="Lens file", subtype="FILE_PATH"),
    "lens_model": _choice("Model", choices.MODELS, _words(CAMERA["lens_model"])),
    "zoom": _number(
        CAMERA["zoom"], "Zoom", 0, min=0, description="Focal length, mm; 0: the file's"
    ),
    "focus_mode": _choice("Focus", choices.FOCUS, "What the lens is focused on"),
    "tilt_x": _number(CAMERA["tilt"], "Tilt X", 0, description="Tilt about the x axis, degrees"),
    "tilt_y": _number(CAMERA["tilt"], "Tilt Y", 0, description="Tilt about the y axis, degrees"),
}
_IRIS = {
    "f_stop": _number(CAMERA["f_stop"], "F-stop", 5.6),
    "t_stop": _number(CAMERA["t_stop"], "T-stop", 5.6),
    "use_t_stop": BoolProperty(name="T-stop", description=_words(CAMERA["t_stop"])),
    "blades": _number(CAMERA["blades"], "Blades", 0),
    "blade_rotation": _number(CAMERA["blade_rotation"], "Rotation", 0),
    "blade_curvature": _number(CAMERA["blade_curvature"], "Curvature", 0),
}
_BODY = {
    "sensor": _choice("Sensor", choices.SENSORS, "Sensor that takes the photograph"),
    "iso": _number(CAMERA["iso"], "ISO", 100, min=1e-3),
    "exposure_mode": _choice("Exposure", choices.EXPOSURE, "What sets the exposure"),
    "ev": _number(CAMERA["exposure_compensation"], "Compensation", 0),
    "shutter_mode": _choice("Shutter", choices.SHUTTER, "How the exposure time is given"),
    "shutter_time": _number(CAMERA["shutter_time"], "Time", 1 / 48, precision=5),
    "shutter_angle": _number(CAMERA["shutter_angle"], "Angle", 180),
    "shutter_type": _choice("Type", choices.SHUTTER_TYPES, _words(CAMERA["shutter_type"])),
    "rolling_side": _choice("Rolling", choices.ROLLING, "Side that a rolling shutter starts from"),
    "rolling_time": FloatProperty(
        name="Read-out", description="Time to read all lines, s", default=0.016, min=0,
        max=1e3, precision=5,
    ),
}  # fmt: skip
_STRAY = {
    "flare": _switch(TABLE["flare"], "Flare"),
    "scatter": _switch(TABLE["scatter"], "Scatter"),
    "diffraction": _switch(TABLE["diffraction"], "Diffraction"),
    "dispersion": _switch(CAMERA["dispersion"], "Dispersion", default=True),
}
_SCENE = {
    "spp": _number(TABLE["spp"], "Samples", 64),
    "noise": FloatProperty(
        name="Noise", default=0, min=0, max=1, precision=4,
        description="Relative error at which a pixel is done; 0: all pixels get all samples",
    ),
    "light_paths": _choice("Light paths", choices.LIGHT_PATHS, _words(TABLE["light_paths"])),
    "denoise": BoolProperty(
        name="Denoise",
        description="Denoise the picture at the end, by Open Image Denoise. The compositor's "
        "Denoise node does the same, with the passes denoise_albedo and denoise_normal",
    ),
    "photograph": BoolProperty(
        name="Photograph", description="Write an exposed and developed picture beside the render"
    ),
    "raw": BoolProperty(name="Raw file", description="Write the raw file (.dng), too"),
    "look": _choice("Look", choices.LOOK, "Tone curve of the photograph"),
    "passes": EnumProperty(
        name="Passes", items=choices.PASSES, options={"ENUM_FLAG"},
        description="Channels that become passes, under their own names",
    ),
}  # fmt: skip


class DaguerreCamera(bpy.types.PropertyGroup):
    """Lens and body of a camera."""

    __annotations__ = {**_LENS, **_IRIS, **_BODY, **_STRAY}


class DaguerreScene(bpy.types.PropertyGroup):
    """Settings of a render."""

    __annotations__ = _SCENE


_CLASSES = (DaguerreCamera, DaguerreScene)


def register() -> None:
    """Adds the groups ``camera.data.daguerre`` and ``scene.daguerre``."""
    for one in _CLASSES:
        bpy.utils.register_class(one)
    bpy.types.Camera.daguerre = props.PointerProperty(type=DaguerreCamera)
    bpy.types.Scene.daguerre = props.PointerProperty(type=DaguerreScene)


def unregister() -> None:
    """Removes the groups."""
    del bpy.types.Scene.daguerre
    del bpy.types.Camera.daguerre
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
