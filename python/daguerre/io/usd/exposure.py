"""Reads exposure and shutter of a camera of USD.

``fStop`` and the shutter make blur, ``exposure:*`` makes brightness. Only values that the stage
has count: the schema's fallbacks of ``exposure:*`` (1 s, f/1) are those of no photograph.

Source: OpenUSD, UsdGeomCamera, "Exposure" and "Shutter".
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from daguerre.motion.values import Keys, at, keys

from .checked import Checked

#: Attributes of USD: the parameters of ``Camera``.
EXPOSURE = {
    "exposure:iso": "iso",
    "exposure:time": "exposure_time",
    "exposure:fStop": "exposure_f_stop",
    "exposure:responsivity": "responsivity",
    "exposure": "exposure_compensation",
}


def read_exposure(read: Checked) -> dict[str, Any]:
    """Parameters of brightness that the stage has."""
    found = {}
    for name, field in EXPOSURE.items():
        if read.is_authored(name):
            found[field] = read.accepted(name, field, read.moving(name, lambda value: value))
    return found


def never_opens(read: Checked) -> bool:
    """Whether the shutter closes before it opens: the picture is black."""
    shut = _shutter(read, lambda opens, closes: closes - opens)
    return bool(min(shut.values if isinstance(shut, Keys) else (shut,)) < 0)


def read_shutter(read: Checked) -> dict[str, Any]:
    """Shutter that the stage has: time in s, and where it opens in frames.

    ``shutter:open`` and ``shutter:close`` are in time codes, relative to that of the frame. Both 0
    is no blur.
    """
    rate = read.stage.frame_rate
    found: dict[str, Any] = {"fps": rate}
    if not (read.is_authored("shutter:open") or read.is_authored("shutter:close")):
        return found
    code_s = 1 / read.stage.clock.rate
    time = _shutter(read, lambda opens, closes: (closes - opens) * code_s)
    offset = _shutter(read, lambda opens, closes: opens * code_s * rate)
    return found | {
        "shutter_time": read.accepted("shutter:close", "shutter_time", time),
        "shutter_offset": read.accepted("shutter:open", "shutter_offset", offset),
    }


def _shutter(read: Checked, combined: Callable[[float, float], float]) -> Any:
    """Number of both ends of the shutter's opening, in time codes: a constant or keys."""
    ends = [read.moving(f"shutter:{end}", lambda value: value) or 0.0 for end in ("open", "close")]
    moving = [end for end in ends if isinstance(end, Keys)]
    if not moving:
        return combined(*ends)
    times = sorted({time for end in moving for time in end.times.tolist()})
    pairs = [(time, combined(*(at(end, time) for end in ends))) for time in times]
    return keys(pairs, moving[0].interpolation)
