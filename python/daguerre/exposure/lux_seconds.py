"""Exposure in lux seconds of a value of 1 in a frame, and the brightness of its picture.

A frame holds H / H0. A white world (D65) of 1 cd/m2, which is 1 on the axis, gives the film an
illuminance of h0 lux. So a value of 1 is an exposure of h0 t lux seconds, with t the exposure time
of a point of the film. A lens that obeys the sine condition has h0 = pi sin^2(theta') =
(pi / 4) / N^2, with N the working f-number (Ray, Applied Photographic Optics, 3rd ed., ch. 13).

``exposure_time`` and ``exposure_f_stop`` separate brightness from blur. ``expTime`` and
``aperture`` of the metadata then are the exposure of the photograph; the stop and shutter of the
blur are in ``metadata["camera"]``.

A picture shows gain x H / H0. In the exposure mode ``light`` the gain is 2^EV. In the others it is
0.018 ISO 2^EV times the luminance exposure of a value of 1, so that 10 / ISO lux s become 0.18
(ISO 12232). A sensor or film in ``light`` gets 10 / 0.18 / ISO lux s for a value of 1, so that it
shows the same brightness at any ISO.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from daguerre.argument_checks import guarded
from daguerre.camera.exposure import PINHOLE_F_STOP, ideal_h0
from daguerre.camera.exposure_mode import LIGHT
from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.sensors.iso_speed import GREY, GREY_LX_S, white_lx_s


def in_light(metadata: Mapping[str, Any]) -> bool:
    """Whether ISO, time and stop leave the brightness of a frame's picture alone."""
    return metadata.get("exposure") == LIGHT


def is_developed(metadata: Mapping[str, Any]) -> bool:
    """Whether pictures of a frame are developed: all except in ``light`` without a white.

    A frame without a mode, such as another program's, is shown as it is.
    """
    if metadata.get("exposure") is None:
        return False
    return not in_light(metadata) or metadata.get("white_balance") is not None


def exposure_of_one(metadata: Mapping[str, Any], iso: float) -> float:
    """Exposure of a sensor or film of an ISO by a value of 1, lux s, without compensation.

    Raises:
        InputError: The frame is not in ``light``, and metadata of its exposure are missing.
    """
    return white_lx_s(iso) if in_light(metadata) else luminance_exposure(metadata)


def compensation_ev(metadata: Mapping[str, Any]) -> float:
    """Exposure compensation of a frame, EV."""
    return float(metadata.get("exposure_compensation") or 0.0)


def compensation(metadata: Mapping[str, Any]) -> float:
    """Factor of a frame's exposure compensation, 2^EV."""
    return float(2.0 ** compensation_ev(metadata))


def display_gain(metadata: Mapping[str, Any]) -> float:
    """Display-linear value of a frame's value of 1; a frame without a mode is ``manual``.

    Raises:
        InputError: See :func:`exposure_of_one`.
    """
    if in_light(metadata):
        return compensation(metadata)
    iso = frame_iso(metadata) or 100.0
    light = luminance_exposure(metadata) * compensation(metadata)
    return light * iso * GREY / GREY_LX_S


def pinhole_note(metadata: Mapping[str, Any]) -> str | None:
    """Note on frames of a pinhole, which has no f-stop; None: the frame has an f-stop."""
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


def with_exposure(metadata: Mapping[str, Any], stops: float) -> dict[str, Any]:
    """Metadata of the same frame at another exposure: in ``light`` by EV, else by time.

    Args:
        metadata: Metadata of a frame.
        stops: Change of exposure, EV.
    """
    if in_light(metadata):
        ev = compensation_ev(metadata) + stops
        return {**metadata, "exposure_compensation": ev or None}
    factor = 2.0**stops
    light = luminance_exposure(metadata)
    time = metadata.get("expTime")
    changed = {"luminance_exposure": light * factor}
    if time is not None:
        changed["expTime"] = time * factor
    return {**metadata, **changed}
