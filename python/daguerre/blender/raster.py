"""Finds the triangle, and the place in it, at each texel of a layout of texture coordinates."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Most texels of small triangles that are tested at once, and fewest texels of a large triangle.
_MOST, _LARGE = 1 << 18, 1 << 12
#: Distance from the edges, in texels, beyond which two triangles on one texel overlap.
_CLEAR = np.float32(0.25)
#: Distance around triangles, in texels, that belongs to them, so that filters see no seams.
MARGIN = np.float32(2.0)


@dataclass(frozen=True)
class Raster:
    """Triangles at texels.

    Attributes:
        triangle: Number of the triangle at each texel, shape (H, W); -1: none.
        weights: Barycentric coordinates of the first two corners, two arrays (H, W); beyond 0 .. 1
            in the margin.
        covers: How many triangles cover the middle of each texel, shape (H, W).
    """

    triangle: NDArray[np.int32]
    weights: tuple[NDArray[np.float32], NDArray[np.float32]]
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
        """Interpolates values at corners, shape (T, 3, K), to all texels, shape (H, W, K)."""
        found = np.zeros((*self.triangle.shape, corners.shape[2]), np.float32)
        inside = self.inside
        triangle = self.triangle[inside]
        last = corners[:, 2]
        total = last.astype(np.float32)[triangle]
        for i in range(2):
            side = (corners[:, i] - last).astype(np.float32)[triangle]
            side *= self.weights[i][inside][:, None]
            total += side
        found[inside] = total
        return found


@dataclass(frozen=True)
class _Planes:
    """Barycentric coordinates of triangles as functions of texels.

    Attributes:
        low: Column and row of the box around each triangle, shape (T, 2).
        extent: Columns and rows of the box, shape (T, 2).
        factors: Coordinates of the first two corners at the middle of the box's first texel, and
            their change from column to column and row to row, shape (T, 2, 3).
        heights: Heights of the triangles over their three edges, in texels, shape (T, 3).
    """

    low: NDArray[np.int64]
    extent: NDArray[np.int64]
    factors: NDArray[np.float32]
    heights: NDArray[np.float32]

    def at(
        self, which: NDArray[np.int64] | int, column: NDArray[np.float32], row: NDArray[np.float32]
    ) -> tuple[Any, Any, Any]:
        """Two coordinates, and the distance to the nearest edge, of texels of boxes."""
        heights = self.heights[which]
        found = []
        for i in range(2):
            start, across, down = np.moveaxis(self.factors[which, i], -1, 0)
            found.append(start + across * column + down * row)
        distance = (np.float32(1) - found[0] - found[1]) * heights[..., 2]
        for i in range(2):
            np.minimum(distance, found[i] * heights[..., i], out=distance)
        return found[0], found[1], distance


def rasterized(corners: NDArray[np.float64], size: tuple[int, int]) -> Raster:
    """Raster of triangles.

    Args:
        corners: Corners in texels from the top left, shape (T, 3, 2), as (x, y).
        size: Rows and columns.
    """
    weights = np.zeros(size, np.float32), np.zeros(size, np.float32)
    raster = Raster(np.full(size, -1, np.int32), weights, np.zeros(size, np.int32))
    depth = np.full(size, -MARGIN, np.float32)
    planes = _planes(corners, size)
    texels = planes.extent.prod(axis=1)
    for which in np.flatnonzero(texels >= _LARGE).tolist():
        _add_large(raster, depth, planes, which)
    for few in _portions(np.flatnonzero((texels > 0) & (texels < _LARGE)), texels):
        _add_small(raster, depth, planes, few)
    return raster


def _planes(corners: NDArray[np.float64], size: tuple[int, int]) -> _Planes:
    """Planes of triangles; a triangle without area has no box."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = _cross(b - a, c - a)
    limit = np.array([size[1], size[0]])
    low = np.clip(np.floor(corners.min(axis=1) - MARGIN), 0, limit).astype(np.int64)
    high = np.clip(np.ceil(corners.max(axis=1) + MARGIN), 0, limit).astype(np.int64)
    extent = np.where(np.abs(area)[:, None] > 1e-9, high - low, 0)
    first = low + 0.5
    with np.errstate(all="ignore"):
        rows = [
            np.stack([_cross(q - p, first - p), p[:, 1] - q[:, 1], q[:, 0] - p[:, 0]], axis=1)
            for p, q in ((b, c), (c, a))
        ]
        factors = np.stack(rows, axis=1) / area[:, None, None]
        edges = np.stack([c - b, a - c, b - a], axis=1)
        heights = np.abs(area)[:, None] / np.hypot(edges[:, :, 0], edges[:, :, 1])
    return _Planes(low, extent, factors.astype(np.float32), heights.astype(np.float32))


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _portions(chosen: NDArray[np.int64], texels: NDArray[np.int64]) -> Iterator[Any]:
    """Triangles in portions of about ``_MOST`` texels."""
    sums = np.cumsum(texels[chosen])
    start = 0
    while start < len(chosen):
        before = sums[start - 1] if start else 0
        end = max(int(np.searchsorted(sums, before + _MOST, "right")), start + 1)
        yield chosen[start:end]
        start = end


def _add_large(raster: Raster, depth: NDArray[np.float32], planes: _Planes, which: int) -> None:
    """Adds one triangle, in all texels of its box."""
    (left, top), (columns, rows) = planes.low[which], planes.extent[which]
    part = slice(top, top + rows), slice(left, left + columns)
    column = np.arange(columns, dtype=np.float32)
    row = np.arange(rows, dtype=np.float32)[:, None]
    one, two, distance = planes.at(which, column, row)
    raster.covers[part] += distance > _CLEAR
    deeper = distance > depth[part]
    np.copyto(depth[part], distance, where=deeper)
    np.copyto(raster.triangle[part], which, where=deeper)
    np.copyto(raster.weights[0][part], one, where=deeper)
    np.copyto(raster.weights[1][part], two, where=deeper)


def _add_small(
    raster: Raster, depth: NDArray[np.float32], planes: _Planes, few: NDArray[np.int64]
) -> None:
    """Adds many small triangles at once."""
    extent = planes.extent[few]
    count = extent.prod(axis=1)
    which = np.repeat(np.arange(len(few)), count)
    within = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
    row, column = np.divmod(within, extent[which, 0])
    which = few[which]
    one, two, distance = planes.at(which, column.astype(np.float32), row.astype(np.float32))
    place = (planes.low[which, 1] + row) * depth.shape[1] + planes.low[which, 0] + column
    np.add.at(raster.covers.reshape(-1), place[distance > _CLEAR], 1)
    flat = depth.reshape(-1)
    np.maximum.at(flat, place, distance)
    deepest = distance == flat[place]
    place = place[deepest]
    raster.triangle.reshape(-1)[place] = which[deepest]
    raster.weights[0].reshape(-1)[place] = one[deepest]
    raster.weights[1].reshape(-1)[place] = two[deepest]
