"""Finds the triangle, and the place in it, at each texel of a layout of texture coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Most texels that are tested at once.
_MOST = 1 << 20
#: Distance from the edges, in texels, beyond which two triangles on one texel overlap.
_CLEAR = 0.25
#: Distance around triangles, in texels, that belongs to them, so that filters see no seams.
MARGIN = 2.0


@dataclass(frozen=True)
class Raster:
    """Triangles at texels.

    Attributes:
        triangle: Number of the triangle at each texel, shape (H, W); -1: none.
        weights: Barycentric coordinates, shape (H, W, 3); beyond 0 .. 1 in the margin.
        covers: How many triangles cover the middle of each texel, shape (H, W).
    """

    triangle: NDArray[np.int32]
    weights: NDArray[np.float32]
    covers: NDArray[np.int32]

    @property
    def inside(self) -> NDArray[np.bool_]:
        """Texels that have a triangle, shape (H, W)."""
        return self.triangle >= 0

    @property
    def overlap(self) -> float:
        """Share of the covered texels that several triangles cover."""
        covered = np.count_nonzero(self.covers)
        return np.count_nonzero(self.covers > 1) / covered if covered else 0.0

    def values(self, corners: NDArray[Any]) -> NDArray[np.float32]:
        """Values at all texels, shape (H, W, K), of those at corners, shape (T, 3, K)."""
        found = np.zeros((*self.triangle.shape, corners.shape[2]), np.float32)
        inside = self.inside
        triangle, weights = self.triangle[inside], self.weights[inside]
        total = np.zeros((len(triangle), corners.shape[2]))
        for i in range(3):
            total += weights[:, i, None] * corners[:, i].astype(np.float64)[triangle]
        found[inside] = total
        return found


def rasterized(corners: NDArray[np.float64], size: tuple[int, int]) -> Raster:
    """Raster of triangles.

    Args:
        corners: Corners in texels from the top left, shape (T, 3, 2), as (x, y).
        size: Rows and columns.
    """
    raster = Raster(
        np.full(size, -1, np.int32), np.zeros((*size, 3), np.float32), np.zeros(size, np.int32)
    )
    depth = np.full(size, -np.inf, np.float32)
    for triangles, low, width, height in _chunks(corners, size):
        _add(raster, depth, corners, _texels(triangles, low, width, height))
    return raster


def _chunks(corners: NDArray[np.float64], size: tuple[int, int]) -> Iterator[tuple[Any, ...]]:
    """Triangles with area, and the boxes around them in texels, in portions."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    limit = np.array([size[1], size[0]])
    low = np.clip(np.floor(corners.min(axis=1) - MARGIN), 0, limit).astype(np.int64)
    high = np.clip(np.ceil(corners.max(axis=1) + MARGIN), 0, limit).astype(np.int64)
    extent = high - low
    kept = np.flatnonzero((np.abs(area) > 1e-9) & (extent.min(axis=1) > 0))
    sums = np.cumsum(extent[kept].prod(axis=1))
    start = 0
    while start < len(kept):
        before = sums[start - 1] if start else 0
        end = max(int(np.searchsorted(sums, before + _MOST, "right")), start + 1)
        chosen = kept[start:end]
        yield chosen, low[chosen], extent[chosen, 0], extent[chosen, 1]
        start = end


def _texels(triangles: Any, low: Any, width: Any, height: Any) -> tuple[Any, Any, Any]:
    """Triangle, column and row of all texels of boxes."""
    count = width * height
    which = np.repeat(np.arange(len(triangles)), count)
    within = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    column = low[which, 0] + within % width[which]
    row = low[which, 1] + within // width[which]
    return triangles[which], column, row


def _add(raster: Raster, depth: Any, corners: Any, texels: tuple[Any, Any, Any]) -> None:
    """Adds triangles at the texels where they lie deeper than those that are there."""
    triangle, column, row = texels
    weights, distance = _places(corners[triangle], column + 0.5, row + 0.5)
    size = raster.covers.shape
    place = row * size[1] + column
    clear = distance > _CLEAR
    raster.covers[...] += np.bincount(place[clear], minlength=size[0] * size[1]).reshape(size)
    near = (distance >= -MARGIN) & (distance > depth[row, column])
    order = np.flatnonzero(near)
    order = order[np.argsort(distance[order], kind="stable")]  # the deepest is written last
    row, column = row[order], column[order]
    depth[row, column] = distance[order]
    raster.triangle[row, column] = triangle[order]
    raster.weights[row, column] = weights[order]


def _places(corners: Any, x: Any, y: Any) -> tuple[Any, Any]:
    """Barycentric coordinates (N, 3) of points, and distances to the nearest edge, in texels."""
    crosses, lengths = [], []
    for i in range(3):  # the edge across from corner i
        p, q = corners[:, (i + 1) % 3], corners[:, (i + 2) % 3]
        along = q - p
        crosses.append(along[:, 0] * (y - p[:, 1]) - along[:, 1] * (x - p[:, 0]))
        lengths.append(np.hypot(along[:, 0], along[:, 1]))
    area = sum(crosses)
    weights = np.stack([cross / area for cross in crosses], axis=1)
    heights = np.abs(area)[:, None] / np.stack(lengths, axis=1)
    return weights, (weights * heights).min(axis=1).astype(np.float32)
