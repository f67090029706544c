"""Exposure in lux seconds of a value of 1 in a frame.

A frame holds H / H0. A white world (D65) of 1 cd/m2, which is 1 on the axis, gives the film an
illuminance of h0 lux. So a value of 1 is an exposure of h0 t lux seconds, with t the exposure time
of a point of the film. A lens that obeys the sine condition has h0 = pi sin^2(theta') =
(pi / 4) / N^2, with N the working f-number (Ray, Applied Photographic Optics, 3rd ed., ch. 13).

``exposure_time`` and ``exposure_f_stop`` separate brightness from blur. ``expTime`` and
``aperture`` of the metadata then are the exposure of the photograph; the stop and shutter of the
blur are in ``metadata["camera"]``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from daguerre.camera.exposure import PINHOLE_F_STOP, ideal_h0
from daguerre.checks import short
from daguerre.doors import guarded
from daguerre.errors import InputError


def pinhole_note(metadata: Mapping[str, Any]) -> str | None:
    """Note on frames of a pinhole, which has no f-stop; None: the frame has one."""
    if metadata.get("aperture") is not None or metadata.get("h0") is None:
        return None
    return (
        f"a pinhole has no f-stop: exposed as if at f/{PINHOLE_F_STOP:g}; exposure_f_stop "
        "sets another"
    )


@guarded
def luminance_exposure(metadata: Mapping[str, Any]) -> float:
    """Exposure of a value of 1 on the film, lux s.

    Args:
        metadata: Metadata of a frame. Without ``luminance_exposure`` the exposure is ``expTime``
            times ``h0``; without ``h0``, as in files of other programs, h0 follows from ``tStop``
            or ``aperture``.

    Raises:
        InputError: A field is missing, negative, zero or no number; the message names it.
    """
    wanted = {
        "luminance_exposure": "lux s of a value of 1",
        "h0": "lux of a value of 1",
        "expTime": "the exposure time in s",
        "tStop": "an f-number",
        "aperture": "an f-number",
    }
    known = {name: _positive(metadata, name, what) for name, what in wanted.items()}
    if known["luminance_exposure"] is not None:
        return known["luminance_exposure"]
    time, stop = known["expTime"], known["tStop"] or known["aperture"]
    if time is None:
        raise InputError("frame: expTime: wanted the exposure time in s, got none")
    if known["h0"] is not None:
        return known["h0"] * time
    if stop is None:
        raise InputError("frame: aperture: wanted an f-number, got none")
    return ideal_h0(stop) * time


def frame_iso(metadata: Mapping[str, Any]) -> float | None:
    """ISO that the camera of a frame was set to; None: unknown.

    Raises:
        InputError: ``isoSpeed`` is negative, zero or no number.
    """
    return _positive(metadata, "isoSpeed", "an ISO")


def _positive(metadata: Mapping[str, Any], name: str, what: str) -> float | None:
    value = metadata.get(name)
    if value is None:
        return None
    try:
        result = float(value)
    except (TypeError, ValueError):
        result = math.nan
    if 0 < result < math.inf:
        return result
    frozen = name == "expTime" and result == 0
    hint = "; the shutter was frozen: exposure_time sets it" if frozen else ""
    raise InputError(f"frame: {name}: wanted {what}, above 0, got {short(value)}{hint}")


def with_exposure(metadata: Mapping[str, Any], factor: float) -> dict[str, Any]:
    """Metadata of the same frame exposed ``factor`` times as long."""
    light = luminance_exposure(metadata)
    time = metadata.get("expTime")
    changed = {"luminance_exposure": light * factor}
    if time is not None:
        changed["expTime"] = time * factor
    return {**metadata, **changed}
