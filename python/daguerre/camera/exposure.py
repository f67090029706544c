"""Exposure of a camera: aperture, time and ISO as numbers, notes and metadata."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from daguerre.color.illuminants import white_xy
from daguerre.errors import UsageError

from .exposure_mode import CHOICES, chosen_by, meter_of, mode_of
from .parameters import LIGHT
from .shutter import seconds

if TYPE_CHECKING:
    from .camera import Camera

#: Relative difference below which two numbers count as equal, as files hold single precision.
_SINGLE = 1e-6
LIGHT_DEFAULTS = {row.name: row.default for row in LIGHT}
#: Parameters of brightness alone, with their defaults: they change no light of a frame.
BRIGHTNESS = {name: one for name, one in LIGHT_DEFAULTS.items() if name != "natural_vignetting"}
PINHOLE_F_STOP: float = LIGHT["exposure_f_stop"].usual


#: Metadata keys about exposure; h0 follows from the others, for a pinhole from its f-stop.
_EXPOSURE_FACTS = (
    *("exposure", "meter", "iso", "exposure_compensation", "exposure_time", "exposure_f_stop"),
    *("responsivity", "white_balance", "h0"),
)


def ideal_h0(f_number: float) -> float:
    """Illuminance on the axis by a world of 1 cd/m2, lux, behind an ideal lens.

    Args:
        f_number: Working f-number: film distance / diameter of the exit pupil. Values below 0.5
            are impossible: light would come from more than the half sphere.
    """
    return math.pi * min(1.0, 0.5 / f_number) ** 2


def lens_h0(camera: Camera, film_mm: float, diameter_mm: float | None) -> float:
    """``h0`` of an ideal lens at mid-shutter, lux per cd/m2.

    Args:
        camera: Camera; a pinhole has its ``exposure_f_stop``.
        film_mm: Film distance.
        diameter_mm: Diameter of the aperture; None: a pinhole.
    """
    if diameter_mm is not None:
        return ideal_h0(film_mm / diameter_mm)
    return ideal_h0(camera.exposure_f_stop or PINHOLE_F_STOP)


def exposure_facts(camera: Camera) -> dict[str, Any]:
    """Exposure parameters other than shutter and stop that were given, for metadata and hashes."""
    usual = {"exposure_time": None, "exposure_f_stop": None, "responsivity": 1.0}
    given = {name: getattr(camera, name) for name in usual}
    return {name: value for name, value in given.items() if value != usual[name]}


def without_brightness(camera: Camera) -> Camera:
    """Returns a camera that sees the same light, with the usual brightness."""
    return camera.with_(**BRIGHTNESS)


def without_exposure(facts: Mapping[str, Any]) -> dict[str, Any]:
    """Drops the metadata about exposure, which does not change the light of a frame."""
    return {name: value for name, value in facts.items() if name not in _EXPOSURE_FACTS}


def describe_exposure(camera: Camera, f_stop: float | None, shutter_s: float) -> str:
    """Describes the exposure, such as ``manual, 1/48 s, f/2, ISO 800, +1 EV``.

    Args:
        camera: The camera.
        f_stop: Stop of its lens; None: a pinhole.
        shutter_s: Exposure time of its shutter, s.
    """
    time = shutter_s if camera.exposure_time is None else camera.exposure_time
    stop = f_stop if camera.exposure_f_stop is None else camera.exposure_f_stop
    opening = [] if stop is None else [f"f/{stop:.3g}"]
    parts = [camera.exposure, seconds(time), *opening, f"ISO {camera.iso:g}"]
    if camera.responsivity != 1:
        parts.append(f"responsivity {camera.responsivity:g}")
    if camera.exposure_compensation:
        parts.append(f"{camera.exposure_compensation:+g} EV")
    return ", ".join(parts)


def exposure_notes(camera: Camera, f_stop: float | None, shutter_s: float) -> list[str]:
    """Notes for exposures with brightness and blur from different shutters or stops."""
    if camera.exposure == "light":  # neither sets the brightness
        return []
    notes = []
    time, stop, own = camera.exposure_time, camera.exposure_f_stop, f_stop
    if time is not None and not math.isclose(time, shutter_s, rel_tol=_SINGLE):
        notes.append(
            f"exposure_time sets the brightness (as for {time:g} s); the shutter sets the blur"
        )
    if stop is not None and own is not None and not math.isclose(stop, own, rel_tol=_SINGLE):
        notes.append(
            f"exposure_f_stop sets the brightness (as for f/{stop:g}); the lens at f/{own:.3g} "
            f"sets the blur"
        )
    return notes


def exposure_metadata(
    camera: Camera, f_stop: float | None, h0: float, shutter_s: float
) -> dict[str, Any]:
    """Mode, ``expTime``, ``aperture``, ``h0`` and ``luminance_exposure`` of a frame.

    None: unknown.

    Args:
        camera: Camera as given.
        f_stop: Resolved f-stop; None: a pinhole.
        h0: Illuminance on the axis by a world of 1 cd/m2, lux.
        shutter_s: Time for which each point of the film is exposed, s.
    """
    time = shutter_s if camera.exposure_time is None else camera.exposure_time
    own, asked = f_stop, camera.exposure_f_stop
    white = camera.white_balance
    light = h0 * time * camera.responsivity
    if own is not None and asked is not None:
        light *= (own / asked) ** 2
    return {
        "exposure": camera.exposure,
        "expTime": time,
        "aperture": asked if asked is not None else own,
        "h0": h0,
        "luminance_exposure": light if light > 0 else None,
        "exposure_compensation": camera.exposure_compensation or None,
        "white_balance": white,
        "adoptedNeutral": None if white is None else white_xy(white),
    }


def is_held(camera: Camera, name: str) -> bool:
    """Whether a parameter of a camera is set, or changes over time."""
    return name in camera.motion or getattr(camera, name) != LIGHT_DEFAULTS.get(name)


def check_exposure(camera: Camera) -> None:
    """Checks the exposure parameters of a camera.

    Raises:
        UsageError: The message names the parameter.
    """
    LIGHT.check(camera, "camera")
    meter_of("camera: meter", camera.meter)
    mode = mode_of("camera: exposure", camera.exposure)
    for name in chosen_by(mode):
        if is_held(camera, name):
            raise UsageError(
                f"camera: exposure {mode} chooses {CHOICES[mode]}, but {name} is set: "
                "wanted one of them"
            )
    if camera.white_balance is not None:
        white_xy(camera.white_balance, "camera: white_balance")
