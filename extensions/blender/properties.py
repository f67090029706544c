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

from . import choices, metering


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


def _switch(name: str, words: str, *, default: bool = False) -> Any:
    return BoolProperty(name=name, description=words, default=default)


_T_STOP = "F-stop of a lens without losses that is as bright: glass takes some of the light"
_LENS = {
    "lens": _choice("Lens", choices.LENSES, "Lens that takes the picture"),
    "lens_file": StringProperty(
        name="File",
        description="File of a lens: Daguerre (.json), Zemax (.zmx), CODE V (.seq), Optical Bench "
        "or pbrt",
        subtype="FILE_PATH",
    ),
    "lens_model": _choice("Model", choices.MODELS, "Model by which the lens is computed"),
    "zoom": _number(
        CAMERA["zoom"],
        "Zoom",
        0,
        min=0,
        description="Focal length that a zoom lens is set to, mm; 0: as in its file",
    ),
    "focus_mode": _choice("Focus", choices.FOCUS, "Source of the focus distance"),
    "tilt_x": _number(
        CAMERA["tilt"],
        "Tilt X",
        0,
        description="Turn of the lens up, degrees, which tilts the plane of focus",
    ),
    "tilt_y": _number(
        CAMERA["tilt"],
        "Tilt Y",
        0,
        description="Turn of the lens to the left, degrees, which tilts the plane of focus",
    ),
}
_IRIS = {
    "f_stop": _number(
        CAMERA["f_stop"],
        "F-stop",
        5.6,
        description="F-number of the iris: a smaller one is "
        "brighter, and less of the scene is sharp",
    ),
    "t_stop": _number(CAMERA["t_stop"], "T-stop", 5.6, description=_T_STOP),
    "use_t_stop": BoolProperty(
        name="Use T-stop", description="Set the iris by a T-stop instead of an f-stop"
    ),
    "blades": _number(
        CAMERA["blades"],
        "Blades",
        0,
        description="Number of blades of the iris, from 3; 0: it is round",
    ),
    "blade_rotation": _number(CAMERA["blade_rotation"], "Rotation", 0),
    "blade_curvature": _number(CAMERA["blade_curvature"], "Curvature", 0),
}
_BODY = {
    "sensor": _choice(
        "Sensor",
        choices.SENSORS,
        "Sensor behind the lens: its size, and how it sees colours in the photograph",
    ),
    "iso": _number(
        CAMERA["iso"],
        "ISO",
        100,
        min=1e-3,
        description="Speed of the photograph; the render itself keeps its values",
    ),
    "exposure_mode": _choice(
        "Exposure",
        choices.EXPOSURE,
        "Exposure of the photograph: by light alone, by hand, or by a meter",
        default="manual",
        get_transform=lambda group, number, is_set: choices.mode_number(number),
    ),
    "meter": _choice(
        "Metering",
        choices.METER,
        "Part of the picture that the meter takes for middle grey",
        get_transform=lambda group, number, is_set: choices.meter_number(
            number, named=is_set, old=metering.old_meter(group)
        ),
    ),
    "ev": _number(
        CAMERA["exposure_compensation"],
        "Compensation",
        0,
        description="Brightening of the photograph, in stops",
    ),
    "shutter_mode": _choice("Shutter", choices.SHUTTER, "Source of the exposure time"),
    "shutter_time": _number(
        CAMERA["shutter_time"],
        "Time",
        1 / 48,
        precision=5,
        description="Time for which the shutter is open, s; 0 freezes motion",
    ),
    "shutter_angle": _number(
        CAMERA["shutter_angle"],
        "Angle",
        180,
        description="Part of the frame for which the shutter is open, degrees; 360 is all of it",
    ),
    "shutter_type": _choice("Type", choices.SHUTTER_TYPES, "Kind of shutter"),
    "rolling_side": _choice(
        "Rolling", choices.ROLLING, "Side from which the lines are exposed, one after the other"
    ),
    "rolling_time": FloatProperty(
        name="Read-out",
        description="Time from the first line to the last, s",
        default=0.016,
        min=0,
        max=1e3,
        precision=5,
    ),
}
_STRAY = {
    "flare": _switch("Flare", "Ghosts: light that surfaces of the glass reflect onto the film"),
    "scatter": _switch(
        "Scatter", "Haze: light that barrel, iris and polished surfaces scatter onto the film"
    ),
    "diffraction": _switch("Diffraction", "Stars around lamps, and softness at narrow stops"),
    "dispersion": _switch(
        "Dispersion",
        "Colour fringes: glass bends blue more than red. Off: it bends all alike",
        default=True,
    ),
}
_SCENE = {
    "spp": _number(
        TABLE["spp"],
        "Samples",
        64,
        description="Samples of each pixel; the most, if a noise is set",
    ),
    "noise": FloatProperty(
        name="Noise",
        default=0,
        min=0,
        max=1,
        precision=4,
        description="Relative error at which a pixel is done, such as 0.02; 0: all get all samples",
    ),
    "light_paths": _choice(
        "Light paths",
        choices.LIGHT_PATHS,
        "Paths that start at lamps, which find what lamps light through glass and out of focus",
    ),
    "denoise": BoolProperty(
        name="Denoise",
        description="Denoise the picture at the end, by Open Image Denoise. The compositor's "
        "Denoise node does the same, with the passes denoise_albedo and denoise_normal",
    ),
    "photograph": BoolProperty(
        name="Photograph",
        description="Write the picture beside the render as the camera takes it: exposed, by its "
        "sensor, and developed (.png)",
    ),
    "raw": BoolProperty(
        name="Raw file", description="Write the raw file of the photograph (.dng), too"
    ),
    "look": _choice("Look", choices.LOOK, "Tone curve by which the photograph is developed"),
    "passes": EnumProperty(
        name="Passes",
        items=choices.PASSES,
        options={"ENUM_FLAG"},
        description="Channels that become passes, under their own names",
    ),
}


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
