"""Vertices far from the origin of their mesh, which single precision would move.

32-bit numbers are 2 mm apart at 16,384 m, and 0.5 m at 5,000,000 m. So a mesh that comes with
doubles that far away keeps the difference to an origin of its own (:attr:`.parts.Mesh.origin`).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .limits import MAX_SIZE

#: Distance between origins on each axis, m.
CELL_M = 1024.0
#: Distance from which vertices have another origin, m.
FAR_M = 16384.0

Place = tuple[float, float, float]
_Axes = NDArray[np.float64]
Keeps = Callable[[_Axes, _Axes, _Axes], NDArray[np.bool_]]
ZERO: Place = (0.0, 0.0, 0.0)


def origin_near(position: Any) -> Place:
    """Origin near a position, m: a multiple of 1024 m on each axis, and 0 within 512 m of 0."""
    x, y, z = (CELL_M * np.rint(np.asarray(position, np.float64) / CELL_M) + 0.0).tolist()
    return x, y, z


def recentered(positions: Any) -> tuple[Any, Place]:
    """Moves doubles that are far from 0 to an origin of their own.

    Args:
        positions: Positions as given.

    Returns:
        The positions relative to the origin, and the origin; the positions as they are, and 0, if
        they are not of shape (N, 3), single or near.
    """
    given = positions if isinstance(positions, np.ndarray | list | tuple) else None
    try:
        rows = None if given is None else np.asarray(given)
    except (TypeError, ValueError, OverflowError):
        rows = None  # the mesh says what is wrong
    if rows is None or rows.dtype != np.float64 or rows.shape[1:] != (3,) or not len(rows):
        return positions, ZERO
    if not np.abs(rows[0]).max() >= FAR_M / 2 or not (np.abs(rows) < MAX_SIZE).all():
        return positions, ZERO  # near, or wrong
    origin = _far(rows)
    return (rows - origin, origin) if any(origin) else (positions, ZERO)


def single_if_near(positions: NDArray[np.floating]) -> NDArray[np.floating]:
    """Positions in single precision, unless :func:`recentered` moves them."""
    if any(recentered(positions)[1]):
        return positions
    with np.errstate(over="ignore"):
        return np.asarray(positions, np.float32)


def _far(rows: NDArray[np.float64]) -> Place:
    """Origin near rows on the axes on which all are far."""
    return origin_where(rows, lambda nearest, farthest, middle: nearest >= FAR_M)


def origin_where(rows: NDArray[np.floating], keeps: Keeps) -> Place:
    """Origin near the middle of rows on the axes on which all are on one side of 0.

    Args:
        rows: Positions, shape (N, 3).
        keeps: Further condition of an axis, by the smallest and the largest distance of rows from
            0, and the distance of the origin, each of shape (3,).
    """
    low, high = (np.asarray(end, np.float64) for end in (rows.min(axis=0), rows.max(axis=0)))
    middle = np.asarray(origin_near(0.5 * (low + high)))
    nearest, farthest = np.minimum(abs(low), abs(high)), np.maximum(abs(low), abs(high))
    fits = (low * high > 0) & keeps(nearest, farthest, abs(middle))
    x, y, z = np.where(fits, middle, 0.0).tolist()
    return x, y, z
