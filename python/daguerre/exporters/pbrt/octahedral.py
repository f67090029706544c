"""Panoramas as equal-area octahedral maps, in which pbrt-v4 holds light by direction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.importers.pbrt.octahedral import directions_of
from daguerre.pictures.panorama import looked_up

Array = NDArray[np.float64]

#: Largest number of rows of a resampled map.
_MOST_ROWS = 4096
#: Samples along each side of a pixel, which gets their mean.
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
            east, north, up = np.moveaxis(directions(rows, (float(x), float(y))), -1, 0)
            total += looked_up(panorama, np.stack([-east, up, north]).astype(np.float32))
    return (total / _WITHIN**2).astype(np.float32)
