"""Concave polygons as triangles: ear clipping, for many polygons at once.

An ear is a convex corner that forms a triangle with its neighbors without other corners inside.
Source: Meisters 1975, American Mathematical Monthly 82, 648: every simple polygon has an ear.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
#: Maximum number of comparisons of a corner with a triangle, about 10 s; and the fixed cost of a
#: step, in comparisons.
MAX_WORK, _STEP = 1 << 27, 5000


class Effort:
    """Limits the cost of ear clipping, so that a small file does not take hours."""

    def __init__(self) -> None:
        self._spent = 0

    def spend(self, comparisons: int) -> None:
        """Counts a step.

        Raises:
            InputError: The sum exceeds ``MAX_WORK``.
        """
        self._spent += comparisons + _STEP
        if self._spent > MAX_WORK:
            raise InputError(
                "polygons: concave polygons have too many corners in all: divide "
                "them into triangles"
            )


def plane_of(near: FloatArray) -> FloatArray:
    """Projects polygons (B, n, 3) onto the coordinate plane of largest area, shape (B, n, 2).

    The area is positive: Newell's normal points to the viewer.
    """
    centered = near - near.mean(axis=1, keepdims=True)
    normal = np.cross(centered, np.roll(centered, -1, axis=1)).sum(axis=1)
    axis = np.abs(normal).argmax(axis=1)
    rows = np.arange(len(near))
    sides = np.stack([(axis + 1) % 3, (axis + 2) % 3], axis=1)
    flat = np.take_along_axis(centered, np.broadcast_to(sides[:, None], (*near.shape[:2], 2)), 2)
    flat[normal[rows, axis] < 0, :, 0] *= -1
    return flat


def clipped(flat: FloatArray, effort: Effort) -> IntArray:
    """Triangles of polygons (B, n, 2) of positive area: corners 0 .. n - 1, shape (B, n - 2, 3).

    Raises:
        InputError: It takes too long.
    """
    count, size = flat.shape[:2]
    state = _Rings(flat)
    found = np.zeros((count, size - 2, 3), np.int64)
    done = np.zeros(count, np.int64)
    active = np.arange(count)
    while len(active):
        effort.spend(len(active) * size)
        three, ear = state.step(active)
        ready = active[ear]
        found[ready, done[ready]] = three[ear]
        done[ready] += 1
        active = active[done[active] < size - 2]
    return found


class _Rings:
    """Remaining corners of polygons, and the current corner of each."""

    def __init__(self, flat: FloatArray) -> None:
        count, size = flat.shape[:2]
        self._flat = flat
        self._after = np.tile((np.arange(size) + 1) % size, (count, 1))
        self._before = np.tile((np.arange(size) - 1) % size, (count, 1))
        self._left = np.ones((count, size), bool)
        self._now = np.zeros(count, np.int64)
        self._tried = np.zeros(count, np.int64)

    def step(self, rows: IntArray) -> tuple[IntArray, BoolArray]:
        """Clips the current corners that are ears, and moves on to the next corners.

        Returns:
            Corners with their neighbors, shape (A, 3), and whether they were clipped, shape (A,).
        """
        now = self._now[rows]
        three = np.stack([self._before[rows, now], now, self._after[rows, now]], axis=1)
        # A polygon that crosses itself may have no ear: then any corner is clipped.
        ear = self._are_ears(rows, three) | (self._tried[rows] > self._left[rows].sum(axis=1))
        taken, (one, gone, other) = rows[ear], three[ear].T
        self._after[taken, one], self._before[taken, other] = other, one
        self._left[taken, gone] = False
        self._tried[rows] = np.where(ear, 0, self._tried[rows] + 1)
        # After an ear the corner behind its neighbor is next, which keeps triangles wide.
        self._now[rows] = np.where(ear, self._after[rows, three[:, 2]], three[:, 2])
        return three, ear

    def _are_ears(self, rows: IntArray, three: IntArray) -> BoolArray:
        points = self._flat[rows]
        a, b, c = (points[np.arange(len(rows)), three[:, k]][:, None] for k in range(3))
        inside = self._left[rows].copy()
        for one, other in ((a, b), (b, c), (c, a)):
            inside &= _left_of(one, other, points) >= 0
        for corner in (a, b, c):  # also corners at the same point, as at the ends of a slit
            inside &= (points != corner).any(axis=2)
        return np.asarray((_left_of(a, b, c)[:, 0] > 0) & ~inside.any(axis=1))


def _left_of(one: FloatArray, other: FloatArray, points: FloatArray) -> FloatArray:
    """Twice the signed area of triangles; positive if the points are left of the line."""
    line, ray = other - one, points - one
    return np.asarray(line[..., 0] * ray[..., 1] - line[..., 1] * ray[..., 0])
