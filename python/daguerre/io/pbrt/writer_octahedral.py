"""Equal-area octahedral maps, in which pbrt-v4 holds light by direction.

Source: P. Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD", 2008, as the
documentation of pbrt-v4 names it: the square's inner diamond is the half sphere of z > 0.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: Largest number of rows of a resampled map.
_MOST_ROWS = 4096
#: Points along each side of a pixel whose mean it has.
_WITHIN = 2


def directions(rows: int, offset: tuple[float, float] = (0.5, 0.5)) -> Array:
    """Unit directions of the pixels of a square map, shape (rows, rows, 3).

    Args:
        rows: Number of rows and of columns.
        offset: Place within each pixel, along columns and rows; default: its middle.
    """
    u = 2 * (np.arange(rows) + offset[0]) / rows - 1
    v = 2 * (np.arange(rows) + offset[1]) / rows - 1
    return sphere(*np.meshgrid(u, v))


def sphere(u: Array, v: Array) -> Array:
    """Unit directions of points of the square [-1, 1]^2, shape (..., 3)."""
    across, down = np.abs(u), np.abs(v)
    inside = 1 - (across + down)
    r = 1 - np.abs(inside)
    turn = np.where(r > 0, (down - across) / np.where(r > 0, r, 1) + 1, 1) * math.pi / 4
    z = np.copysign(1 - r**2, inside)
    flat = r * np.sqrt(np.maximum(0.0, 2 - r**2))
    x = np.copysign(np.cos(turn), u) * flat
    y = np.copysign(np.sin(turn), v) * flat
    return np.stack([x, y, z], axis=-1)


def resampled(panorama: NDArray[np.float32]) -> NDArray[np.float32]:
    """Resamples a panorama, (H, W, 3), +y up, its middle at -z, to an octahedral map, +z up."""
    height, width = panorama.shape[:2]
    rows = 1
    while rows < _MOST_ROWS and rows * rows < 2 * height * width:
        rows *= 2
    total = np.zeros((rows, rows, 3))
    steps = (np.arange(_WITHIN) + 0.5) / _WITHIN
    for y in steps:
        for x in steps:
            found = directions(rows, (float(x), float(y)))
            total += looked_up(
                panorama, np.stack([found[..., 0], found[..., 2], -found[..., 1]], -1)
            )
    return (total / _WITHIN**2).astype(np.float32)


def looked_up(panorama: NDArray[np.float32], toward: Array) -> Array:
    """Bilinear values of a panorama toward unit directions with +y up, as the core reads them."""
    height, width = panorama.shape[:2]
    column = (0.5 + np.arctan2(toward[..., 0], -toward[..., 2]) / (2 * math.pi)) * width - 0.5
    polar = np.arctan2(np.hypot(toward[..., 0], toward[..., 2]), toward[..., 1])
    row = np.clip(polar / math.pi * height - 0.5, 0, height - 1)
    left, top = np.floor(column).astype(int), np.minimum(np.floor(row).astype(int), height - 1)
    s, t = (column - left)[..., None], (row - top)[..., None]
    right, low = (left + 1) % width, np.minimum(top + 1, height - 1)
    left = left % width
    upper = panorama[top, left] * (1 - s) + panorama[top, right] * s
    lower = panorama[low, left] * (1 - s) + panorama[low, right] * s
    return np.asarray(upper * (1 - t) + lower * t)
