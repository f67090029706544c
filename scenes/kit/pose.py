"""Where things stand and where they look: quaternions (x, y, z, w) of glTF nodes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

Point = Sequence[float]


def turn_y(degrees: float) -> list[float]:
    """Quaternion (x, y, z, w) of a turn about the vertical."""
    half = math.radians(degrees) / 2
    return [0, math.sin(half), 0, math.cos(half)]


def look(eye: Point, target: Point) -> list[float]:
    """Quaternion of a node at `eye` whose -z axis points at `target`, upright."""
    back = np.subtract(eye, target) / np.linalg.norm(np.subtract(eye, target))
    right = np.cross((0, 1, 0), back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    w = math.sqrt(max(0.0, 1 + right[0] + up[1] + back[2])) / 2
    q = [up[2] - back[1], back[0] - right[2], right[1] - up[0]]
    return [float(x) / (4 * w) for x in q] + [w]
