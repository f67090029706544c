"""Exposure in lux seconds: what a value of 1 in a frame stands for on the film.

A frame holds H / H0. A white world (D65) of 1 cd/m2, which is 1 on the axis, brings the film an
illuminance of h0 lux; so a value of 1 is an exposure of h0 t lux seconds, t being how long a point
of the film is exposed. A lens that obeys the sine condition has h0 = pi sin^2(theta') =
(pi / 4) / N^2, with N the working f-number (Ray, Applied Photographic Optics, 3rd ed., ch. 13).

Blur and light are split by ``exposure_time`` and ``exposure_f_stop``: those two then are what the
photograph was exposed with, in ``expTime`` and ``aperture`` of the metadata; the blur's own stop
and shutter stay among the facts of the camera (``metadata["camera"]``).
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
    """For frames that are exposed without a stop of their own; None: they have one."""
    if metadata.get("aperture") is not None or metadata.get("h0") is None:
        return None
    return (
        f"a pinhole has no f-stop: exposed as at f/{PINHOLE_F_STOP:g}; exposure_f_stop changes that"
    )


@guarded
def luminance_exposure(metadata: Mapping[str, Any]) -> float:
    """Exposure of a value of 1 on the film, lux s.

    Args:
        metadata: Metadata of a frame. Without ``luminance_exposure`` it is ``expTime`` times
            ``h0``, and without that of a lens with ``tStop`` or ``aperture``: those of other
            programs.

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
    """The ISO that a frame was set to; None: it says nothing.

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
    """The facts of the same frame exposed ``factor`` times as long."""
    light = luminance_exposure(metadata)
    time = metadata.get("expTime")
    changed = {"luminance_exposure": light * factor}
    if time is not None:
        changed["expTime"] = time * factor
    return {**metadata, **changed}
