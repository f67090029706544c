"""Refuses camera parameters that no lens has, or that the chosen kind of lens cannot honour."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from daguerre import lenses
from daguerre.camera import shutter
from daguerre.camera.camera import IDEAL, LIMITS, Camera
from daguerre.camera.exposure import check_exposure
from daguerre.checks import number, numbers, short, whole
from daguerre.errors import UsageError, suggest

MODELS = ("exact", "polynomial", "thick", "thin", "pinhole")
#: those that have a prescription's elements
TRACED = ("exact", "polynomial")


def check_surfaces(model: str, where: str) -> None:
    """Refuses lens models without surfaces.

    Raises:
        UsageError: The lens has none.
    """
    if model not in TRACED:
        raise UsageError(
            f"{where}: wanted a lens with surfaces (lens_model {' or '.join(TRACED)}), got {model}"
        )


def lens_and_model(camera: Camera) -> tuple[lenses.Lens | None, str]:
    """The prescription, if any, and which of ``MODELS``, or ``projection``."""
    if camera.projection is not None:
        return None, _projection(camera)
    model = camera.lens_model
    if model is not None and model not in MODELS:
        raise UsageError(
            f"camera: lens_model: wanted {', '.join(MODELS)}, got {model!r}"
            f"{suggest(str(model), MODELS)}"
        )
    if not isinstance(camera.lens, lenses.Lens | str | Path | None):
        raise UsageError(
            f"camera: lens: wanted a name, a file, a Lens or None, got {short(camera.lens)}"
        )
    if camera.lens is None or camera.lens in IDEAL:
        kind = str(camera.lens or "thin")
        if model in (*TRACED, "thick"):
            raise UsageError(
                f"camera: lens_model {model}: wanted the name or file of a lens, got none"
            )
        return None, model or kind
    return lenses.load(camera.lens), model or "exact"


def _projection(camera: Camera) -> str:
    """A calibration stands in the place of a lens."""
    from daguerre.camera.projection import Projection

    if not isinstance(camera.projection, Projection):
        raise UsageError(f"camera: projection: wanted a Projection, got {short(camera.projection)}")
    for name in ("lens", "lens_model", "focal_length", "t_stop", "aperture_diameter"):
        if getattr(camera, name) is not None:
            raise UsageError(
                f"camera: projection: wanted without {name}, got both; {name}=None takes it away"
            )
    if any(camera.tilt) or "tilt" in camera.motion or camera.natural_vignetting:
        name = "natural_vignetting" if camera.natural_vignetting else "tilt"
        raise UsageError(f"camera: projection: wanted without {name}, got both")
    return "projection"


def check(camera: Camera, model: str, *, prescription: bool) -> None:
    """Values that no lens has, and values that this kind cannot honour."""
    for name in ("focal_length", "zoom", "f_stop", "t_stop", "aperture_diameter", "iso"):
        value = getattr(camera, name)
        if value is not None:
            hint = name in ("f_stop", "t_stop", "aperture_diameter") and value == 0
            _positive(name, value, "; a pinhole is its own kind: lens='pinhole'" if hint else "")
    if camera.focus_distance is not None:
        _positive("focus_distance", camera.focus_distance, infinite=True)
    shutter.check(camera)
    check_exposure(camera)
    for shift in numbers(camera.shift, "camera: shift", 2, "two finite numbers (mm)"):
        number(shift, "camera: shift", *LIMITS["shift"])
    for tilt in numbers(camera.tilt, "camera: tilt", 2, "two finite angles (degrees)"):
        number(tilt, "camera: tilt", *LIMITS["tilt"])
    if math.hypot(*camera.tilt) > LIMITS["tilt"][1]:
        raise UsageError(
            f"camera: tilt: wanted at most {LIMITS['tilt'][1]:g} degrees, got {camera.tilt}"
        )
    whole(camera.blades, "camera: blades", 0, 64, "0 (round) or 3 .. 64")
    number(camera.blade_rotation, "camera: blade_rotation")
    number(camera.blade_curvature, "camera: blade_curvature", -1)
    if camera.focus_at is not None:
        numbers(camera.focus_at, "camera: focus_at", 2, "a pixel (x, y)")
    if prescription and camera.focal_length is not None:
        raise UsageError(
            "camera: focal_length: a lens with a prescription has its own; "
            "wanted none with it (of a zoom: zoom), or an ideal lens (lens='thin' or 'pinhole')"
        )
    for name in ("zoom", "decenter"):
        if not prescription and getattr(camera, name):
            raise UsageError(
                f"camera: {name}: wanted a lens with a prescription for it, got {model}"
                + ("; its focal_length may be any" if name == "zoom" else "")
            )
    for name in ("decenter", "ripple", "front_mask", "iris_mask"):
        given = getattr(camera, name)
        if model not in TRACED and given is not None and np.size(given):
            raise UsageError(
                f"camera: {name}: wanted lens_model exact, got {model}, which has no elements"
            )
    for name in ("cover_glass", "sensor_reflectance", "scatter"):
        if model not in TRACED and getattr(camera, name):
            raise UsageError(
                f"camera: {name}: wanted a lens with surfaces (lens_model exact), got {model}: "
                f"it is for {'scattered light' if name == 'scatter' else 'ghosts'}"
            )
    if model == "polynomial" and camera.ripple is not None:
        raise UsageError("camera: ripple: wanted lens_model exact, got polynomial, which is smooth")
    _check_fit(camera, model)
    if (model != "thin" or prescription) and camera.aperture_diameter is not None:
        raise UsageError(f"camera: aperture_diameter: this {model} lens takes f_stop instead")
    stops = [n for n in ("f_stop", "aperture_diameter", "t_stop") if getattr(camera, n) is not None]
    if len(stops) > 1:
        raise UsageError(f"camera: wanted either {stops[0]} or {stops[1]}, got both")
    if camera.t_stop is not None and model == "pinhole":
        raise UsageError("camera: a pinhole has no t_stop")
    if camera.focus_by not in ("paraxial", "best"):
        raise UsageError(f"camera: focus_by: wanted paraxial or best, got {camera.focus_by!r}")
    if camera.focus_from not in ("pupil", "sensor"):
        raise UsageError(f"camera: focus_from: wanted pupil or sensor, got {camera.focus_from!r}")
    if model in TRACED and camera.aperture_image is not None and camera.shutter_type == "leaf":
        raise UsageError(
            "camera: shutter_type leaf: the iris of an exact lens wanted blades, "
            "got an aperture_image"
        )
    if camera.blades and camera.aperture_image is not None:
        raise UsageError("camera: wanted either blades or aperture_image, got both")
    if model in (*TRACED, "thick") and camera.natural_vignetting:
        raise UsageError(f"camera: natural_vignetting: the {model} lens has its own vignetting")


def _check_fit(camera: Camera, model: str) -> None:
    for name in ("degree", "fit_tolerance"):
        if getattr(camera, name) is not None and model != "polynomial":
            raise UsageError(f"camera: {name}: wanted lens_model polynomial with it, got {model}")
    if camera.degree is not None:
        wanted = "an odd number from 1 to 13"
        if whole(camera.degree, "camera: degree", 1, 13, wanted) % 2 == 0:
            raise UsageError(f"camera: degree: wanted {wanted}, got {camera.degree}")
    if camera.fit_tolerance is not None:
        number(camera.fit_tolerance, "camera: fit_tolerance", above=0)


def _positive(name: str, value: Any, hint: str = "", *, infinite: bool = False) -> None:
    low, high = LIMITS.get(name, (0.0, math.inf))
    where = f"camera: {name}"
    try:
        number(value, where, above=0, infinite=infinite)
        number(value, where, low, high, infinite=infinite)
    except UsageError as error:
        raise UsageError(f"{error}{hint}") from None
