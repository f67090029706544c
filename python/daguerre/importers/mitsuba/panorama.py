"""Panoramas of Mitsuba as ours: rows from pole to pole, the middle along +z, any turn.

Mitsuba's first and last row are the poles themselves; ours are half a row away from them.

Source: Mitsuba 3, documentation of ``envmap``.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.pictures.panorama import resampled

Picture = NDArray[np.float32]
#: Rows up to which a panorama becomes finer as it is resampled, which keeps it sharp.
_FINE = 1024


def panorama(pixels: Picture, turn: NDArray[np.float64]) -> tuple[Picture, float]:
    """Converts a panorama.

    Args:
        pixels: Shape (H, W, 3).
        turn: World from the emitter, orthogonal, shape (3, 3).

    Returns:
        A panorama with -z in its middle, and its rotation about +y, degrees.
    """
    if np.linalg.det(turn) < 0:  # the mirror image in x, turned
        pixels, turn = pixels[:, ::-1], turn * (-1, 1, 1)
    count = len(pixels)
    finer = max(count, min(4 * count, _FINE))
    if turn[1, 1] < 1 - 1e-9:
        return resampled(_between_poles(pixels, count), turn, finer), 0.0
    rows = _between_poles(pixels, finer)
    half = rows.shape[1] // 2
    rotation = math.degrees(math.atan2(turn[0, 2], turn[2, 2]))
    if rows.shape[1] % 2:  # no whole number of columns is half a turn
        return rows, rotation + 180.0
    return np.roll(rows, half, axis=1), rotation


def _between_poles(pixels: Picture, rows: int) -> Picture:
    """Rows half a step from the poles, from rows that begin and end at the poles.

    Rows as many as before would be means of two neighbours near the poles.
    """
    count = len(pixels)
    if count < 2:
        return pixels
    at = (np.arange(rows) + 0.5) * ((count - 1) / rows)
    first = np.minimum(at.astype(np.int64), count - 2)
    share = (at - first).astype(np.float32)[:, None, None]
    made: Picture = pixels[first] * (1 - share) + pixels[first + 1] * share
    return made
