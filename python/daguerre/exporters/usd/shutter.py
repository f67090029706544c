"""Writes exposure and shutter of a camera."""

from __future__ import annotations

from fractions import Fraction
from operator import attrgetter

from daguerre.camera import shutter
from daguerre.camera.camera import Camera
from daguerre.camera.exposure import PINHOLE_F_STOP
from daguerre.importers.usd.daguerre_attributes import CENTERED, CURVE, EFFICIENCY, PREFIX
from daguerre.importers.usd.exposure import EV, RESPONSIVITY
from daguerre.importers.usd.optics import exposed_stop
from daguerre.importers.usd.rolling import OMNI, OURS, SCHEMA, SIDES

from .stage import Output

#: Largest denominator of a time in rational seconds.
_DENOMINATOR = 10**9


def write_exposure(output: Output) -> None:
    """Writes the compensation, and in ``manual`` all of USD's scale, which else is that alone."""
    camera = output.camera
    ev = "exposure_compensation"
    if ev in camera.motion or camera.exposure_compensation:
        output.follow(EV, "float", attrgetter(ev), ev)
    if camera.exposure != "manual":
        return
    shutters = ("exposure_time", "shutter_time", "shutter_angle")
    stops = ("exposure_f_stop", "f_stop", "t_stop", "aperture_diameter", "focal_length")
    output.follow("exposure:iso", "float", attrgetter("iso"), "iso")
    output.follow("exposure:time", "float", _exposure_time, *shutters)
    output.follow("exposure:fStop", "float", _stop, *stops)
    output.follow("exposure:responsivity", "float", _responsivity, "responsivity")


def _exposure_time(camera: Camera) -> float:
    """Time of the brightness, s, which is the shutter's unless it is set."""
    if camera.exposure_time is not None:
        return camera.exposure_time
    return shutter.shutter_time(camera)


def _stop(camera: Camera) -> float:
    """F-stop of the brightness, which a pinhole has, too."""
    return camera.exposure_f_stop or exposed_stop(camera) or PINHOLE_F_STOP


def _responsivity(camera: Camera) -> float:
    return camera.responsivity * RESPONSIVITY


def write_shutter(output: Output) -> None:
    """Writes the shutter's times, its curve, and its scan."""
    camera = output.camera
    rate = output.rate
    moving = ("shutter_time", "shutter_angle", "shutter_offset")
    output.follow("shutter:open", "double", lambda camera: _ends(camera)[0] * rate, *moving)
    output.follow("shutter:close", "double", lambda camera: _ends(camera)[1] * rate, *moving)
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
