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
from typing import TYPE_CHECKING, Any

from .checks import number, short
from .errors import InputError
from .sensors.illuminants import white_xy

if TYPE_CHECKING:
    from .camera import Camera

#: F-stop of a pinhole, whose opening has no size: the photographer's sunny 16, two stops wider.
PINHOLE_F_STOP = 8.0
#: Facts of a camera about exposure; h0 follows from the others, of a pinhole from its stop.
_EXPOSURE_FACTS = (
    *("iso", "exposure_compensation", "exposure_time", "exposure_f_stop", "responsivity"),
    *("white_balance", "h0"),
)


def ideal_h0(f_number: float) -> float:
    """Illuminance on the axis by a world of 1 cd/m2, lux, behind an ideal lens.

    Args:
        f_number: Working f-number: distance of the film / diameter of the exit pupil. Below 0.5
            there is no such lens: light comes from no more than the half sphere.
    """
    return math.pi * min(1.0, 0.5 / f_number) ** 2


def lens_h0(camera: Camera, facts: Mapping[str, Any], film_mm: float) -> float:
    """``h0`` of the camera's lens as it is at mid-shutter, lux per cd/m2.

    Args:
        camera: Camera, for a pinhole's ``exposure_f_stop``.
        facts: Resolved facts; a real lens brings its own h0.
        film_mm: Film distance of an ideal lens.
    """
    if "h0" in facts:
        return float(facts["h0"])
    if "aperture_diameter_mm" in facts:
        return ideal_h0(film_mm / facts["aperture_diameter_mm"])
    return ideal_h0(camera.exposure_f_stop or PINHOLE_F_STOP)


def exposure_facts(camera: Camera) -> dict[str, Any]:
    """Exposure parameters other than shutter and stop that were given, for metadata and hashes."""
    usual = {"exposure_time": None, "exposure_f_stop": None, "responsivity": 1.0}
    given = {name: getattr(camera, name) for name in usual}
    return {name: value for name, value in given.items() if value != usual[name]}


def without_exposure(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Facts of a camera that make the light of a frame: the rest changes none of its bits."""
    return {name: value for name, value in facts.items() if name not in _EXPOSURE_FACTS}


def exposure_notes(camera: Camera, facts: Mapping[str, Any], shutter_s: float) -> list[str]:
    """Where light and blur are not those of the same shutter and stop."""
    notes = []
    time, stop, own = camera.exposure_time, camera.exposure_f_stop, facts.get("f_stop")
    if time is not None and not math.isclose(time, shutter_s):
        notes.append(f"light is that of {time:g} s (exposure_time), blur that of the shutter")
    if stop is not None and own is not None and not math.isclose(stop, own):
        notes.append(f"light is that of f/{stop:g} (exposure_f_stop), blur that of f/{own:.3g}")
    return notes


def pinhole_note(metadata: Mapping[str, Any]) -> str | None:
    """For frames that are exposed without a stop of their own; None: they have one."""
    if metadata.get("aperture") is not None or metadata.get("h0") is None:
        return None
    return f"a pinhole has no stop: exposed as at f/{PINHOLE_F_STOP:g}; exposure_f_stop sets it"


def exposure_metadata(camera: Camera, facts: Mapping[str, Any], shutter_s: float) -> dict[str, Any]:
    """``expTime``, ``aperture``, ``h0`` and ``luminance_exposure`` of a frame; None: unknown.

    Args:
        camera: Camera as given.
        facts: Resolved facts, with ``h0``.
        shutter_s: How long a point of the film is exposed, s.
    """
    time = shutter_s if camera.exposure_time is None else camera.exposure_time
    own, asked = facts.get("f_stop"), camera.exposure_f_stop
    white = camera.white_balance
    light = facts["h0"] * time * camera.responsivity
    if own is not None and asked is not None:
        light *= (own / asked) ** 2
    return {
        "expTime": time,
        "aperture": asked if asked is not None else own,
        "h0": facts["h0"],
        "luminance_exposure": light if light > 0 else None,
        "exposure_compensation": camera.exposure_compensation or None,
        "white_balance": white,
        "adoptedNeutral": None if white is None else white_xy(white),
    }


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


def check_exposure(camera: Camera) -> None:
    """Refuses exposure parameters that no camera has.

    Raises:
        UsageError: The message names the parameter.
    """
    for name in ("exposure_time", "exposure_f_stop"):
        value = getattr(camera, name)
        if value is not None:
            number(value, f"camera: {name}", above=0)
    number(camera.responsivity, "camera: responsivity", above=0)
    number(camera.exposure_compensation, "camera: exposure_compensation", -64, 64)
    if camera.white_balance is not None:
        white_xy(camera.white_balance, "camera: white_balance")
