"""Reads the shutter in ``extras.daguerre`` of a glTF camera."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daguerre.camera import rolling_shutter, shutter, shutter_curve
from daguerre.camera.parameters import CAMERA, LIMITS
from daguerre.files.json_item import Item


def _curve(item: Item) -> rolling_shutter.ShutterCurve:
    """Reads ``"box"``, ``{"trapezoid": efficiency}`` or points [[fraction, opening], ...]."""
    if isinstance(item.value, str):
        return str(item.choice(("box",)))
    if isinstance(item.value, dict):
        return "trapezoid", item.need("trapezoid").number(0.5, 1)
    points = list(item)
    if not 2 <= len(points) <= shutter_curve.MAX_POINTS:
        item.fail(f"wrong length: wanted 2 .. {shutter_curve.MAX_POINTS} points, got {len(points)}")
    curve: list[tuple[float, float]] = []
    for point in points:
        time, opening = point.numbers(2, 0)
        if time > 1 or (curve and time < curve[-1][0]):
            point.fail(f"out of order: times must not decrease, and lie in 0 .. 1, got {time:g}")
        curve.append((time, opening))
    if not any(opening > 0 for _, opening in curve):
        item.fail("never open: one opening must be above 0")
    return curve


def _rolling(item: Item) -> rolling_shutter.RollingShutter:
    """Reads ``{"scanOrder": side, "lineTime" or "readoutTime": s}``."""
    order = item.get("scanOrder")
    times = {
        name: None if member is None else member.number(*LIMITS["shutter_time"])
        for name in ("lineTime", "readoutTime")
        for member in (item.get(name),)
    }
    if (times["lineTime"] is None) == (times["readoutTime"] is None):
        item.fail("set either lineTime or readoutTime, not both")
    return rolling_shutter.RollingShutter(
        "top" if order is None else order.choice(shutter.SCAN_ORDERS),
        times["lineTime"],
        times["readoutTime"],
    )


SHUTTER: dict[str, Callable[[Item], Any]] = {
    "shutterTime": lambda item: item.number(*LIMITS["shutter_time"]),
    "shutterAngle": lambda item: item.number(*LIMITS["shutter_angle"]),
    "fps": lambda item: item.number(*LIMITS["fps"]),
    "shutterOffset": lambda item: item.number(*LIMITS["shutter_offset"]),
    "shutterType": lambda item: item.choice(CAMERA["shutter_type"].choices),
    "shutterCurve": _curve,
    "rollingShutter": _rolling,
}
