"""Weighted sums of points: the linear map from one level to the next, and to the limit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .rules import FloatArray, IntArray

#: Rows at a time, so that gathered points stay in the cache of the processor; and multiplications
#: at a time, for which libraries of linear algebra use one thread.
_CHUNK, _PRODUCTS = 4096, 1 << 18
_COLUMNS = 4


@dataclass(frozen=True)
class Group:
    """Sums of equally many points.

    Attributes:
        rows: Rows of the result, shape (M,), or a slice.
        index: Points of each sum, shape (M, P).
        weights: Weights of the points, one column for each of J results: shape (P, J) for all
            rows, or (M, P, J).
    """

    rows: IntArray | slice
    index: IntArray
    weights: FloatArray

    def add_to(self, out: FloatArray, points: FloatArray) -> None:
        """Writes the sums of points (N, K) into rows of ``out``, shape (N', J, K)."""
        columns = points.shape[1]
        first = self.rows.start if isinstance(self.rows, slice) else 0
        same = self.weights.ndim == 2
        matrix = _interleaved(self.weights, columns) if same else self.weights
        chunk = max(1, min(_CHUNK, _PRODUCTS // (matrix.size if same else 1)))
        for begin in range(0, len(self.index), chunk):
            end = min(begin + chunk, len(self.index))
            near = points.take(self.index[begin:end], axis=0, mode="clip")
            if same:
                sums = near.reshape(end - begin, -1) @ matrix
            else:
                sums = np.einsum("mpj,mpk->mjk", matrix[begin:end], near)
            rows = slice(first + begin, first + end)
            out[rows if isinstance(self.rows, slice) else self.rows[begin:end]] = sums.reshape(
                end - begin, -1, columns
            )


def side_by_side(count: int, width: int, parts: Callable[[slice], list[IntArray]]) -> IntArray:
    """Points of sums, shape (count, width): columns from a function of some rows at a time."""
    index = np.empty((count, width), np.int64)
    for begin in range(0, count, _CHUNK):
        some = slice(begin, begin + _CHUNK)
        np.concatenate(parts(some), axis=1, out=index[some])
    return index


def _interleaved(weights: FloatArray, columns: int) -> NDArray[np.float64]:
    """Matrix (P K, J K) that acts on P points with K columns each, row after row."""
    points, results = weights.shape
    matrix = np.zeros((points, columns, results, columns))
    for column in range(columns):
        matrix[:, column, :, column] = weights
    return matrix.reshape(points * columns, results * columns)


def sums(groups: list[Group], points: FloatArray, count: int, results: int = 1) -> FloatArray:
    """Results of all groups, shape (count, results, K); few columns at a time."""
    out = np.empty((count, results, points.shape[1]))
    for begin in range(0, points.shape[1], _COLUMNS):
        some = slice(begin, begin + _COLUMNS)
        part = points if points.shape[1] <= _COLUMNS else np.ascontiguousarray(points[:, some])
        for group in groups:
            group.add_to(out[:, :, some], part)
    return out
