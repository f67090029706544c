"""The camera as a sensor of Mitsuba, with film and sampler.

Mitsuba's cameras look along +z and have +x on the left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from daguerre.exporters.record import ExportedView, Outgoing
from daguerre.files.notes import Notes
from daguerre.importers.mitsuba.transforms import TURN

from .scene_xml import Element, add, add_matrix, add_value

#: Clip distances, m, for no near plane and for infinity.
_NEAR, _FAR, _INFINITY = 1e-3, 1e7, 1e8
#: Largest distance from a whole number of pixels that counts as 0, px.
_WHOLE = 1e-3


@dataclass(frozen=True)
class _Window:
    """Window of a centred film, px: Mitsuba's thin lens has no shift.

    Attributes:
        size: Width and height of the film.
        offset: Columns and rows before the picture.
    """

    size: tuple[int, int]
    offset: tuple[int, int]

    @classmethod
    def of(cls, view: ExportedView, resolution: tuple[int, int], notes: Notes) -> _Window:
        """Finds the window of a shift, which is rounded to whole pixels."""
        pitches = (side / count for side, count in zip(view.film_mm, resolution, strict=True))
        shift = [mm / pitch for mm, pitch in zip(view.shift_mm, pitches, strict=True)]
        right, up = (round(pixels) for pixels in shift)
        if max(abs(shift[0] - right), abs(shift[1] - up)) > _WHOLE:
            notes.add("shift of a thin lens is rounded to whole pixels")
        width, height = resolution
        size = width + 2 * abs(right), height + 2 * abs(up)
        return cls(size, (abs(right) + right, abs(up) - up))


def add_sensor(root: Element, outgoing: Outgoing) -> Element:
    """Adds the camera, its film and the number of samples; returns the sensor."""
    view, size = outgoing.view, outgoing.resolution
    thin = view.aperture_radius_m > 0
    window = _Window.of(view, size, outgoing.notes) if thin else _Window(size, (0, 0))
    sensor = add(root, "sensor", type="thinlens" if thin else "perspective")
    add_matrix(sensor, "to_world", view.world_from_camera @ TURN)
    add_value(sensor, "string", "fov_axis", "x")
    add_value(sensor, "float", "fov", _field(view, window.size[0] / size[0]))
    add_value(sensor, "float", "near_clip", view.near_m or _NEAR)
    add_value(sensor, "float", "far_clip", _FAR)
    if thin:
        add_value(sensor, "float", "aperture_radius", float(view.aperture_radius_m))
        add_value(sensor, "float", "focus_distance", min(view.focus_distance_m, _INFINITY))
    else:
        _add_shift(sensor, view)
    if view.lens is not None:
        outgoing.notes.add(
            "lens with a prescription is written as a thin lens with the same framing"
        )
    if view.gain != 1:
        outgoing.notes.add(
            f"exposure is left out: a film has none; ours multiplies the light by {view.gain:.4g}"
        )
    _add_film(sensor, outgoing, window)
    return sensor


def _field(view: ExportedView, wider: float) -> float:
    """Horizontal field of view, degrees, of a film that is so many times as wide, centred."""
    return math.degrees(2 * math.atan(wider * view.film_mm[0] / 2 / view.film_distance_mm))


def _add_shift(sensor: Element, view: ExportedView) -> None:
    """Adds the shift as shares of width and height: to the right and down."""
    for name, shift, side, sign in zip("xy", view.shift_mm, view.film_mm, (1, -1), strict=True):
        if shift:
            add_value(sensor, "float", f"principal_point_offset_{name}", sign * shift / side)


def _add_film(sensor: Element, outgoing: Outgoing, window: _Window) -> None:
    film = add(sensor, "film", type="hdrfilm")
    for name, side in zip(("width", "height"), window.size, strict=True):
        add_value(film, "integer", name, side)
    if window.size != outgoing.resolution:
        names = ("crop_width", "crop_height", "crop_offset_x", "crop_offset_y")
        for name, count in zip(names, (*outgoing.resolution, *window.offset), strict=True):
            add_value(film, "integer", name, count)
    add_value(film, "string", "pixel_format", "rgb")
    add_value(film, "string", "component_format", "float32")
    add(film, "rfilter", type="box")
    sampler = add(sensor, "sampler", type="independent")
    add_value(sampler, "integer", "sample_count", outgoing.spp)
