"""Turns and resizes panoramas without loss of light."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .latlong import FloatArray


def turned(image: NDArray[np.float32], degrees: float) -> NDArray[np.float32]:
    """Turns a panorama about +y, like ``--env-rotation``; rows keep their sums.

    Args:
        image: Panorama, shape (H, W, C).
        degrees: Angle from -z toward -x, that is toward the left of the picture.
    """
    columns = degrees / 360 * image.shape[1]
    whole = int(np.floor(columns))
    part = np.float32(columns - whole)
    image = np.roll(image, -whole, axis=1)
    if part < 1e-6:
        return image
    return np.asarray(image * (1 - part) + np.roll(image, -1, axis=1) * part)


def resized(image: NDArray[np.float32], width: int, height: int) -> NDArray[np.float32]:
    """Resizes a panorama by means over the solid angle of each new pixel; no light is lost.

    Args:
        image: Panorama, shape (H, W, C).
        width: New width, px.
        height: New height, px.
    """
    rows, columns = image.shape[:2]
    if (rows, columns) == (height, width):
        return image
    across = _means(image, np.arange(columns + 1) / columns, np.arange(width + 1) / width, 1)
    # Equal steps of cos(polar) are equal solid angles.
    before, after = (-np.cos(np.pi * np.arange(n + 1) / n) for n in (rows, height))
    return _means(across, before, after, 0).astype(np.float32)


def _means(image: NDArray[Any], before: FloatArray, after: FloatArray, axis: int) -> FloatArray:
    """Means between edges ``after`` of values that are constant between edges ``before``."""
    values = np.moveaxis(image.astype(np.float64), axis, 0)
    steps = np.diff(before).reshape(-1, *[1] * (values.ndim - 1))
    sums = np.concatenate([np.zeros_like(values[:1]), np.cumsum(values * steps, axis=0)])
    at = np.clip(np.interp(after, before, np.arange(len(before))), 0, len(before) - 1)
    low = np.minimum(at.astype(int), len(before) - 2)
    share = (at - low).reshape(-1, *[1] * (values.ndim - 1))
    found = sums[low] * (1 - share) + sums[low + 1] * share
    widths = np.diff(after).reshape(-1, *[1] * (values.ndim - 1))
    return np.moveaxis(np.maximum(np.diff(found, axis=0) / widths, 0), 0, axis)
