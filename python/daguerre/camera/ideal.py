"""Kinds of ideal lenses: one row each, from which names, checks and set-up are made.

The chief rays of an ideal lens pass through its centre undeviated, so its pictures have no
distortion. ``CONTRIBUTING.md`` says how to add a kind.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import daguerre._core as _core


@dataclass(frozen=True)
class IdealLens:
    """Resolved parameters of an ideal lens.

    Attributes:
        pose: World from camera.
        film_distance_mm: Distance from the lens to the film, along the camera's axis.
        aperture_radius_mm: Radius of the iris.
        focus_distance_m: Distance from the lens to the plane of focus, along its axis; may be inf.
        iris: Shape of the iris.
        natural_vignetting: Whether light falls off by cos^4 of the field angle.
        tilt_deg: Tilt of the lens, right and up.
    """

    pose: _core.Motion
    film_distance_mm: float
    aperture_radius_mm: float
    focus_distance_m: float
    iris: _core.Iris
    natural_vignetting: bool
    tilt_deg: tuple[float, float]


@dataclass(frozen=True)
class IdealKind:
    """A kind of ideal lens.

    Attributes:
        has_iris: Whether it has an f-stop and a focus; without, everything is sharp.
        make: Function that makes the core's camera.
    """

    has_iris: bool
    make: Callable[[IdealLens], _core.Camera]


def _thin(lens: IdealLens) -> _core.Camera:
    return _core.Camera.thin(
        lens.pose,
        lens.film_distance_mm,
        lens.aperture_radius_mm,
        lens.focus_distance_m,
        lens.iris,
        lens.natural_vignetting,
        lens.tilt_deg,
    )


def _pinhole(lens: IdealLens) -> _core.Camera:
    return _core.Camera.pinhole(lens.pose, lens.film_distance_mm, lens.natural_vignetting)


#: By name, the default first.
IDEAL = {
    "thin": IdealKind(has_iris=True, make=_thin),
    "pinhole": IdealKind(has_iris=False, make=_pinhole),
}
WITH_IRIS = tuple(name for name, kind in IDEAL.items() if kind.has_iris)
WITHOUT_IRIS = tuple(name for name in IDEAL if name not in WITH_IRIS)
