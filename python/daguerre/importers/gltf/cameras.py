"""Reads cameras of glTF in a photographer's units, with EXT_camera_physical and extras.

glTF itself has only a field of view; other parameters come from ``EXT_camera_physical``
({focalLength mm, sensorSize mm, focusDistance m, fStop}) and ``extras.daguerre`` (parameters of
``Camera`` in camelCase, which take precedence). ``znear`` and ``zfar`` serve rasterizers and are
not read: every file must have a ``znear``, but it is rarely meant.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import lenses
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import check_exposure
from daguerre.camera.exposure_mode import meter_of, mode_of
from daguerre.camera.ideal import IDEAL
from daguerre.camera.parameters import LIMITS
from daguerre.errors import UsageError
from daguerre.files.json_item import Item, clean, short
from daguerre.files.notes import Notes

from .shutter import SHUTTER

_SENSOR_HEIGHT_MM = 24.0
_SENSOR_WIDTH_MM = 36.0

_Reader = Callable[[Item], Any]


def _within(name: str) -> _Reader:
    return lambda item: item.number(*LIMITS[name], above=0)


def _positive(item: Item) -> float:
    return item.number(above=0)


def _any(item: Item) -> float:
    return item.number()


def _sensor(item: Item) -> tuple[float, ...]:
    size = item.numbers(2, 0)
    if min(size) <= 0:
        item.fail(f"out of range: wanted two numbers above 0, got {list(size)}")
    return item.numbers(2, *LIMITS["sensor_size"])


def _f_stop(item: Item) -> float:
    value = item.number()
    if value <= 0:
        item.fail(
            f"out of range: wanted a number above 0 (for a pinhole set lens to pinhole), got "
            f"{value:g}"
        )
    return item.number(*LIMITS["f_stop"])


def _lens(item: Item) -> str:
    # For safety a scene file may name a lens of the library, but no lens file.
    name = item.text()
    if name not in (*IDEAL, *lenses.names()):
        from daguerre.lenses.search import suggest

        hint = suggest(name, IDEAL)
        item.fail(f"refused: wanted the name of a lens in the library, got {short(name)}{hint}")
    return clean(name)


def _named(parse: Callable[[str, str], str]) -> _Reader:
    """Reader of a name by the parser of its flag."""

    def reader(item: Item) -> str:
        try:
            return parse("", item.text())
        except UsageError as error:
            item.fail(str(error).removeprefix(": "))

    return reader


def _one_of(*options: str) -> _Reader:
    return lambda item: item.choice(options)


_PHYSICAL: dict[str, _Reader] = {
    "focalLength": _within("focal_length"),
    "sensorSize": _sensor,
    "fStop": _f_stop,
    "focusDistance": _within("focus_distance"),
}
_EXTRAS: dict[str, _Reader] = _PHYSICAL | {
    "lens": _lens,
    "lensModel": _one_of("exact", *IDEAL),
    "sensorFit": _one_of("horizontal", "vertical", "auto", "fill"),
    "apertureDiameter": _within("aperture_diameter"),
    "focusOn": lambda item: item.text(),
    "focusAt": lambda item: item.numbers(2),
    "focusFrom": _one_of("pupil", "sensor"),
    "focusBreathing": lambda item: item.flag(),
    "blades": lambda item: item.integer(0, 1000),
    "bladeRotation": _any,
    "bladeCurvature": lambda item: item.number(-1, 1),
    "naturalVignetting": lambda item: item.flag(),
    "shift": lambda item: item.numbers(2, *LIMITS["shift"]),
    "iso": _positive,
    "exposureCompensation": _any,
    "exposure": _named(mode_of),
    "meter": _named(meter_of),
    **SHUTTER,
}


def _snake(name: str) -> str:
    return "".join("_" + c.lower() if c.isupper() else c for c in name)


def fields_of(tokens: Sequence[str]) -> tuple[str, ...]:
    """Parameters of ``Camera`` that depend on a value of the file, such as yfov."""
    key = tokens[-1]
    fields = {
        "yfov": ("focal_length",),
        "aspectRatio": ("sensor_size", "focal_length"),
        "sensorSize": ("sensor_size", "focal_length"),
    }
    return fields.get(key, (_snake(key),) if key in _EXTRAS else ())


def read_camera(item: Item, transform: NDArray[np.float64], notes: Notes) -> Camera | None:
    """Reads a camera at ``transform`` (4, 4; rigid); None, with a note, if it is orthographic."""
    if item.need("type").choice(("perspective", "orthographic")) == "orthographic":
        notes.add("an orthographic camera is left out: no lens makes parallel rays")
        return None
    perspective = item.need("perspective")
    yfov_item = perspective.need("yfov")
    yfov = yfov_item.number(above=0)
    if yfov >= math.pi:
        yfov_item.fail(f"out of range: wanted less than pi (radians), got {yfov:g}")
    aspect = perspective.number_of("aspectRatio", 0.0, 1e-3, 1e3, above=0)
    # The sensor gets the aspect ratio of the picture, so that yfov fits.
    width = _SENSOR_HEIGHT_MM * aspect if aspect else _SENSOR_WIDTH_MM
    values: dict[str, Any] = {"sensor_size": (round(width, 6), _SENSOR_HEIGHT_MM)}
    physical = item.extension("EXT_camera_physical")
    if physical is not None:
        values |= _known(physical, _PHYSICAL, notes, "EXT_camera_physical")
    extras = item.get("extras")
    if extras is not None and isinstance(extras.value, dict):
        ours = extras.get("daguerre")
        if ours is not None:
            values |= _known(ours, _EXTRAS, notes, "extras.daguerre")
    if values.get("lens") in (None, *IDEAL):  # a prescription sets the focal length
        values.setdefault("focal_length", 0.5 * values["sensor_size"][1] / math.tan(0.5 * yfov))
        low, high = LIMITS["focal_length"]
        if not low <= values["focal_length"] <= high:
            yfov_item.fail(
                f"out of range: wanted a focal length of {low:g} .. {high:g} mm, "
                f"got {yfov:g} rad, which is {values['focal_length']:g} mm"
            )
    _doubt(values, notes)
    made = Camera(transform=transform, **values)
    try:
        check_exposure(made)
    except UsageError as error:
        item.fail(str(error).removeprefix("camera: "))
    return made


def _known(item: Item, readers: dict[str, _Reader], notes: Notes, of: str) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for member in item.members():
        key = str(member.key)
        if key in readers and member.value is not None:
            values[_snake(key)] = readers[key](member)
        elif key not in readers and key not in ("extras", "extensions"):
            notes.add(f"unknown camera parameter {clean(key)[:40]!r} in {of}")
    return values


def _doubt(values: dict[str, Any], notes: Notes) -> None:
    """Notes implausible values, which are probably in another unit."""
    focal, width = values.get("focal_length"), values["sensor_size"][0]
    if focal is not None and not 1 <= focal <= 2000:
        notes.add(f"a camera has a focal length of {focal:.4g} mm; its unit is probably not mm")
    if not 0.5 <= width <= 200:
        notes.add(f"a camera has a sensor {width:.4g} mm wide; its unit is probably not mm")
