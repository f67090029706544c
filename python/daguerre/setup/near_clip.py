"""The near clipping plane of a camera, and the sphere that replaces it before wide lenses."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.camera.camera import Camera

#: Angle from the axis beyond which no rectilinear lens sees, degrees: there a plane would clip
#: almost everything.
ASIDE = 80.0
#: Places on the film where a lens is asked how far it sees, as shares of half the frame.
_SHARES = [(i + 1) / 8 for i in range(8)]
_SIDES = [(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1) if x or y]
_AHEAD = np.array([0.0, 0.0, -1.0])
#: Finite distance used for infinity, m; within the range of the ray tracer.
_NEVER = 1e18

#: Function from a film point (mm, upright) to its unit view direction in the camera's frame.
Directions = Callable[[float, float], NDArray[np.float64]]


def set_near_clip(core: _core.Camera, camera: Camera, frame_mm: tuple[float, float]) -> None:
    """Sets the near clipping of the core's camera.

    Args:
        core: Camera of the core, with its lens.
        camera: The camera.
        frame_mm: Width and height of the picture on the film.
    """
    if camera.near_clip:
        core.clip_near(camera.near_clip, is_round(camera, directions_of(core), frame_mm))


def directions_of(core: _core.Camera) -> Directions:
    """View directions of film points of the core's camera; along the axis for dark points."""
    chief = core.chief_rays()

    def direction(x: float, y: float) -> NDArray[np.float64]:
        film = np.array([[x, y]], np.float64)
        lit = bool(chief.sees(core, film)[0])
        return np.asarray(chief.rays(film)[1][0] if lit else _AHEAD)

    return direction


def is_round(camera: Camera, direction_of: Directions, frame_mm: tuple[float, float]) -> bool:
    """Whether a sphere bounds the clipped space, because the lens sees to the side.

    Args:
        camera: The camera.
        direction_of: View directions of film points.
        frame_mm: Width and height of the picture on the film.
    """
    if camera.projection is not None:
        return camera.projection.is_wide
    least = math.cos(math.radians(ASIDE))
    (width, height), (right, up) = frame_mm, camera.shift
    places = (
        (right + 0.5 * share * x * width, up + 0.5 * share * y * height)
        for share in _SHARES
        for x, y in _SIDES
    )
    return any(-float(direction_of(*place)[2]) < least for place in places)


def view_begins(
    camera: Camera,
    direction_of: Directions,
    frame_mm: tuple[float, float],
    direction: NDArray[np.float64],
) -> float:
    """Distance from the pupil at which a view direction leaves the clipped space, m.

    Args: as of :func:`is_round`, and the unit direction in the camera's frame.
    """
    if not camera.near_clip:
        return 0.0
    if is_round(camera, direction_of, frame_mm):
        return float(camera.near_clip)
    ahead = -float(direction[2])
    return min(camera.near_clip / ahead, _NEVER) if ahead > 0 else _NEVER
