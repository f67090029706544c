"""Values of a camera as people type them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from daguerre import units
from daguerre.camera.rolling_shutter import RollingShutter, ShutterCurve
from daguerre.errors import UsageError, suggest


def pair(example: str) -> Callable[[str, str], tuple[float, ...]]:
    """A reader of two numbers between commas."""
    return lambda flag, text: units.numbers(flag, text, 2, example)


def point(example: str) -> Callable[[str, str], tuple[float, ...]]:
    """A reader of three numbers between commas."""
    return lambda flag, text: units.numbers(flag, text, 3, example)


def number(wanted: str) -> Callable[[str, str], float]:
    """A reader of a number or a fraction."""
    return lambda flag, text: units.plain_number(flag, text, wanted)


def cover_glass(flag: str, text: str) -> tuple[float, ...]:
    """``MM,GAP[,INDEX]``."""
    return units.numbers(flag, text, 3 if text.count(",") > 1 else 2, "2,1")


def sensor(flag: str, text: str) -> Any:
    """A size, mm (a tuple), or a ``Sensor`` of the library or a file."""
    name = text.strip().lower()
    if name in units.SENSORS or (name[:1].isdigit() and "x" in name):
        return units.sensor_mm(flag, text)
    from daguerre import sensors

    known = sensors.names()
    if text not in known and Path(text).suffix.lower() != ".json":
        raise UsageError(
            f"{flag}: wanted a sensor ({', '.join(known)}, or a .json file), a size in mm such as "
            f"36x24, or one of {', '.join(units.SENSORS)}; got {text!r}"
            f"{suggest(name, [*known, *units.SENSORS])}"
        )
    return sensors.load(text)


def shutter_type(flag: str, text: str) -> str:
    """A type, with ``-`` or ``_`` between words."""
    return text.replace("-", "_")


def shutter_curve(flag: str, text: str) -> ShutterCurve:
    """``box``, ``trapezoid:E``, or a file with a table."""
    if text == "box":
        return text
    kind, _, efficiency = text.partition(":")
    if kind == "trapezoid":
        wanted = "trapezoid:E with an efficiency E of 0.5 .. 1, such as trapezoid:0.8"
        return "trapezoid", units.plain_number(flag, efficiency, wanted)
    from daguerre.camera.shutter_curve import read_curve

    return read_curve(Path(text))


def rolling_shutter(flag: str, text: str) -> RollingShutter:
    """``SIDE,S`` of the whole read-out, or ``SIDE,S/line``."""
    side, comma, time = text.partition(",")
    if not comma:
        raise UsageError(
            f"{flag}: wanted a side and a time such as top,16.6ms (read-out) or top,15us/line; "
            f"got {text!r}"
        )
    per_line = time.removesuffix("/line")
    if per_line != time:
        return RollingShutter(side.strip(), line_time=units.time_s(flag, per_line))
    return RollingShutter(side.strip(), readout_time=units.time_s(flag, time))
