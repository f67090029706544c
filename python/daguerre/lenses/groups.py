"""Shifts and tilts groups of surfaces as rigid bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import LensSurface, Triple


@dataclass(frozen=True)
class Group:
    """Surfaces ``first`` to ``last``, inclusive, that move as a rigid body.

    Attributes:
        first: Index of the first surface.
        last: Index of the last surface.
        decenter: Shift after the tilt, mm.
        tilt: Rotations about x, then the turned y, then the turned z, degrees.
        pivot_mm: Pivot of the tilt on the axis, from the vertex of the first surface, mm.
    """

    first: int
    last: int
    decenter: Triple = (0.0, 0.0, 0.0)
    tilt: Triple = (0.0, 0.0, 0.0)
    pivot_mm: float = 0.0


def placed(surfaces: Sequence[LensSurface], group: Group) -> list[LensSurface]:
    """Returns all surfaces, with the group shifted and tilted."""
    out = list(surfaces)
    turn = rotation(group.tilt)
    z = np.cumsum([0.0, *(s.thickness or 0.0 for s in surfaces[:-1])])
    pivot = np.array([0, 0, z[group.first] + group.pivot_mm])
    for i in range(group.first, group.last + 1):
        vertex = np.array([0, 0, z[i]])
        point = vertex + surfaces[i].decenter
        moved = pivot + turn @ (point - pivot) + group.decenter - vertex
        tilt = angles(turn @ rotation(surfaces[i].tilt))
        out[i] = surfaces[i].replaced(decenter=_triple(moved), tilt=tilt)
    return out


def rotation(tilt: Triple) -> NDArray[np.float64]:
    """Rotation matrix (3, 3) for angles about x, then the turned y, then the turned z, degrees."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return np.asarray(about_x @ about_y @ about_z)


def angles(matrix: NDArray[np.float64]) -> Triple:
    """Angles of a rotation matrix, degrees; the inverse of ``rotation``."""
    x = np.arctan2(-matrix[1, 2], matrix[2, 2])
    y = np.arctan2(matrix[0, 2], np.hypot(matrix[1, 2], matrix[2, 2]))
    z = np.arctan2(-matrix[0, 1], matrix[0, 0])
    return _triple(np.degrees([x, y, z]))


def _triple(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(v) for v in values)
    return (x, y, z)
