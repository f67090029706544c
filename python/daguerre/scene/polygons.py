"""Polygons as triangles, and values per corner as values per vertex."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.errors import InputError

from .ears import Effort, clipped, plane_of

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
#: Where numbers are in an array.
Places = slice | IntArray
#: Polygons at a time, so that their points stay in the cache of the processor.
_CHUNK = 1 << 14


def triangulate(
    sizes: ArrayLike, vertices: ArrayLike, points: ArrayLike | None = None
) -> tuple[IntArray, IntArray]:
    """Divides polygons into triangles of the same orientation.

    Quadrangles are split along the shorter diagonal, concave quadrangles along the inner diagonal.
    Larger polygons become fans about their first corner if all triangles of the fan face the same
    side; otherwise their ears are clipped. The triangles of polygons that cross themselves are
    arbitrary. Without points all polygons become fans.

    Args:
        sizes: Corners of each polygon, at least 3, shape (F,).
        vertices: Vertex of each corner, shape (C,), C the sum of ``sizes``.
        points: Positions of vertices, shape (N, 3).

    Returns:
        Corners of triangles, 0 .. C - 1, shape (T, 3), and the polygon of each, rising, shape (T,).

    Raises:
        InputError: Concave polygons with too many corners would take minutes.
    """
    each, flat = np.asarray(sizes, np.int64), np.asarray(vertices)
    triangles = np.empty((int(each.sum()) - 2 * len(each), 3), np.int64)
    for rows, corners in _divisions(each, np.arange(len(flat)), flat, points):
        triangles[rows] = corners
    return triangles, np.repeat(np.arange(len(each)), each - 2)


def vertices_of_triangles(
    sizes: ArrayLike, vertices: ArrayLike, points: ArrayLike | None = None
) -> NDArray[np.uint32]:
    """Divides polygons, as ``triangulate`` does.

    Returns:
        Vertices of triangles, shape (T, 3).
    """
    each, flat = np.asarray(sizes, np.int64), np.asarray(vertices)
    triangles = np.empty((int(each.sum()) - 2 * len(each), 3), np.uint32)
    names = flat.astype(np.uint32, copy=False)
    for rows, corners in _divisions(each, names, flat, points):
        triangles[rows] = corners
    return triangles


def _divisions(
    sizes: IntArray, names: NDArray[Any], vertices: NDArray[Any], points: ArrayLike | None
) -> Iterator[tuple[Places, NDArray[Any]]]:
    """Rows of triangles, and the names of their corners, shape (T, 3).

    Args:
        sizes: Corners of each polygon, shape (F,).
        names: Name of each corner, shape (C,), whole numbers.
        vertices: Vertex of each corner, shape (C,).
        points: Positions of vertices, shape (N, 3), or None.
    """
    places, effort = None if points is None else np.asarray(points), Effort()
    corner, row = 0, 0
    for begin in range(0, len(sizes), _CHUNK):
        some = sizes[begin : begin + _CHUNK]
        for size, corners, rows in _of_one_size(some):
            own = names[corner:][corners].reshape(-1, size)
            near = None
            if places is not None and size > 3:
                near = places.take(vertices[corner:][corners].reshape(-1, size), axis=0)
            yield _moved(rows, row), _divided(own, near, effort).reshape(-1, 3)
        corner += int(some.sum())
        row += int(some.sum()) - 2 * len(some)


def _of_one_size(sizes: IntArray) -> Iterator[tuple[int, Places, Places]]:
    """Sizes of polygons, corners of those that have it, and rows of their triangles."""
    if (sizes == sizes[0]).all():
        size = int(sizes[0])
        yield size, slice(0, len(sizes) * size), slice(0, len(sizes) * (size - 2))
        return
    starts = np.cumsum(sizes) - sizes
    first = starts - 2 * np.arange(len(sizes))
    for size in np.flatnonzero(np.bincount(sizes)).tolist():
        own = sizes == size
        corners = starts[own, None] + np.arange(size)
        yield size, corners.reshape(-1), (first[own, None] + np.arange(size - 2)).reshape(-1)


def _moved(places: Places, by: int) -> Places:
    if isinstance(places, slice):
        return slice(places.start + by, places.stop + by)
    return places + by


def _divided(corners: NDArray[Any], near: NDArray[Any] | None, effort: Effort) -> NDArray[Any]:
    """Triangles of polygons of one size, shape (B, n - 2, 3).

    Args:
        corners: Names of their corners, shape (B, n).
        near: Positions of these, shape (B, n, 3), or None.
        effort: Limit of the time that concave polygons may take.
    """
    size = corners.shape[1]
    if size == 3:
        return corners[:, None]
    fan = np.empty((len(corners), size - 2, 3), corners.dtype)
    fan[:, :, 0], fan[:, :, 1], fan[:, :, 2] = corners[:, :1], corners[:, 1:-1], corners[:, 2:]
    if near is None:
        return fan
    if size == 4:
        take = np.flatnonzero(_takes_other(near))
        fan[take] = corners[take][:, [[1, 2, 3], [1, 3, 0]]]
        return fan
    flat = plane_of(near.astype(np.float64, copy=False))
    bad = np.flatnonzero(~_fans_fit(flat))
    if len(bad):
        order = clipped(flat[bad], effort)
        fan[bad] = np.take_along_axis(corners[bad], order.reshape(len(bad), -1), axis=1).reshape(
            order.shape
        )
    return fan


def _takes_other(near: NDArray[Any]) -> BoolArray:
    """Whether quadrangles (B, 4, 3) are divided from corner 1 to 3, shape (B,)."""
    a, b, c, d = np.ascontiguousarray(near.transpose(1, 2, 0), np.float64)  # (3, B) sum fast
    one, other = c - a, d - b
    fits, fits_other = _same_side(b - a, one, d - a), _same_side(c - b, other, a - b)
    shorter = _dot(other, other) < _dot(one, one)
    return np.where(fits == fits_other, shorter, fits_other)


def _same_side(before: FloatArray, diagonal: FloatArray, behind: FloatArray) -> BoolArray:
    """Whether both triangles beside a diagonal face the same side; vectors (3, B)."""
    # Lagrange's identity for (before x diagonal) . (diagonal x behind).
    first = _dot(before, diagonal) * _dot(diagonal, behind)
    return first > _dot(before, behind) * _dot(diagonal, diagonal)


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


def _fans_fit(flat: FloatArray) -> BoolArray:
    """Whether all triangles of the fans of polygons (B, n, 2) face the side of the polygon."""
    rays = flat[:, 1:] - flat[:, :1]
    cross = rays[:, :-1, 0] * rays[:, 1:, 1] - rays[:, :-1, 1] * rays[:, 1:, 0]
    return np.asarray((cross > 0).all(axis=1))


def weld(corner_vertices: ArrayLike, *corner_attributes: ArrayLike) -> tuple[IntArray, IntArray]:
    """Merges corners with the same vertex and the same bits of all attributes.

    Args:
        corner_vertices: Vertex of each corner, at least 0, shape (C,).
        *corner_attributes: Values of each corner, shape (C,) or (C, K), numbers.

    Returns:
        The first of each group of equal corners, rising, shape (U,), and the group of each corner,
        shape (C,).
    """
    vertices = np.asarray(corner_vertices, np.int64)
    attributes = [_bits(np.asarray(attribute)) for attribute in corner_attributes]
    corners = np.arange(len(vertices))
    first = np.zeros(int(vertices.max(initial=-1)) + 1, np.int64)
    first[vertices[::-1]] = corners[::-1]
    leader = first[vertices]
    # All corners agree at most vertices; the corners of the other vertices are sorted.
    apart = np.zeros(len(first), bool)
    apart[vertices[_differ(attributes, leader)]] = True
    if apart.any():
        rest = np.flatnonzero(apart[vertices])
        columns = [vertices[rest].view(np.uint64)]
        columns += [column.astype(np.uint64) for bits in attributes for column in bits[rest].T]
        leader[rest] = rest[_leaders(columns)]
    found = np.flatnonzero(leader == corners)
    number = np.empty(len(corners), np.int64)
    number[found] = np.arange(len(found))
    return found, number[leader]


def _bits(values: NDArray[Any]) -> NDArray[Any]:
    """Bits of rows of numbers as few whole numbers, shape (C, K)."""
    rows = values.reshape(len(values), -1) if len(values) else values.reshape(0, 1)
    size = values.dtype.itemsize
    wide = rows.shape[1] * size % 8 == 0
    return np.ascontiguousarray(rows).view(f"u{8 if wide else size}")


def _differ(attributes: list[NDArray[Any]], leader: IntArray) -> IntArray:
    """Corners that have other bits than those that lead them."""
    found = [np.zeros(0, np.int64)]
    for begin in range(0, len(leader), _CHUNK):
        some = slice(begin, begin + _CHUNK)
        for bits in attributes:
            near = bits.take(leader[some], axis=0, mode="clip")
            for k in range(bits.shape[1]):
                found.append(begin + np.flatnonzero(bits[some, k] != near[:, k]))
    return np.concatenate(found)


def _leaders(columns: list[NDArray[np.uint64]]) -> IntArray:
    """First row that is equal to each, shape (C,)."""
    order = np.argsort(_mixed(columns))
    new = np.ones(len(order), bool)
    new[1:] = False
    for column in columns:
        bits = column[order]
        new[1:] |= bits[1:] != bits[:-1]
    leader = np.empty(len(order), np.int64)
    leader[order] = np.minimum.reduceat(order, np.flatnonzero(new))[np.cumsum(new) - 1]
    return leader


def _mixed(columns: list[NDArray[np.uint64]]) -> NDArray[np.uint64]:
    """Hash of each row.

    Different rows with the same hash are not merged; at worst, equal rows between them stay apart.
    """
    total = np.zeros(len(columns[0]), np.uint64)
    for column in columns:
        total = (total ^ column) * np.uint64(0x9E3779B97F4A7C15)
        total ^= total >> np.uint64(29)
    return total


def check_sizes(sizes: IntArray, corners: int, where: str) -> None:
    """Checks that polygons have at least 3 corners each, and ``corners`` together.

    Raises:
        InputError: They have not.
    """
    if sizes.size and sizes.min() < 3:
        face = int(np.argmin(sizes))
        raise InputError(f"{where}: sizes[{face}]: wanted at least 3 corners, got {sizes[face]}")
    if int(sizes.sum()) != corners:
        raise InputError(
            f"{where}: indices: wanted {int(sizes.sum())} corners (the sum of sizes), got {corners}"
        )
