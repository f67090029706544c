"""Reads ``daguerre:*``, camera attributes that UsdGeomCamera lacks.

The attributes need no plugin: any program keeps attributes that it does not know. Parameters that
are plain numbers, names or flags are rows of ``PLAIN``; the exporter writes them from it, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import partial
from typing import Any

import numpy as np

from daguerre.camera import shutter_curve
from daguerre.camera.ideal import IDEAL
from daguerre.camera.lens_scatter import LensScatter
from daguerre.camera.parameters import CAMERA
from daguerre.camera.projection import Projection
from daguerre.checks import short
from daguerre.errors import InputError, UsageError, suggest
from daguerre.lenses import library as lenses
from daguerre.lenses import search
from daguerre.motion.values import Keys, at, keys
from daguerre.pictures.iris import read_grey
from daguerre.sensors import library as sensors

from .checked import Checked
from .rolling import OURS as ROLLING
from .rolling import read_rolling

PREFIX = "daguerre:"
#: Elements of an array of a stage that are read.
_MOST = 1 << 24


@dataclass(frozen=True)
class Plain:
    """A parameter of ``Camera`` as an attribute.

    Attributes:
        field: Name of the parameter.
        name: Name of the attribute, after ``PREFIX``.
        type: Type of the attribute.
    """

    field: str
    name: str
    type: str


PLAIN = (
    Plain("lens_model", "lens:model", "token"),
    Plain("degree", "lens:degree", "int"),
    Plain("fit_tolerance", "lens:fitTolerance", "double"),
    Plain("zoom", "lens:zoom", "double"),
    Plain("t_stop", "lens:tStop", "double"),
    Plain("aperture_diameter", "lens:apertureDiameter", "double"),
    Plain("natural_vignetting", "lens:naturalVignetting", "bool"),
    Plain("dispersion", "lens:dispersion", "bool"),
    Plain("tilt", "tilt", "double2"),
    Plain("focus_distance", "focus:distance", "double"),
    Plain("focus_at", "focus:at", "double2"),
    Plain("focus_on", "focus:on", "string"),
    Plain("focus_from", "focus:from", "token"),
    Plain("focus_by", "focus:by", "token"),
    Plain("focus_breathing", "focus:breathing", "bool"),
    Plain("blades", "aperture:blades", "int"),
    Plain("blade_rotation", "aperture:rotation", "double"),
    Plain("blade_curvature", "aperture:curvature", "double"),
    Plain("sensor_fit", "sensor:fit", "token"),
    Plain("sensor_reflectance", "sensor:reflectance", "double"),
    Plain("near_clip", "nearClip", "double"),
    Plain("fps", "shutter:fps", "double"),
    Plain("shutter_time", "shutter:time", "double"),
    Plain("shutter_angle", "shutter:angle", "double"),
    Plain("shutter_type", "shutter:type", "token"),
    Plain("exposure", "exposure:mode", "token"),
    Plain("meter", "exposure:meter", "string"),
    Plain("iso", "exposure:iso", "double"),
    Plain("exposure_time", "exposure:time", "double"),
    Plain("exposure_f_stop", "exposure:fStop", "double"),
    Plain("responsivity", "exposure:responsivity", "double"),
)
#: Arrays of numbers, by the parameter: attribute, and the counts that it may have.
ARRAYS = {
    "ripple": ("lens:ripple", (2, 3)),
    "cover_glass": ("sensor:coverGlass", (2, 3)),
}
#: Pictures, by the parameter: an asset, or the numbers of rows of a size.
PICTURES = {
    "aperture_image": "aperture:image",
    "front_mask": "lens:frontMask",
    "iris_mask": "lens:irisMask",
}
LENS, SENSOR, DECENTER = "lens", "sensor", "lens:decenter"
SCATTER, PROJECTION = "lens:scatter:", "projection:"
CURVE, EFFICIENCY, CENTERED = "shutter:curve", "shutter:efficiency", "shutter:centered"
WHITE, PITCH = "sensor:whiteBalance", "sensor:pixelPitch"
_SIX = 6  # numbers of a group of surfaces: first, last, x, y, about x, about y


def camel(name: str) -> str:
    """Name in the case of USD."""
    first, *others = name.split("_")
    return first + "".join(word.title() for word in others)


def read_ours(read: Checked) -> dict[str, Any]:
    """Parameters of ``Camera`` that ``daguerre:*`` gives; ``pixel_pitch`` besides, um.

    Raises:
        InputError: A value is wrong; the message names the attribute.
    """
    found = {row.field: _plain(read, row) for row in PLAIN}
    found["lens"] = _named(
        read, LENS, (*IDEAL, *lenses.names()), partial(search.suggest, others=IDEAL)
    )
    found["sensor"] = _named(
        read, SENSOR, sensors.names(), partial(suggest, known=sensors.names(), few=True)
    )
    for field, (name, counts) in ARRAYS.items():
        found[field] = _array(read, name, counts)
    for field, name in PICTURES.items():
        found[field] = _picture(read, name)
    found["decenter"] = _decenter(read)
    found["scatter"] = _scatter(read)
    found["projection"] = _projection(read)
    found["shutter_curve"] = _curve(read)
    found["white_balance"] = read.numbers(PREFIX + WHITE, scalar=True)
    found["pixel_pitch"] = read.number(PREFIX + PITCH, above=0)
    known = {name: value for name, value in found.items() if value is not None}
    known |= read_rolling(read, ROLLING)
    if read.now(PREFIX + CENTERED) is True:
        known["shutter_offset"] = None
    return known


def _plain(read: Checked, row: Plain) -> Any:
    name = PREFIX + row.name
    attribute = read.prim.GetAttribute(name)
    if not attribute:
        return None
    if CAMERA[row.field].kind == "text":
        return _text(read, row)
    if CAMERA[row.field].movable and read.stage.clock.codes(attribute):
        return read.accepted(name, row.field, read.stage.clock.value(attribute))
    value = read.fixed(name)
    return None if value is None else read.accepted(name, row.field, value)


def _text(read: Checked, row: Plain) -> Any:
    name, parse = PREFIX + row.name, CAMERA[row.field].parse
    value = read.text(name)
    if value is None or parse is None:
        return value
    try:
        return parse(read.place(name), value)
    except UsageError as error:
        raise InputError(str(error)) from None


def _named(
    read: Checked,
    name: str,
    names: tuple[str, ...] | list[str],
    near: Callable[[str], str],
) -> str | None:
    """Name of a library, or the file of an asset; ``near`` suggests names after an unknown name."""
    word = read.text(f"{PREFIX}{name}:name")
    if word is not None:
        if word not in names:
            read.fail(
                f"{PREFIX}{name}:name",
                f"a {name} of the library",
                short(word) + near(word),
            )
        return word
    path = read.asset(f"{PREFIX}{name}:file")
    if path is None:
        return None
    if path in names:
        return path
    return str(read.stage.resolve(read.place(f"{PREFIX}{name}:file"), path))


def _array(read: Checked, name: str, counts: tuple[int, ...]) -> tuple[float, ...] | None:
    value: tuple[float, ...] | None = read.numbers(PREFIX + name)
    if value and len(value) not in counts:
        read.fail(PREFIX + name, f"{' or '.join(map(str, counts))} numbers", len(value))
    return value or None


def _picture(read: Checked, name: str) -> Any:
    if isinstance(read.now(PREFIX + name), str) or _is_asset(read, PREFIX + name):
        path = read.asset(PREFIX + name)
        return path and read_grey(read.stage.resolve(read.place(PREFIX + name), path))
    value = read.fixed(PREFIX + name)
    if value is None:
        return None
    size = read.numbers(f"{PREFIX}{name}Size", 2) or (0.0, 0.0)
    width, height = (int(side) for side in size)
    count = len(value) if hasattr(value, "__len__") else 0
    if not (0 < width * height == count <= _MOST):
        read.fail(f"{PREFIX}{name}Size", "the width and height of its numbers", (width, height))
    pixels = np.array(value, np.float32).reshape(height, width)
    if not (np.isfinite(pixels).all() and pixels.min() >= 0 and pixels.max() > 0):
        read.fail(PREFIX + name, "numbers of at least 0, some of them above 0", "others")
    return pixels


def _is_asset(read: Checked, name: str) -> bool:
    attribute = read.prim.GetAttribute(name)
    return bool(attribute) and str(attribute.GetTypeName()) == "asset"


def _decenter(read: Checked) -> Any:
    value = read.numbers(PREFIX + DECENTER)
    if not value:
        return None
    if len(value) % _SIX:
        read.fail(PREFIX + DECENTER, "groups of 6 numbers", f"{len(value)} numbers")
    groups = []
    for i in range(0, len(value), _SIX):
        first, last, x, y, about_x, about_y = value[i : i + _SIX]
        groups.append(((int(first), int(last)), (x, y), (about_x, about_y)))
    return tuple(groups)


def _scatter(read: Checked) -> LensScatter | None:
    found: dict[str, Any] = {}
    for part in fields(LensScatter):
        name = PREFIX + SCATTER + camel(part.name)
        pair = isinstance(part.default, tuple)
        value = read.numbers(name, 2) if pair else read.number(name)
        if value is not None:
            found[part.name] = value
    return LensScatter(**found) if found else None


def _projection(read: Checked) -> Projection | Keys | None:
    """Projection that NVIDIA has no name for, or keys of it."""
    stem = PREFIX + PROJECTION
    model = read.text(stem + "model")
    if model is None:
        return None
    size = tuple(int(side) for side in read.numbers(stem + "size", 2) or (0, 0))
    parts = [read.moving_numbers(stem + name) for name in ("focal", "principal", "parameters")]
    times = sorted({t for part in parts if isinstance(part, Keys) for t in part.times.tolist()})

    def made(time: float) -> Projection:
        focal, center, terms = (at(part, time) for part in parts)
        try:
            return Projection(str(model), size, focal, center, terms or ())  # type: ignore[arg-type]
        except UsageError as error:
            said = str(error).removeprefix("projection: model: ").removeprefix("projection: ")
            raise InputError(f"{read.place(stem + 'model')}: {said}") from None

    if not times:
        return made(0.0)
    return keys([(time, made(time)) for time in times], "linear")


def _curve(read: Checked) -> str | tuple[str, float] | list[tuple[float, float]] | None:
    """``box``, a trapezoid by its efficiency, or points (fraction of the time, opening)."""
    efficiency = read.number(PREFIX + EFFICIENCY)
    if efficiency is not None:
        if not 0.5 <= efficiency <= 1:
            read.fail(PREFIX + EFFICIENCY, "0.5 .. 1", f"{efficiency:g}")
        return "trapezoid", efficiency
    value = read.now(PREFIX + CURVE)
    if value is None:
        return None
    if isinstance(value, str):
        return value if value == "box" else read.fail(PREFIX + CURVE, "box", short(value))
    numbers = read.numbers(PREFIX + CURVE)
    points = [(float(t), float(v)) for t, v in np.reshape(numbers, (-1, 2))]
    times = [t for t, _ in points]
    rises = all(a <= b for a, b in zip([0.0, *times], [*times, 1.0], strict=True))
    if not 2 <= len(points) <= shutter_curve.MAX_POINTS or not rises:
        read.fail(PREFIX + CURVE, "points with times that increase from 0 to 1", short(points))
    if min(v for _, v in points) < 0 or not any(v > 0 for _, v in points):
        read.fail(PREFIX + CURVE, "openings of at least 0, one of them above 0", short(points))
    return points
