"""Meshes of area lamps in the plane z = 0: they face -z."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mesh = tuple[Array, NDArray[np.int64]]
_AROUND = 64


def rectangle(width: float, height: float) -> Mesh:
    """A rectangle: positions, shape (4, 3), and triangles, shape (2, 3)."""
    corners = np.array([(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)])
    return corners * (width, height, 1.0), np.array([(0, 2, 1), (0, 3, 2)])


def ellipse(width: float, height: float) -> Mesh:
    """An ellipse of these diameters, as a polygon of its area.

    Returns:
        Positions, shape (65, 3), and triangles, shape (64, 3).
    """
    step = 2 * math.pi / _AROUND
    angles = np.arange(_AROUND) * step
    # Sides of a polygon cut off a part of the circle; corners at this radius restore its area.
    outer = 0.5 * math.sqrt(step / math.sin(step))
    rim = outer * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    positions = np.concatenate([np.zeros((1, 3)), rim]) * (width, height, 1.0)
    i = np.arange(_AROUND)
    return positions, np.stack([0 * i, 1 + (i + 1) % _AROUND, 1 + i], axis=1)


def area_in(world: Array, width: float, height: float, is_round: bool) -> float:
    """Area of a lamp in the scene, m2.

    Args:
        world: Scene from lamp, shape (4, 4).
        width: Size along x, in the lamp's units.
        height: Size along y.
        is_round: Whether it is an ellipse.
    """
    across = np.cross(world[:3, 0] * width, world[:3, 1] * height)
    return float(np.linalg.norm(across)) * (math.pi / 4 if is_round else 1.0)
