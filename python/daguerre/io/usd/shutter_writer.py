"""Writes exposure and shutter of a camera."""

from __future__ import annotations

from fractions import Fraction
from operator import attrgetter

from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.parameters import CAMERA

from .daguerre_attributes import CENTERED, CURVE, EFFICIENCY, PREFIX
from .exposure import EXPOSURE
from .rolling import OMNI, OURS, SCHEMA, SIDES
from .stage_writer import Output

#: Largest denominator of a time in rational seconds.
_DENOMINATOR = 10**9


def write_exposure(output: Output) -> None:
    """Writes what differs from the defaults, as a stage's own values split light from blur."""
    camera = output.camera
    for name, field in EXPOSURE.items():
        if field in camera.motion or getattr(camera, field) != CAMERA[field].default:
            output.follow(name, "float", attrgetter(field), field)


def write_shutter(output: Output) -> None:
    """Writes the shutter's times, its curve, and how it scans."""
    camera = output.camera
    rate = output.rate
    moving = ("shutter_time", "shutter_angle", "shutter_offset")
    output.follow("shutter:open", "double", lambda one: _ends(one)[0] * rate, *moving)
    output.follow("shutter:close", "double", lambda one: _ends(one)[1] * rate, *moving)
    if camera.shutter_offset is None:
        output.set(PREFIX + CENTERED, "bool", True)
    _write_curve(output)
    _write_rolling(output, shutter.shutter_time(camera))


def _ends(camera: Camera) -> tuple[float, float]:
    """Begin and end of the exposure from the time of the picture, s."""
    time, offset = shutter.shutter_time(camera), camera.shutter_offset
    opens = -time / 2 if offset is None else offset / camera.fps
    return opens, opens + time


def _write_curve(output: Output) -> None:
    curve = output.camera.shutter_curve
    if isinstance(curve, str):
        output.set(PREFIX + CURVE, "token", curve)
    elif isinstance(curve, tuple):
        output.set(PREFIX + EFFICIENCY, "double", curve[1])
    elif curve is not None:
        output.set(PREFIX + CURVE, "double2[]", [tuple(map(float, point)) for point in curve])


def _write_rolling(output: Output, time: float) -> None:
    rolling = output.camera.rolling_shutter
    if rolling is None:
        return
    names = {side: name for name, side in SIDES.items()}
    if rolling.line_time is None:
        output.set(OURS + "scanOrder", "token", rolling.scan_order)
        output.set(OURS + "readoutTime", "double", rolling.readout_time)
        return
    output.apply(SCHEMA)
    output.set(OMNI + "scanOrder", "token", names[rolling.scan_order])
    output.set(OMNI + "lineOffset", "double2", _rational(rolling.line_time))
    output.set(OMNI + "lineExposure", "double2", _rational(time))


def _rational(seconds: float) -> tuple[float, float]:
    made = Fraction(seconds).limit_denominator(_DENOMINATOR)
    return float(made.numerator), float(made.denominator)
