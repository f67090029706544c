"""Finds time samples between which USD interpolates a value as closely as single precision shows.

USD interpolates numbers linearly and rotations along the shortest arc. A value that Daguerre
interpolates alike needs samples at its keys only; other values get more where they curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError
from daguerre.motion.values import MAX_TIME, Dynamic, Spin

#: Error of an interpolated value that is worth another sample, relative to values above 1.
_WORTH = 1e-6
#: Halvings of the time between two breaks.
_DEEPEST = 12
#: Time samples of a value.
_MOST = 50_000

#: Error of linear interpolation: from two values to a value in their middle.
Miss = Callable[[Any, Any, Any], float]


def sample_times(value: Dynamic, span: tuple[float, float] | None, miss: Miss) -> list[float]:
    """Times at which a value over time needs samples, rising, s.

    A value that jumps has two samples there, the first just before the jump.

    Args:
        value: The value.
        span: Begin and end, s; None: the first and last key.
        miss: Error of linear interpolation in the middle of an interval.

    Raises:
        UsageError: The value has no end, and no span was given; or it needs too many samples.
    """
    begin, end = span or _extent(value)
    breaks = [float(t) for t in value.breaks(begin, end)]
    edges = [begin, *breaks, end] if end > begin else [begin]
    times = edges[:1]
    for a, b in pairwise(edges):
        before = math.nextafter(b, -math.inf)
        jumps = miss(value.at(before), value.at(b), value.at(b)) > _WORTH
        last = before if jumps else b
        times += _between(value, a, last, miss, _DEEPEST)
        times += [last, b] if jumps else [b]
        if len(times) > _MOST:
            raise UsageError(f"camera: motion: too many time samples: the limit is {_MOST}")
    return times


def _between(value: Dynamic, a: float, b: float, miss: Miss, depth: int) -> list[float]:
    middle = 0.5 * (a + b)
    quarters = [a + share * (b - a) for share in (0.25, 0.75)]
    first, last = value.at(a), value.at(b)
    is_linear = miss(first, value.at(middle), last) <= _WORTH and all(
        miss(p, value.at(t), q) <= _WORTH
        for p, t, q in zip(
            (first, value.at(middle)), quarters, (value.at(middle), last), strict=True
        )
    )
    if is_linear or depth == 0 or not a < middle < b:
        return []
    left, right = (
        _between(value, a, middle, miss, depth - 1),
        _between(value, middle, b, miss, depth - 1),
    )
    return [*left, middle, *right]


def _extent(value: Dynamic) -> tuple[float, float]:
    """First and last break of a value, s."""
    times = value.breaks(-MAX_TIME, MAX_TIME)
    if isinstance(value, Spin) or not len(times):
        raise UsageError("camera: motion: it has no end; set times=(begin, end), s")
    return float(times[0]), float(times[-1])


def miss_of_numbers(a: object, middle: object, b: object) -> float:
    """Relative error of the mean of two numbers, or tuples of such."""
    first, true, last = (np.asarray(v, np.float64) for v in (a, middle, b))
    error = np.abs(0.5 * (first + last) - true) / np.maximum(1, np.abs(true))
    return float(error.max(initial=0.0))


def miss_of_poses(
    a: NDArray[np.float64], middle: NDArray[np.float64], b: NDArray[np.float64]
) -> float:
    """Error of a pose halfway between two others: m, and radians."""
    (place_a, turn_a), (place, turn), (place_b, turn_b) = (pose(m) for m in (a, middle, b))
    half = turn_a + (turn_b if np.dot(turn_a, turn_b) >= 0 else -turn_b)
    length = np.linalg.norm(half)
    if length < 1e-9:  # half a turn: any way leads there
        return math.inf
    angle = 2 * math.acos(min(1.0, abs(float(np.dot(half / length, turn)))))
    far = float(np.abs(0.5 * (place_a + place_b) - place).max()) / max(
        1.0, float(np.abs(place).max())
    )
    return max(angle, far)


def pose(world: Sequence[Any] | NDArray[np.float64]) -> tuple[Any, Any]:
    """Position, and rotation as a quaternion (x, y, z, w), of a rigid transform (4, 4)."""
    m = np.asarray(world, np.float64)
    r = m[:3, :3]
    # The largest divisor chooses among four formulas for the quaternion (Shepperd 1978).
    four = np.array([r[0, 0] - r[1, 1] - r[2, 2], r[1, 1] - r[0, 0] - r[2, 2],
                     r[2, 2] - r[0, 0] - r[1, 1], r[0, 0] + r[1, 1] + r[2, 2]])  # fmt: skip
    i = int(np.argmax(four))
    q = np.empty(4)
    q[i] = 1 + four[i]
    if i == 3:
        q[:3] = r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]
    else:
        j, k = (i + 1) % 3, (i + 2) % 3
        q[j], q[k], q[3] = r[j, i] + r[i, j], r[k, i] + r[i, k], r[k, j] - r[j, k]
    return m[:3, 3], q / np.linalg.norm(q)
