"""Figures drawn in 3 x 5 squares, for whatever bears a number."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

# Five rows of three squares, a digit in base 8 each.
_ROWS = {"1": "26227", "4": "55711", "7": "71122", "8": "75757", "9": "75717"}


def ink(figure: str, u: ArrayLike, v: ArrayLike, height: float) -> NDArray[np.bool_]:
    """Where a figure of this height about the origin has ink; u runs right, v up."""
    square = height / 5
    column = np.floor(np.asarray(u) / square + 1.5).astype(int)
    row = np.floor(2.5 - np.asarray(v) / square).astype(int)
    inside = (column >= 0) & (column < 3) & (row >= 0) & (row < 5)
    rows = np.array([int(digit) for digit in _ROWS[figure]])
    squares = rows[np.clip(row, 0, 4)] >> (2 - np.clip(column, 0, 2)) & 1
    return inside & (squares == 1)


def roundel(figure: str, size: int = 128) -> NDArray[np.float64]:
    """A black figure on white, as a picture (size, size, 3) for a disc, whose v runs up."""
    y, x = (np.mgrid[0:size, 0:size] + 0.5) / size - 0.5
    return np.where(ink(figure, x, y, 0.66)[..., None], 0.02, 0.86) * np.ones(3)
