"""Bilinear interpolation of pictures."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def between(image: NDArray[Any], x: NDArray[Any], y: NDArray[Any]) -> NDArray[np.float32]:
    """Interpolates bilinearly at points in px (pixel centres at + 0.5); edge pixels continue.

    Args:
        image: Picture, shape (H, W) or (H, W, C).
        x: Distance from the left edge, any shape S.
        y: Distance from the upper edge, shape S.

    Returns:
        Values, shape S, or S + (C,).
    """
    height, width = image.shape[:2]
    x, y = np.clip(x - 0.5, 0, width - 1), np.clip(y - 0.5, 0, height - 1)
    column, row = (np.minimum(v.astype(int), n) for v, n in ((x, width - 1), (y, height - 1)))
    right, low = np.minimum(column + 1, width - 1), np.minimum(row + 1, height - 1)
    more = (...,) + (None,) * (image.ndim - 2)
    dx, dy = ((v - n).astype(np.float32)[more] for v, n in ((x, column), (y, row)))
    top = image[row, column] * (1 - dx) + image[row, right] * dx
    return np.asarray(
        top * (1 - dy) + (image[low, column] * (1 - dx) + image[low, right] * dx) * dy
    )
