"""Size of the frame on the film, by sensor, resolution and fit."""

from __future__ import annotations

from daguerre.camera.camera import LIMITS, Camera
from daguerre.checks import numbers
from daguerre.errors import UsageError, suggest

FITS = ("horizontal", "vertical", "auto", "fill")


def frame_size(camera: Camera, resolution: tuple[int, int]) -> tuple[float, float]:
    """Width and height (mm) of the part of the film that a picture of this resolution covers."""
    width, height = numbers(camera.sensor_size, "camera: sensor_size", 2, "two positive mm")
    low, high = LIMITS["sensor_size"]
    if not (low <= min(width, height) and max(width, height) <= high):
        raise UsageError(
            f"camera: sensor_size: wanted {low:g} .. {high:g} mm, got {camera.sensor_size}"
        )
    columns, rows = resolution
    if camera.sensor_fit not in FITS:
        raise UsageError(
            f"camera: sensor_fit: wanted {', '.join(FITS)}, got {camera.sensor_fit!r}"
            f"{suggest(str(camera.sensor_fit), FITS)}"
        )
    scale = {  # mm per pixel
        "horizontal": width / columns,
        "vertical": height / rows,
        "auto": width / columns if columns >= rows else height / rows,
        "fill": min(width / columns, height / rows),
    }[camera.sensor_fit]
    return columns * scale, rows * scale
