"""Resamples panoramas of other formats to the orientation and size of the scene's panorama.

A sun of 0.53 degrees keeps its light within 2 %, wherever it is.

Pixels near the poles of a panorama are narrow, and samples would miss them. So rows are smoothed
first, as if all pixels were squares of one size; this keeps the light of each row.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Picture = NDArray[np.float32]
#: Samples across a pixel of a small panorama, in which the sun covers few pixels.
_MOST = 4
#: Rows of panoramas for which one sample is enough.
_LARGE = 2048
#: Samples at once.
_CHUNK = 1 << 16


def resampled(image: Picture, turn: Array, rows: int) -> Picture:
    """Resamples a panorama with +z of the dome at its centre to have -z of the scene there.

    Args:
        image: Shape (H, W, 3).
        turn: Scene from dome, orthogonal, shape (3, 3).
        rows: Rows of the result.

    Returns:
        Shape (rows, 2 * rows, 3).
    """
    finest = max(len(image), rows)
    across = math.ceil(finest / rows * max(1, min(_MOST, _LARGE // finest)))
    columns = 2 * rows * across
    longitude = ((np.arange(columns) + 0.5) / columns - 0.5) * 2 * math.pi
    around = np.stack([np.sin(longitude), -np.cos(longitude)], axis=1)
    equator = (around @ turn[[0, 2]]).astype(np.float32).T  # in the dome, shape (3, columns)
    smooth = _smoothed(image)
    made = np.empty((rows, 2 * rows, 3), np.float32)
    step = max(1, _CHUNK // (columns * across))
    for row in range(0, rows, step):
        fine = np.arange(across * row, across * min(row + step, rows))
        latitude = (0.5 - (fine + 0.5) / (across * rows)) * math.pi
        flat = np.cos(latitude).astype(np.float32)
        high = np.outer(turn[1], np.sin(latitude)).astype(np.float32)
        seen = looked_up(smooth, flat[:, None] * equator[:, None] + high[..., None])
        weights = flat.reshape(-1, across)
        weights /= weights.sum(axis=1, keepdims=True) * across
        boxes = seen.reshape(-1, across, 2 * rows, across, 3)
        made[row : row + step] = np.einsum("rickd,ri->rcd", boxes, weights)
    return made


def _smoothed(image: Picture) -> Picture:
    """Averages each row over the width, in radians, of a pixel at the equator."""
    height, width = image.shape[:2]
    made = np.empty(image.shape, np.float32)
    for row in range(height):
        share = min(1 / math.sin((row + 0.5) / height * math.pi), width)
        more = min(int(0.5 * share) + 1, width)
        line = np.concatenate([image[row, -more:], image[row], image[row, :more]])
        sums = np.zeros((len(line) + 1, 3))
        np.cumsum(line, axis=0, dtype=np.float64, out=sums[1:])
        left, right = (_between(sums, more + 0.5 + side * share, width) for side in (-0.5, 0.5))
        made[row] = (right - left) / share
    return made


def _between(sums: Array, start: float, count: int) -> Array:
    """Running sums, interpolated, at a start and at steps of 1."""
    first = int(start)
    share = start - first
    return sums[first : first + count] * (1 - share) + sums[first + 1 : first + 1 + count] * share


def looked_up(image: Picture, directions: Picture) -> Picture:
    """Bilinear values of a panorama with +z of a dome at its centre.

    Args:
        image: Shape (H, W, 3).
        directions: Directions of the dome, of any length, +y up, shape (3, N, M).

    Returns:
        Shape (N, M, 3).
    """
    height, width = image.shape[:2]
    pixels = image.reshape(-1, 3)
    x, y, z = directions
    u = np.arctan2(z, x) * np.float32(width / (2 * math.pi)) + np.float32(0.25 * width - 0.5)
    v = np.arctan2(np.hypot(x, z), y) * np.float32(height / math.pi) - np.float32(0.5)
    v = np.clip(v, 0, height - 1)
    left, top = np.floor(u), np.floor(v)
    across, down = (u - left)[..., None], (v - top)[..., None]
    first = left.astype(np.int32) % width
    second = (first + 1) % width
    upper = top.astype(np.int32) * width
    lower = np.minimum(upper + width, (height - 1) * width)
    made: Picture = _mixed(pixels, upper + first, upper + second, across)
    made += (_mixed(pixels, lower + first, lower + second, across) - made) * down
    return made


def _mixed(pixels: Picture, a: NDArray[np.int32], b: NDArray[np.int32], share: Picture) -> Picture:
    first = np.take(pixels, a, axis=0)
    return first + (np.take(pixels, b, axis=0) - first) * share
