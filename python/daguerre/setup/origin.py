"""Origin of a built scene: near its camera, as 32-bit positions lose precision far from it.

The core gets all positions relative to this origin, and results in the world get it back, both in
double precision. It is a multiple of 1024 m on each axis, so that scenes that differ by such a
shift have the same picture to the bit, and scenes near 0 stay as they are.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.camera.camera import Camera
from daguerre.camera.shutter import interval
from daguerre.errors import UsageError
from daguerre.scene.far import CELL_M, FAR_M, ZERO, Place, origin_near, origin_where
from daguerre.scene.limits import MAX_SIZE

from .pose import rigid

#: Distance between neighbouring numbers from which users hear of it, m.
COARSE_M = 0.01
#: Distance of a camera from 0 from which users hear of it, m.
BEYOND_M = 1e9


def origin_of(camera: Camera, time: float, resolution: tuple[int, int]) -> Place:
    """Origin near a camera at the middle of the exposure of its whole frame.

    Args:
        camera: The camera, settled.
        time: Time of the scene, s.
        resolution: Width and height of the picture, px.
    """
    begin, end = interval(camera, time, resolution)
    return origin_near(rigid(camera.frozen_at(0.5 * (begin + end)).transform)[:3, 3])


def given_origin(origin: Place) -> Place:
    """Checks an origin that is given.

    Raises:
        UsageError: It is too far from 0.
    """
    x, y, z = map(float, origin)
    if not max(abs(x), abs(y), abs(z)) < MAX_SIZE:
        raise UsageError(f"origin: wanted a point within {MAX_SIZE:g} m of 0, got {origin}")
    return x, y, z


def is_near(origin: Place, position: ArrayLike) -> bool:
    """Whether a position is within a cell of an origin, so that a moving camera may keep it."""
    away = np.abs(np.asarray(position, np.float64) - origin)
    return bool((away <= CELL_M).all())


def beyond(origin: Place) -> list[str]:
    """Sentence about an origin so far away that doubles are coarse there; empty: nearer."""
    far = max(map(abs, origin))
    if far < BEYOND_M:
        return []
    step = float(np.spacing(far))
    return [f"the camera is {far:.3g} m from 0, where 64-bit numbers are {step:.2g} m apart"]


def may_be_far(positions: NDArray[np.float32]) -> bool:
    """Whether a mesh may be far from its own origin, by its first vertex."""
    first = positions.reshape(-1, 3)[:1]
    return bool(len(first)) and bool(np.abs(first).max() > CELL_M / 4)


def coarse(place: Place, scale: float) -> str:
    """Sentence about vertices in single precision that far from their origin; empty: fine enough.

    Args:
        place: Point near the vertices, in units of the mesh's space.
        scale: Size of a unit, m.
    """
    far = max(map(abs, place))
    step = float(np.spacing(np.float32(far))) * scale
    if step < COARSE_M:
        return ""
    return (
        f"its vertices are {far * scale:.3g} m from its origin, where 32-bit numbers are "
        f"{step:.2g} m apart: finer details are lost in the file"
    )


def local_origin(positions: NDArray[np.float32], scale: float) -> Place:
    """Point near all vertices of a mesh that is far from its own origin; else 0.

    The differences of the vertices to it are exact in single precision.

    Args:
        positions: Vertices, shape (..., 3).
        scale: Largest size in the world of a unit of the mesh's space, m.
    """
    rows = positions.reshape(-1, 3)
    if not np.abs(rows[0]).max() * scale >= FAR_M:
        return ZERO
    # Differences are exact between the half and the double of a number (Sterbenz 1974).
    return origin_where(
        rows,
        lambda nearest, farthest, middle: (nearest >= 0.5 * middle) & (farthest <= 2 * middle),
    )
