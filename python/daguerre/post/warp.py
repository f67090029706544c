"""Maps from pixels of a result to points of its source.

A map is a function of points, px of the display window. It is evaluated at nodes 16 px apart, and
at every pixel of cells in which cubic interpolation between nodes would be off by more than
TOLERANCE. The core does the rest (``core/post/source_map.h``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre._core import SourceMap
from daguerre.cached import cached_property
from daguerre.convolution.rows import Rows

from .picture import Canvas

FloatArray = NDArray[np.float64]
PointMap = Callable[[FloatArray], FloatArray]  # (N, 2) -> (N, 2), px; NaN: not defined

CELL = 16
TOLERANCE = 1e-4  # px
CHUNK = 2048  # cells computed at a time
MARGIN = 8  # rows that filters read around a point


@dataclass(frozen=True)
class Warp:
    """A map evaluated for all pixels of a picture.

    Attributes:
        nodes: Displacements at nodes, px, shape (rows + 3, columns + 3, 2), from one cell before
            the first.
        exact: Index into ``cells`` for each cell, or -1, shape (rows, columns).
        cells: Displacements at each pixel of a cell, px, shape (N, 16, 16, 2).
        height: Height of the picture, px.
        top: First row of the first cell, a multiple of 16.
    """

    nodes: NDArray[np.float32]
    exact: NDArray[np.int32]
    cells: NDArray[np.float32]
    height: int
    top: int = 0

    @classmethod
    def of(cls, canvas: Canvas, place: PointMap) -> Warp:
        """Evaluates a map for a picture."""
        columns, rows = -(-canvas.width // CELL), -(-canvas.height // CELL)
        x = (np.arange(columns + 3) - 1.0) * CELL
        y = (np.arange(rows + 3) - 1.0) * CELL
        points = np.stack(np.meshgrid(x, y), axis=2)
        nodes = displacements(points, canvas, place)
        bad = _bad_cells(nodes)
        exact = np.full((rows, columns), -1, np.int32)
        exact[bad] = np.arange(bad.sum())
        cells = np.empty((int(bad.sum()), CELL, CELL, 2), np.float32)
        corners = np.argwhere(bad)[:, ::-1] * CELL
        inside = np.stack(np.meshgrid(np.arange(CELL), np.arange(CELL)), axis=2)
        for k in range(0, len(corners), CHUNK):
            points = corners[k : k + CHUNK, None, None, :] + inside
            cells[k : k + CHUNK] = displacements(points, canvas, place)
        return cls(nodes.astype(np.float32), exact, cells, canvas.height)

    @classmethod
    def of_each(cls, canvas: Canvas, places: Sequence[PointMap]) -> list[Warp]:
        """Evaluates several maps in parallel."""
        with ThreadPoolExecutor(len(places)) as pool:
            return list(pool.map(lambda place: cls.of(canvas, place), places))

    @classmethod
    def of_pixels(cls, moved: NDArray[np.float32], height: int, top: int) -> Warp:
        """Makes a warp from displacements at every pixel of some rows.

        Args:
            moved: Displacements, px, shape (rows, width, 2); NaN: not defined.
            height: Height of the whole picture, px.
            top: First row, a multiple of 16.
        """
        rows, columns = (-(-n // CELL) for n in moved.shape[:2])
        padded = np.full((rows * CELL, columns * CELL, 2), np.nan, np.float32)
        padded[: moved.shape[0], : moved.shape[1]] = moved
        cells = padded.reshape(rows, CELL, columns, CELL, 2).swapaxes(1, 2)
        nodes = np.full((rows + 3, columns + 3, 2), np.nan, np.float32)
        exact = np.arange(rows * columns, dtype=np.int32).reshape(rows, columns)
        return cls(nodes, exact, cells.reshape(-1, CELL, CELL, 2), height, top)

    @cached_property
    def core(self) -> Any:
        """Map in the core's form."""
        return SourceMap(self.nodes, self.exact, self.cells, self.top)

    def reads(self, rows: Rows) -> Rows:
        """Returns the rows of the source that these rows of the result need."""
        low, high = self._reach
        cells = slice((rows.begin - self.top) // CELL, (rows.end - 1 - self.top) // CELL + 1)
        if not (low[cells] <= high[cells]).any():
            return Rows(rows.begin, rows.begin + 1)
        return Rows(int(np.floor(low[cells].min())), int(np.ceil(high[cells].max())) + 1)

    @cached_property
    def _reach(self) -> tuple[FloatArray, FloatArray]:
        """First and last source row that each row of cells reads; inf, -inf: none."""
        rows, columns = self.exact.shape
        first = (np.arange(rows + 3) - 1.0)[:, None] * CELL + self.top
        y = np.asarray(self.nodes[:, :, 1] + first, np.float64)
        wide = 2 * _stretch(y, CELL)
        low, high = np.full(rows, np.inf), np.full(rows, -np.inf)
        for j in range(2):  # nodes above and below, and to the left and right of cells
            part = slice(1 + j, 1 + j + rows)
            here, more = y[part, 1 : columns + 2], wide[part, 1 : columns + 2]
            seen = (here > -2 * CELL) & (here < self.height + 2 * CELL)
            low = np.minimum(low, np.where(seen, here - more, np.inf).min(axis=1))
            high = np.maximum(high, np.where(seen, here + more, -np.inf).max(axis=1))
        row = np.argwhere(self.exact >= 0)[:, 0]
        if len(row):
            line = (row * CELL + self.top)[:, None, None] + np.arange(CELL)[:, None]
            at = np.asarray(self.cells[self.exact[self.exact >= 0], :, :, 1] + line, np.float64)
            more, seen = 2 * _stretch(at, 1), (at >= -1) & (at <= self.height)
            np.minimum.at(low, row, np.where(seen, at - more, np.inf).min(axis=(1, 2)))
            np.maximum.at(high, row, np.where(seen, at + more, -np.inf).max(axis=(1, 2)))
        return np.maximum(low - MARGIN, 0), np.minimum(high + MARGIN, self.height - 1)


def displacements(points: NDArray[Any], canvas: Canvas, place: PointMap) -> FloatArray:
    """Displacements by a map, px, at pixel indices; the centre of the first is at corner + 0.5."""
    flat = points.reshape(-1, 2) + (np.array(canvas.corner) + 0.5)
    return np.asarray((place(flat) - flat).reshape(points.shape))


def _bad_cells(nodes: FloatArray) -> NDArray[np.bool_]:
    """Cells in which Lagrange's cubic is not accurate enough, or the map ends; (rows, columns).

    The error of the cubic is at most 3/128 of the fourth difference.
    """
    known = np.isfinite(nodes[..., 0]) & np.isfinite(nodes[..., 1])
    whole, some = _folded(known, np.logical_and), _folded(known, np.logical_or)
    off = np.zeros(whole.shape)
    for axis in (0, 1):
        if nodes.shape[axis] < 5:
            off[:] = np.inf  # a picture of a cell or two
            continue
        fourth = np.abs(np.diff(np.where(known[:, :, None], nodes, 0), 4, axis))
        pad = [(0, 0), (0, 0)]
        pad[axis] = (2, 2)
        spread = np.pad(np.maximum(fourth[..., 0], fourth[..., 1]), pad, mode="edge")
        off = np.maximum(off, 3 / 128 * _folded(spread, np.maximum))
    return np.asarray(some & ~(whole & (off <= TOLERANCE)))


def _folded(values: NDArray[Any], fold: np.ufunc) -> NDArray[Any]:
    """Reduces over all windows of 4 x 4: first along columns, then along rows."""
    for _ in range(2):
        parts = [values[k : len(values) - 3 + k] for k in range(4)]
        values = fold(fold(parts[0], parts[1]), fold(parts[2], parts[3])).T
    return values


def _stretch(y: FloatArray, step: int) -> FloatArray:
    """Source rows that a pixel covers, 1 .. 16; y: source rows at points ``step`` px apart."""
    with np.errstate(invalid="ignore"):
        most = np.hypot(*np.gradient(y, axis=(-2, -1))) / step
    return np.asarray(np.clip(np.nan_to_num(most, nan=16.0), 1, 16))
