"""Groups of surfaces that are shifted and tilted as one: the place of each surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .surface import LensSurface, Triple


@dataclass(frozen=True)
class Group:
    """Surfaces ``first`` to ``last`` (indices, both included), moved as a rigid body.

    Attributes:
        first: Index of the first surface.
        last: Index of the last surface.
        decenter: Shift, mm, after the turn.
        tilt: Degrees about x, then the turned y, then the turned z.
        pivot_mm: The point on the axis that the turn leaves alone, from the first one's vertex.
    """

    first: int
    last: int
    decenter: Triple = (0.0, 0.0, 0.0)
    tilt: Triple = (0.0, 0.0, 0.0)
    pivot_mm: float = 0.0


def placed(surfaces: Sequence[LensSurface], group: Group) -> list[LensSurface]:
    """The surfaces with those of the group where its shift and tilt put them."""
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
    """Matrix (3, 3) of turns about x, then the turned y, then the turned z, in degrees."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return np.asarray(about_x @ about_y @ about_z)


def angles(matrix: NDArray[np.float64]) -> Triple:
    """The turns that make the matrix, in degrees."""
    x = np.arctan2(-matrix[1, 2], matrix[2, 2])
    y = np.arctan2(matrix[0, 2], np.hypot(matrix[1, 2], matrix[2, 2]))
    z = np.arctan2(-matrix[0, 1], matrix[0, 0])
    return _triple(np.degrees([x, y, z]))


def _triple(values: NDArray[np.float64]) -> Triple:
    x, y, z = (float(v) for v in values)
    return (x, y, z)
