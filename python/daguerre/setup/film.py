"""Size of the frame on the film, by sensor, resolution and fit."""

from __future__ import annotations

from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA


def frame_size(camera: Camera, resolution: tuple[int, int]) -> tuple[float, float]:
    """Width and height (mm) of the part of the film that a picture of this resolution covers."""
    for name in ("sensor_size", "sensor_fit"):
        CAMERA[name].check(getattr(camera, name), f"camera: {name}")
    width, height = (float(side) for side in camera.sensor_size)
    columns, rows = resolution
    scale = {  # mm per pixel
        "horizontal": width / columns,
        "vertical": height / rows,
        "auto": width / columns if columns >= rows else height / rows,
        "fill": min(width / columns, height / rows),
    }[camera.sensor_fit]
    return columns * scale, rows * scale
