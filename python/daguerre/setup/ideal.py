"""Set-up of a camera without glass: a calibrated projection, or an ideal lens.

Lengths are in mm unless the name says otherwise. Focus distances are in m.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera
from daguerre.camera.ideal import IDEAL, IdealLens
from daguerre.camera.parameters import CAMERA
from daguerre.camera.projection import Projection
from daguerre.errors import InputError, UsageError

from . import tilt
from .focus import Sharp, SharpAt, ideal_direction
from .framing import Framing
from .iris import iris_of
from .resolved import ResolvedLens

DEFAULT_FOCAL_LENGTH: float = CAMERA["focal_length"].usual
DEFAULT_F_STOP: float = CAMERA["f_stop"].usual


def set_up(framing: Framing, model: str) -> ResolvedLens:
    """Makes the camera of a model that needs no prescription.

    Raises:
        UsageError: Autofocus on a pixel outside of the frame, or where a projection sees nothing.
        InputError: The lens cannot focus so near.
    """
    if framing.camera.projection is not None:
        return _projection(framing, framing.camera.projection)
    if IDEAL[model].has_iris:
        return _with_iris(framing, model)
    return _all_sharp(framing, model)


def _projection(framing: Framing, projection: Projection) -> ResolvedLens:
    camera, focus = framing.camera, framing.focus
    film = projection.film(framing.frame_mm[0])
    focal = math.sqrt(film["focal_mm"][0] * film["focal_mm"][1])
    radius = 0.0 if camera.f_stop is None else focal / camera.f_stop / 2

    def direction(x: float, y: float) -> NDArray[np.float64]:
        (fx, fy), (cx, cy) = film["focal_mm"], film["principal_mm"]
        seen = projection.core.unproject(np.array([[(x - cx) / fx, (cy - y) / fy]]))[0]
        if not np.isfinite(seen).all():
            raise UsageError(
                "camera: focus_at: wanted a pixel that the projection covers; no light reaches "
                "this one"
            )
        return np.asarray(seen * (1, -1, -1))

    if projection.is_wide:  # the surface of focus is a sphere
        focus = replace(focus, sharp_at=lambda point: float(np.linalg.norm(point)))
    sharp = focus.distance(direction) if radius > 0 else Sharp(math.inf)
    core = _core.Camera.projection(
        framing.pose,
        projection.core,
        film["focal_mm"],
        film["principal_mm"],
        radius,
        sharp.distance_m,
        iris_of(camera),
    )
    return ResolvedLens(
        core=core,
        model="projection",
        name="projection",
        focal_length_mm=focal,
        pinhole_focal_length_mm=focal,
        f_stop=camera.f_stop if radius > 0 else None,
        aperture_diameter_mm=2 * radius if radius > 0 else None,
        focus_distance_m=sharp.distance_m if radius > 0 else None,
        projection=projection,
        notes=sharp.notes,
    )


def _all_sharp(framing: Framing, model: str) -> ResolvedLens:
    f = framing.camera.focal_length or DEFAULT_FOCAL_LENGTH
    core = core_of(framing, model, f, 0.0, math.inf)
    return ResolvedLens(core, model, model, focal_length_mm=f, pinhole_focal_length_mm=f)


def core_of(
    framing: Framing, model: str, film_mm: float, radius_mm: float, focus_m: float
) -> _core.Camera:
    """Makes the core's camera of an ideal kind of lens, with iris and tilt of the camera."""
    camera, kind = framing.camera, IDEAL[model]
    lens = IdealLens(
        framing.pose,
        film_mm,
        radius_mm,
        focus_m,
        iris_of(camera) if kind.has_iris else _core.Iris(),
        camera.natural_vignetting,
        camera.tilt,
    )
    return kind.make(lens)


def _with_iris(framing: Framing, model: str) -> ResolvedLens:
    camera, focus = framing.camera, framing.focus
    f = camera.focal_length or DEFAULT_FOCAL_LENGTH
    f_stop = camera.f_stop or camera.t_stop  # without glass they are the same
    diameter = camera.aperture_diameter or f / (f_stop or DEFAULT_F_STOP)
    if any(camera.tilt):
        focus = replace(focus, sharp_at=_sharp_when_tilted(camera, f))
    sharp = focus.settled(lambda s: ideal_direction(_film_distance(camera, f, s)))
    distance = sharp.distance_m
    if camera.focus_from == "sensor" and camera.focus_distance is not None:
        distance = _from_pupil(distance, f)
    film = _film_distance(camera, f, distance)
    return ResolvedLens(
        core=core_of(framing, model, film, diameter / 2, distance),
        model=model,
        name=model,
        focal_length_mm=f,
        pinhole_focal_length_mm=film,
        f_stop=f / diameter,
        aperture_diameter_mm=diameter,
        focus_distance_m=distance,
        notes=sharp.notes,
    )


def _film_distance(camera: Camera, f: float, distance: float) -> float:
    """Film distance of the pinhole with the same framing, along the camera's axis, mm."""
    if not camera.focus_breathing:
        return f
    if not distance * 1e3 > f:
        raise InputError(
            f"camera: focus_distance: wanted more than {f * 1e-3:g} m for a {f:g} mm lens, "
            f"got {distance:g} m"
        )
    film = f if math.isinf(distance) else f * distance * 1e3 / (distance * 1e3 - f)
    return film * tilt.cosine(camera.tilt)  # where the lens's axis meets it


def _sharp_when_tilted(camera: Camera, f: float) -> SharpAt:
    if camera.focus_breathing:
        return lambda point: tilt.focus_on(tilt.CardinalPoints.thin(f), camera.tilt, point)
    return lambda point: tilt.focus_still(f, camera.tilt, point)


def _from_pupil(total_m: float, f: float) -> float:
    """Object distance (m) of a thin lens at a given distance from object to film.

    Source: Kolb 1995, section 3.2: s + s' = T and s s' = f T.
    """
    if math.isinf(total_m):
        return total_m
    total = total_m * 1e3
    if total < 4 * f:
        raise InputError(
            f"camera: focus_distance from the sensor: a {f:g} mm lens focuses no nearer than "
            f"{4e-3 * f:g} m, got {total_m:g} m"
        )
    image = (total - math.sqrt(total * (total - 4 * f))) / 2
    return (total - image) * 1e-3
