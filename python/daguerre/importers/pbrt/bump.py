"""Bumps: heights of a texture as a normal map.

pbrt moves the surface by a height d along its normal and takes the normal of the moved surface
(Blinn 1978; Pharr, Jakob and Humphreys 2023, section 10.5.2): with steep derivatives of d along u
and v over the lengths of dp/du and dp/dv. A normal map holds the derivatives, and each mesh scales
them by the mean length of its dp/du and dp/dv.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .shapes import LocalMesh

Array = NDArray[np.floating]


def normal_map(heights: Array, size: tuple[float, float], *, repeats: bool) -> NDArray[np.float32]:
    """Makes a normal map of heights, in texture coordinates of length 1 m.

    Args:
        heights: Heights, m, shape (H, W), row 0 on top.
        size: Width and height of the picture in texture coordinates.
        repeats: Whether the picture continues at its edges.

    Returns:
        Shape (H, W, 3): 0.5 + 0.5 x the normal, scaled to a third component of 1. R is along u, G
        along v upward.
    """
    rows, columns = heights.shape
    values = heights.astype(np.float64)
    padded = np.pad(values, 1, mode="wrap") if repeats else np.pad(values, 1, mode="edge")
    along = (padded[1:-1, 2:] - padded[1:-1, :-2]) * (0.5 * columns / size[0])
    up = (padded[:-2, 1:-1] - padded[2:, 1:-1]) * (0.5 * rows / size[1])
    made = np.ones((rows, columns, 3), np.float32)
    made[..., 0], made[..., 1] = 0.5 - 0.5 * along, 0.5 - 0.5 * up
    return made


def strength(surface: LocalMesh, world: NDArray[np.float64]) -> float:
    """Factor on the slopes of a normal map of :func:`normal_map`, 1 over the length of dp/du, 1/m.

    The length is the mean over the surface, and over u and v.

    Args:
        surface: The surface; without texture coordinates the factor is 1.
        world: World from its space, shape (4, 4).
    """
    if surface.uv is None or not len(surface.triangles):
        return 1.0
    points = surface.positions[surface.triangles].astype(np.float64) @ world[:3, :3].T
    places = surface.uv[surface.triangles].astype(np.float64)
    first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    (du1, dv1), (du2, dv2) = ((places[:, i] - places[:, 0]).T[..., None] for i in (1, 2))
    along = np.linalg.norm(dv2 * first - dv1 * second, axis=1)  # dp/du, times the determinant
    up = np.linalg.norm(du1 * second - du2 * first, axis=1)
    determinant = np.abs(du1 * dv2 - dv1 * du2)[:, 0]
    area = np.linalg.norm(np.cross(first, second), axis=1)
    good = (determinant > 0) & (area > 0)
    whole = float(area[good].sum())
    if not whole > 0:
        return 1.0
    lengths = 0.5 * (along[good] + up[good]) / determinant[good]
    mean = float((area[good] * lengths).sum()) / whole
    return 1.0 / mean if mean > 0 else 1.0
