"""Panoramas as equal-area octahedral maps, in which pbrt-v4 holds light by direction."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .octahedral import directions_of

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
    s, t = ((np.arange(rows) + within) / rows for within in offset)
    return directions_of(*np.meshgrid(s, t))


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
