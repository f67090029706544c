"""Shutter of a camera: from Daguerre's panel, else from Blender's motion blur.

Blender's shutter is a share of a frame that begins, is centred or ends at the frame; its curve is
the opening over that time. Source: Blender manual, Motion Blur.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.files.notes import Notes

from .camera_panel import CameraPanel

if TYPE_CHECKING:
    import bpy


#: When a shutter of one frame opens, frames.
OPENS = {"START": 0.0, "CENTER": -0.5, "END": -1.0}
#: Points of a shutter's curve.
_POINTS = 33


def shutter_of(
    render: bpy.types.RenderSettings, panel: CameraPanel, notes: Notes
) -> dict[str, Any]:
    """Parameters of a camera's shutter.

    Args:
        render: ``bpy.types.RenderSettings``.
        panel: The camera's properties.
        notes: Receives notes on unsupported content.
    """
    found: dict[str, Any] = {"fps": float(render.fps) / float(render.fps_base)}
    mode = panel.named("shutter_mode", "blender")
    if mode is not None:
        name = f"shutter_{mode}"  # time or angle
        found[name] = float(panel.chosen(name))
    else:
        found |= _of_blender(render, found["fps"], notes)
    if (kind := panel.named("shutter_type")) is not None:
        found["shutter_type"] = kind
        found.pop("shutter_curve", None)
    side, time = panel.named("rolling_side", "off"), panel.chosen("rolling_time")
    if side is not None and time:
        found["rolling_shutter"] = RollingShutter(side, readout_time=float(time))
    return found


def _of_blender(render: bpy.types.RenderSettings, fps: float, notes: Notes) -> dict[str, Any]:
    share = float(render.motion_blur_shutter)
    if not render.use_motion_blur or share <= 0:
        return {"shutter_time": 0.0}
    opens = OPENS[render.motion_blur_position] * share
    cycles = getattr(render.id_data, "cycles", None)
    if getattr(cycles, "rolling_shutter_type", "NONE") != "NONE":
        notes.add("the rolling shutter of Cycles is left out: set the one in Daguerre's panel")
    found = {"shutter_time": share / fps, "shutter_offset": opens}
    curve = _curve(render.motion_blur_shutter_curve)
    return found | ({"shutter_curve": curve} if curve else {})


def _curve(mapping: bpy.types.CurveMapping) -> list[tuple[float, float]] | None:
    """Opening over the time of the shutter, 0 to 1; None: open all the time, or never."""
    mapping.initialize()
    line = mapping.curves[0]
    times = [k / (_POINTS - 1) for k in range(_POINTS)]
    opening = [min(max(float(mapping.evaluate(line, t)), 0.0), 1.0) for t in times]
    if max(opening) <= 0 or min(opening) >= max(opening) - 1e-4:
        return None
    return list(zip(times, opening, strict=True))
