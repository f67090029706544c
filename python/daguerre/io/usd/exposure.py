"""Reads exposure and shutter of a camera of USD.

``fStop`` and the shutter make blur, ``exposure:*`` makes brightness. Only values that the stage
has count: the schema's fallbacks of ``exposure:*`` (1 s, f/1) are those of no photograph.

Source: OpenUSD, UsdGeomCamera, "Exposure" and "Shutter".
"""

from __future__ import annotations

from typing import Any

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
            found[field] = read.accepted(name, field, read.number(name))
    return found


def never_opens(read: Checked) -> bool:
    """Whether the shutter closes before it opens: the picture is black."""
    opens, closes = _shutter(read)
    return closes < opens


def read_shutter(read: Checked) -> dict[str, Any]:
    """Shutter that the stage has: time in s, and where it opens in frames.

    ``shutter:open`` and ``shutter:close`` are in time codes, relative to that of the frame. Both 0
    is no blur.
    """
    rate = read.stage.frame_rate
    found: dict[str, Any] = {"fps": rate}
    if not (read.is_authored("shutter:open") or read.is_authored("shutter:close")):
        return found
    opens, closes = (code / read.stage.clock.rate for code in _shutter(read))
    time = read.accepted("shutter:close", "shutter_time", closes - opens)
    offset = read.accepted("shutter:open", "shutter_offset", opens * rate)
    return found | {"shutter_time": time, "shutter_offset": offset}


def _shutter(read: Checked) -> tuple[float, float]:
    return read.number("shutter:open") or 0.0, read.number("shutter:close") or 0.0
