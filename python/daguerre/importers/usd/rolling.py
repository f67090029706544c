"""Reads rolling shutters: NVIDIA's camera attributes, and our attributes of the same names.

Times are rational seconds, (numerator, denominator); ours may also be plain seconds.

Source: NVIDIA, "Rolling Shutter" (``OmniRtxRollingShutterAPI``).
"""

from __future__ import annotations

from typing import Any

from daguerre.camera.rolling_shutter import RollingShutter
from daguerre.checks import short

from .checked import Checked

OMNI = "omni:rtx:rollingShutter:"
OURS = "daguerre:rollingShutter:"
SCHEMA = "OmniRtxRollingShutterAPI"
#: Sides by NVIDIA's names.
SIDES = {
    "topToBottom": "top",
    "bottomToTop": "bottom",
    "leftToRight": "left",
    "rightToLeft": "right",
}


def read_rolling(read: Checked, prefix: str) -> dict[str, Any]:
    """Parameters of a rolling shutter; none if the camera has none.

    Args:
        read: The camera.
        prefix: ``OMNI`` or ``OURS``.
    """
    order = read.text(prefix + "scanOrder")
    if order in (None, "none"):
        return {}
    side = SIDES.get(str(order), order)
    if side not in SIDES.values():
        read.fail(prefix + "scanOrder", f"none, {', '.join(SIDES)}", short(order))
    line = _seconds(read, prefix + "lineOffset")
    if prefix == OMNI and line is None:
        line = 0.0  # the schema's
    whole = _seconds(read, prefix + "readoutTime") if prefix == OURS else None
    if (line is None) == (whole is None):
        if line is not None:
            read.fail(prefix + "lineOffset", "either lineOffset or readoutTime", "both")
        read.fail(prefix + "lineOffset", "the time from one line to the next", "none")
    found: dict[str, Any] = {"rolling_shutter": RollingShutter(str(side), line, whole)}
    exposure = _seconds(read, prefix + "lineExposure")
    return found | ({"shutter_time": exposure} if exposure else {})


def _seconds(read: Checked, name: str) -> float | None:
    value = read.numbers(name, scalar=True)
    if value is None:
        return None
    if isinstance(value, tuple):
        if len(value) != 2 or not value[1] > 0:
            read.fail(name, "(numerator, denominator above 0), s", short(value))
        value = value[0] / value[1]
    return float(read.accepted(name, "shutter_time", value))
