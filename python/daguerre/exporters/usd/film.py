"""Writes lens, film and focus of a camera by UsdGeomCamera's attributes."""

from __future__ import annotations

import math
from functools import partial

from daguerre.camera.camera import Camera
from daguerre.importers.usd.optics import focal_mm, stop_of

from .omni import write_projection
from .stage import Output

#: Camera lengths of a stage in metres, mm.
_TENTH = 100.0
#: Infinity for other programs, m.
_FAR = 1e6
_LENS = ("focal_length", "zoom", "projection", "sensor_size")


def write_film(output: Output) -> None:
    """Writes focal length, apertures, offsets, f-stop and focus; with a calibration, that too."""
    output.follow("focalLength", "float", lambda c: focal_mm(c) / _TENTH, *_LENS)
    film = ("sensor_size", "projection")
    output.follow("horizontalAperture", "float", lambda c: c.sensor_size[0] / _TENTH, *film)
    output.follow("verticalAperture", "float", lambda c: _height(c) / _TENTH, *film)
    for i, side in enumerate(("horizontal", "vertical")):
        output.follow(f"{side}ApertureOffset", "float", partial(_offset, i), "shift", *film)
    by_diameter = output.camera.aperture_diameter is not None
    stops = ("aperture_diameter", *_LENS) if by_diameter else ("f_stop",)
    output.follow("fStop", "float", stop_of, *stops)
    output.follow("focusDistance", "float", _focus, "focus_distance")
    if output.camera.projection is not None:
        write_projection(output)


def _height(camera: Camera) -> float:
    """Height of the film, mm; with a calibration, from the aspect of its picture."""
    if camera.projection is None:
        return float(camera.sensor_size[1])
    width, height = camera.projection.size
    return float(camera.sensor_size[0] * height / width)


def _offset(axis: int, camera: Camera) -> float:
    """Offset of the film, right or up; with a calibration, of its principal point."""
    if camera.projection is None:
        return float(camera.shift[axis] / _TENTH)
    return float(-camera.projection.film(camera.sensor_size[0])["principal_mm"][axis] / _TENTH)


def _focus(camera: Camera) -> float | None:
    """Focus distance, m; None: autofocus."""
    focus = camera.focus_distance
    return focus if focus is None or math.isfinite(focus) else _FAR
