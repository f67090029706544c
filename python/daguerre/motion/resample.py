"""Resamples values over time to keys over one interval, which the core interpolates.

Each function states its error bound: for numbers, transforms, vertices. A jump becomes two keys at
the same time. A single key means that nothing changes in the interval.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.checks import given_matrix

from .flat_values import Flat, changes, flat
from .subdivision import MAX_BREAKS, MAX_KEYS, Check, Subdivision, some_breaks
from .values import Dynamic

FloatArray = NDArray[np.float64]
#: Error bound relative to the change of a number, or to the radius of a mesh.
BOUND = 1e-4
#: Error bound relative to the length of a path: 0.05 px for a path across 2500 px.
PATH_BOUND = 2e-5
#: Change relative to size, below which a value has only changed by rounding.
_STILL = 1e-12


def resample(dynamic: Dynamic, open_s: float, close_s: float) -> tuple[list[float], list[Any]]:
    """Resamples numbers, tuples, materials, lights, ... to keys with linear interpolation.

    The error of each number is at most ``BOUND`` of the change of its tuple in the interval.

    Args:
        dynamic: The value.
        open_s: Begin of the interval, s.
        close_s: End of the interval, s.

    Returns:
        Times in rising order (equal at jumps), s, and the values at them.
    """
    subdivision = Subdivision(dynamic, flat, open_s, close_s)
    first = subdivision.first()
    limits = changes(first)
    if all(_near(v, first[0], first[0], 0.0, 1e-8 * limits) for v in first):
        return [open_s], [first[0].value]

    def fits(checks: list[Check[Flat]]) -> list[bool]:
        return [_near(value, a, b, s, BOUND * limits) for a, b, s, value in checks]

    keys = subdivision.keys(fits)
    times, values = [keys[0][0]], [keys[0][1].value]
    for (_, a), (time, b) in itertools.pairwise(keys):
        if a.rest != b.rest and times[-1] != time:  # names change in steps
            times.append(time)
            values.append(a.value)
        times.append(time)
        values.append(b.value)
    return times, values


def _near(value: Flat, a: Flat, b: Flat, s: float, limits: FloatArray) -> bool:
    if not value.rest == a.rest == b.rest or len(limits) != len(value.numbers):
        return False  # a part has been added or removed
    gap = np.abs(value.numbers - ((1 - s) * a.numbers + s * b.numbers))
    return bool((gap <= limits).all())


def resample_transform(
    dynamic: Dynamic,
    open_s: float,
    close_s: float,
    corners: FloatArray,
    most_breaks: int = MAX_BREAKS,
    where: str = "motion",
) -> _core.Motion:
    """Resamples a transform to keys with decomposed interpolation.

    No corner is off by more than ``BOUND`` of the radius of the object, or ``PATH_BOUND`` of the
    length of its path if that is more.

    Args:
        dynamic: World from local, (4, 4).
        open_s: Begin of the interval, s.
        close_s: End of the interval, s.
        corners: Corners of the object's bounding box, shape (8, 3), m.
        most_breaks: Maximum number of breaks to look at.
        where: Owner of the transform, for messages.
    """
    points = np.concatenate([corners, np.ones((len(corners), 1))], axis=1).T
    subdivision = Subdivision(
        dynamic, lambda m: given_matrix(m, where), open_s, close_s, most_breaks
    )
    first = np.stack(subdivision.first())
    if (np.abs(first - first[0]) <= _STILL * np.abs(first).max()).all():
        return _core.Motion.still(first[0])
    placed = (first @ points)[:, :3]
    middles = placed.mean(axis=2)
    radius = float(np.linalg.norm(placed - middles[:, :, None], axis=1).max())
    way = float(np.linalg.norm(np.ptp(middles, axis=0)))
    limit = max(BOUND * radius, PATH_BOUND * way)

    def fits(checks: list[Check[FloatArray]]) -> list[bool]:
        if not checks:
            return []
        # Pairs of keys in one row; times between pairs are not evaluated.
        pairs = np.array([key for a, b, _, _ in checks for key in (a, b)])
        row = _core.Motion.keys(np.arange(float(len(pairs))), pairs)
        between = row.many(2.0 * np.arange(len(checks)) + [s for _, _, s, _ in checks])
        gaps = (np.array([value for *_, value in checks]) - between)[:, :3] @ points
        near = (gaps * gaps).sum(axis=1).max(axis=1) <= limit * limit
        return [bool(one) for one in near]

    keys = subdivision.keys(fits)
    return _core.Motion.keys(np.array([t for t, _ in keys]), np.stack([m for _, m in keys]))


def resample_shown(dynamic: Dynamic, open_s: float, close_s: float) -> list[tuple[float, float]]:
    """Intervals (begin, end), s, in which a flag is true; it changes only at breaks."""
    if open_s == close_s:
        return [(open_s, close_s)] if dynamic.at(open_s) else []
    times = [open_s, *some_breaks(dynamic, open_s, close_s, MAX_KEYS), close_s]
    found: list[tuple[float, float]] = []
    for begin, end in itertools.pairwise(times):
        if dynamic.at(0.5 * (begin + end)):
            joins = found and found[-1][1] == begin
            found.append((found.pop()[0] if joins else begin, end))
    return found
