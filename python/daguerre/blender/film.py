"""The part of Blender's film that a picture covers.

Blender fits one side of the sensor to one side of the picture: the width if ``sensor_fit`` is
horizontal, the height if it is vertical, and if it is automatic the sensor's width to the longer
side. A shift is a share of that side, right and up.

Source: Blender manual, Cameras: sensor fit and shift; ``tests/blender/test_cameras.py`` compares
with ``bpy_extras.object_utils``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy


@dataclass(frozen=True)
class Film:
    """Film of a picture.

    Attributes:
        resolution: Width and height of the picture, px.
        size: Width and height that it covers, mm.
        shift: Shift of the film, right and up, mm.
        fitted: Length of the side of the sensor that is fitted, mm.
        square: Whether pixels are square.
    """

    resolution: tuple[int, int]
    size: tuple[float, float]
    shift: tuple[float, float]
    fitted: float
    square: bool


def resolution_of(render: bpy.types.RenderSettings) -> tuple[int, int]:
    """Width and height of the picture, px."""
    share = render.resolution_percentage
    columns, rows = (
        max(1, int(side) * int(share) // 100) for side in (render.resolution_x, render.resolution_y)
    )
    return columns, rows


def film_of(
    data: bpy.types.Camera, render: bpy.types.RenderSettings, shift_x: float | None = None
) -> Film:
    """Film of a camera.

    Args:
        data: ``bpy.types.Camera``.
        render: ``bpy.types.RenderSettings``.
        shift_x: Shift to the right of one eye of a stereo pair; default: the camera's own.
    """
    right = data.shift_x if shift_x is None else shift_x
    columns, rows = resolution_of(render)
    tall = render.pixel_aspect_y / render.pixel_aspect_x
    fit = data.sensor_fit
    if fit == "AUTO":
        is_wide = columns * render.pixel_aspect_x >= rows * render.pixel_aspect_y
    else:
        is_wide = fit == "HORIZONTAL"
    side = float(data.sensor_height if fit == "VERTICAL" else data.sensor_width)
    pitch = side / (columns if is_wide else tall * rows)
    return Film(
        (columns, rows),
        (columns * pitch, rows * pitch * tall),
        (right * side, data.shift_y * side),
        side,
        abs(tall - 1) < 1e-6,
    )
