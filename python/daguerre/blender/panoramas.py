"""Projections of Blender's panoramic cameras.

The shift of a panorama is a share of the picture's width and height. An equidistant fisheye fits
its field to both sides; other models have a single scale.

The image circle of a fisheye is within the picture; pixels beyond it are black in Cycles, and drawn
here as far as the model sees.

Source: Blender manual, Cameras, panoramic lens types; checked against pictures by Cycles.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from daguerre.camera.projection import Projection
from daguerre.errors import InputError
from daguerre.files.notes import Notes

from .film import Film

if TYPE_CHECKING:
    import bpy


#: Largest angle, radians, that a lens polynomial may have at the middle of the picture.
_MIDDLE = 1e-3


def panorama_of(data: bpy.types.Camera, film: Film, where: str, notes: Notes) -> Projection:
    """Makes the projection of a panoramic camera.

    Args:
        data: ``bpy.types.Camera`` of the type PANO.
        film: Its film.
        where: Place for messages.
        notes: Receives notes on unsupported content.

    Raises:
        InputError: The projection is not supported; the message names the supported projections.
    """
    make = _MAKERS.get(data.panorama_type)
    if make is None:
        known = ", ".join(_MAKERS)
        raise InputError(f"{where}: panorama_type: wanted {known}, got {data.panorama_type}")
    if not film.square:
        notes.add("pixels of a panoramic camera are drawn square")
    if data.panorama_type != "EQUIRECTANGULAR":
        notes.add("a fisheye sees beyond its image circle, where Cycles is black")
    return make(data, film, where)


def _equirectangular(data: bpy.types.Camera, film: Film, where: str) -> Projection:
    (columns, rows), turn = film.resolution, math.pi
    west, east = data.longitude_min, data.longitude_max
    south, north = data.latitude_min, data.latitude_max
    if not (-turn - 1e-6 <= west < east <= turn + 1e-6 and south < north):
        raise InputError(
            f"{where}: longitude_min, longitude_max: wanted -180 <= min < max <= 180 degrees, and "
            f"latitudes likewise, got {math.degrees(west):g} and {math.degrees(east):g}"
        )
    across, down = columns / (east - west), rows / (north - south)
    middle = (-west * across - 0.5, north * down - 0.5)
    return _shifted("equirectangular", data, film, (across, down), middle)


def _equidistant(data: bpy.types.Camera, film: Film, where: str) -> Projection:
    _field(data, where)
    across, down = (side / data.fisheye_fov for side in film.resolution)
    return _shifted("equidistant", data, film, (across, down))


def _equisolid(data: bpy.types.Camera, film: Film, where: str) -> Projection:
    _field(data, where)
    focal = data.fisheye_lens / _pitch(film)
    return _shifted("equisolid", data, film, (focal, focal))


def _polynomial(data: bpy.types.Camera, film: Film, where: str) -> Projection:
    """Angle -(k0 + k1 r + ...), radians, of a radius in mm, as f-theta in focal lengths."""
    bend = [-getattr(data, f"fisheye_polynomial_k{k}") for k in range(5)]
    if abs(bend[0]) > _MIDDLE or not bend[1] > 0:
        raise InputError(
            f"{where}: fisheye_polynomial_k0, _k1: wanted 0 and a number below 0, got "
            f"{-bend[0]:g} and {-bend[1]:g}"
        )
    length = 1 / bend[1]
    terms = tuple(k * length**power for power, k in enumerate(bend[2:], 2))
    focal = length / _pitch(film)
    return replace(_shifted("ftheta", data, film, (focal, focal)), parameters=terms)


def _shifted(
    model: str,
    data: bpy.types.Camera,
    film: Film,
    focal: tuple[float, float],
    middle: tuple[float, float] | None = None,
) -> Projection:
    """A projection with its principal point at ``middle``, px, moved by the camera's shift."""
    columns, rows = film.resolution
    x, y = middle or ((columns - 1) / 2, (rows - 1) / 2)
    principal = (x - data.shift_x * columns, y + data.shift_y * rows)
    return Projection(model, film.resolution, focal, principal)


def _pitch(film: Film) -> float:
    return film.size[0] / film.resolution[0]


def _field(data: bpy.types.Camera, where: str) -> None:
    if not data.fisheye_fov > 0:
        raise InputError(f"{where}: fisheye_fov: wanted a number above 0, got {data.fisheye_fov}")


_MAKERS: dict[str, Callable[[Any, Film, str], Projection]] = {
    "EQUIRECTANGULAR": _equirectangular,
    "FISHEYE_EQUIDISTANT": _equidistant,
    "FISHEYE_EQUISOLID": _equisolid,
    "FISHEYE_LENS_POLYNOMIAL": _polynomial,
}
