"""Moves: tracks of a glTF animation, from the words in which a motion is thought of."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.exporters.gltf import Track
from kit.pose import Point, look

WIDEST_DEG = 100.0  # between two keys; from 180 degrees on, the shorter way is another


def turn(axis: Point, degrees: float) -> NDArray[np.float64]:
    """Quaternion (x, y, z, w) of a turn about an axis of any length."""
    half = math.radians(degrees) / 2
    unit = np.asarray(axis, float) / np.linalg.norm(axis)
    return np.append(math.sin(half) * unit, math.cos(half))


def after(second: ArrayLike, first: ArrayLike) -> NDArray[np.float64]:
    """Quaternion of two turns, the one after the other."""
    a, b = np.asarray(second, float), np.asarray(first, float)
    vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])


def going(node: int, times: Sequence[float], places: Sequence[Point]) -> Track:
    """A node that is at each place at its time, s, and goes straight between them."""
    return Track({"node": node, "path": "translation"}, times, np.asarray(places, float))


def spinning(
    node: int, axis: Point, revolutions_per_second: float, end_s: float, start_deg: float = 0
) -> Track:
    """A node that turns evenly about an axis through its origin, from 0 s to `end_s`."""
    whole = 360 * revolutions_per_second * end_s
    count = max(1, math.ceil(abs(whole) / WIDEST_DEG))
    angles = start_deg + np.linspace(0, whole, count + 1)
    keys = [turn(axis, a) for a in angles]
    return Track({"node": node, "path": "rotation"}, np.linspace(0, end_s, count + 1), keys)


def swinging(
    node: int, axis: Point, reach_deg: float, period_s: float, start: float = 0.0
) -> Track:
    """A pendulum for one period: all to one side at `start`, a fraction of the period."""
    times = np.linspace(0, period_s, 49)
    angles = reach_deg * np.cos(2 * math.pi * (times / period_s - start))
    return Track({"node": node, "path": "rotation"}, times, [turn(axis, a) for a in angles])


def rolling(
    node: int,
    times: Sequence[float],
    places: Sequence[Point],
    radius: float,
    pose: ArrayLike,
    posed: int = 0,
) -> list[Track]:
    """A ball that rolls without slipping along straight ways on the level.

    Args:
        node: The ball's.
        times: s.
        places: Places of its centre, one per time, m.
        radius: m.
        pose: Quaternion that it has at the time of number `posed`.
        posed: Index into `times`.
    """
    points = np.asarray(places, float)
    turned = np.array((0, 0, 0, 1.0))
    at, keys, corners = [times[0]], [turned], [turned]
    for k in range(1, len(points)):
        way = points[k] - points[k - 1]
        degrees = math.degrees(float(np.linalg.norm(way)) / radius)
        steps = max(1, math.ceil(degrees / WIDEST_DEG))
        for j in range(1, steps + 1):
            if degrees > 0:
                turned = after(turn(np.cross((0, 1, 0), way), degrees / steps), turned)
            at = [*at, times[k - 1] + (times[k] - times[k - 1]) * j / steps]
            keys = [*keys, turned]
        corners = [*corners, turned]
    start = after(corners[posed] * (-1, -1, -1, 1), pose)
    track = Track({"node": node, "path": "rotation"}, at, [after(q, start) for q in keys])
    return [going(node, times, points), track]


def following(node: int, eye: Point, times: Sequence[float], targets: Sequence[Point]) -> Track:
    """A camera that stays at `eye` and looks at each target at its time, s."""
    keys = [look(eye, target) for target in targets]
    return Track({"node": node, "path": "rotation"}, times, keys)
