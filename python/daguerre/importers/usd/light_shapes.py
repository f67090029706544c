"""Meshes of area lights: rectangle, disk and cylinder. They emit from their outer side.

Source: OpenUSD, documentation of UsdLuxRectLight, UsdLuxDiskLight and UsdLuxCylinderLight.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.shapes import SQUARE, ShapeMesh, revolved

Array = NDArray[np.float64]
_AROUND = 64


def rectangle(width: float, height: float) -> ShapeMesh | None:
    """A rectangle in the plane z = 0 that faces -z; None if it has no area.

    The top left of an image is at (+x, +y): it is upright for an observer whom it lights, who has
    +x on the left.
    """
    if not width * height > 0:
        return None
    corners = 0.5 * SQUARE
    positions = np.zeros((4, 3))
    positions[:, :2] = corners * (width, height)
    return ShapeMesh(positions, _facing(4), 0.5 - corners, np.array([(0, 2, 1), (0, 3, 2)]))


def disk(radius: float) -> ShapeMesh | None:
    """A disk in the plane z = 0 that faces -z, of a circle's area; None for a radius of 0."""
    if not radius > 0:
        return None
    angles = np.arange(_AROUND) * (2 * math.pi / _AROUND)
    # Facets cut off a part of the circle; this radius of their corners restores its area.
    step = 2 * math.pi / _AROUND
    outer = radius * math.sqrt(step / math.sin(step))
    rim = np.stack([outer * np.cos(angles), outer * np.sin(angles), 0 * angles], axis=1)
    positions = np.concatenate([np.zeros((1, 3)), rim])
    i = np.arange(_AROUND)
    triangles = np.stack([0 * i, 1 + (i + 1) % _AROUND, 1 + i], axis=1)
    uv = 0.5 - 0.5 * positions[:, :2] / radius
    return ShapeMesh(positions, _facing(len(positions)), uv, triangles)


def cylinder(length: float, radius: float) -> ShapeMesh | None:
    """The side of a cylinder along x, without ends; None if it has no area."""
    profile = np.array([(radius, -0.5 * length), (radius, 0.5 * length)])
    return revolved(profile, np.array([(1.0, 0.0), (1.0, 0.0)]), "X")


def area(positions: NDArray[Any], triangles: NDArray[Any], world: Array) -> float:
    """Area of a mesh in the scene, m2.

    Args:
        positions: Shape (N, 3), in mesh space.
        triangles: Shape (M, 3).
        world: Scene from mesh, shape (4, 4).
    """
    points = positions.astype(np.float64) @ world[:3, :3].T
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def _facing(count: int) -> Array:
    return np.tile((0.0, 0.0, -1.0), (count, 1))
