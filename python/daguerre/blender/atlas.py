"""Texture coordinates for a mesh without coordinates, or with overlapping coordinates.

Connected faces with the same dominant axis form a chart, projected along that axis; the atlas packs
charts in rows. A face that overlaps another face of its chart becomes a separate chart.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .raster import rasterized

Array = NDArray[Any]
#: Room between charts, in units of the atlas: four texels of 1024.
_GUTTER = 4 / 1024
#: Texels of the raster that looks for charts that overlap themselves.
_PROBE = 1024
#: Columns of a point that are seen along -x, x, -y, y, -z, z, and the sign of the first.
_VIEWS = ((1, 2, -1), (1, 2, 1), (0, 2, 1), (0, 2, -1), (0, 1, -1), (0, 1, 1))
#: How often faces that lie over others are taken out of their charts.
_ROUNDS = 3
#: Share of the room that packing begins to try, and how it shrinks.
_FILL, _SHRINK = 0.9, 0.95


def unwrapped(points: Array, triangles: Array, faces: Array) -> Array:
    """Coordinates 0 .. 1 of the corners of triangles, shape (T, 3, 2).

    Args:
        points: Positions, shape (N, 3).
        triangles: Vertices, shape (T, 3).
        faces: Number of the face that a triangle is part of, shape (T,).
    """
    _, face = np.unique(faces, return_inverse=True)
    corners = points[triangles].astype(np.float64)
    views = _views(corners, face)
    charts = _charts(triangles, face, views)
    flat = _seen(corners, views[face])
    alone = len(charts) + np.arange(len(charts))
    for last in (False,) * _ROUNDS + (True,):
        placed = _packed(flat, charts[face])
        folded = _folded(placed, face)
        if not folded.any():
            break
        if last:  # no face of a chart that overlaps itself is joined to another
            folded = np.isin(charts, charts[folded])
        charts = np.where(folded, alone, charts)
    else:
        placed = _packed(flat, charts[face])
    return placed


def _views(corners: Array, face: Array) -> Array:
    """Axis along which each face is seen, 0 .. 5."""
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = np.stack([np.bincount(face, cross[:, i]) for i in range(3)], axis=1)
    axis = np.abs(normal).argmax(axis=1)
    positive = np.take_along_axis(normal, axis[:, None], 1)[:, 0] >= 0
    return np.asarray(2 * axis + positive)


def _seen(corners: Array, views: Array) -> Array:
    """Corners in the plane of their view, shape (T, 3, 2), turning as on the surface."""
    across, up, sign = np.array(_VIEWS)[views].T
    rows = np.arange(len(corners))
    return np.stack([corners[rows, :, across] * sign[:, None], corners[rows, :, up]], axis=2)


def _charts(triangles: Array, face: Array, views: Array) -> Array:
    """Chart of each face: faces that share an edge and a view are together."""
    edges = np.concatenate([triangles[:, (i, (i + 1) % 3)] for i in range(3)])
    edges.sort(axis=1)
    owner = np.tile(face, 3)
    order = np.lexsort((edges[:, 0], edges[:, 1]))
    edges, owner = edges[order], owner[order]
    shared = (edges[1:] == edges[:-1]).all(axis=1)
    a, b = owner[:-1][shared], owner[1:][shared]
    alike = views[a] == views[b]
    return _components(len(views), a[alike], b[alike])


def _components(count: int, a: Array, b: Array) -> Array:
    """Least number of the nodes that each node is connected to by pairs."""
    label = np.arange(count)
    while True:
        low = np.minimum(label[a], label[b])
        found = label.copy()
        for ends in (label[a], label[b], a, b):
            np.minimum.at(found, ends, low)
        found = found[found]
        if np.array_equal(found, label):
            return label
        label = found


def _packed(flat: Array, chart: Array) -> Array:
    """Moves charts into rows of a unit square."""
    _, chart = np.unique(chart, return_inverse=True)
    count = int(chart.max()) + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    for i in range(3):
        np.minimum.at(low, chart, flat[:, i])
        np.maximum.at(high, chart, flat[:, i])
    size = high - low
    gutter = min(_GUTTER, 0.25 / np.sqrt(count))
    room = float(size.prod(axis=1).sum()) or 1.0
    scale = np.sqrt(_FILL / room)
    while True:
        corner = _rows(size * scale + gutter)
        if corner is not None:
            break
        scale *= _SHRINK
    return np.asarray((flat - low[chart][:, None]) * scale + (corner + gutter / 2)[chart][:, None])


def _rows(size: Array) -> Array | None:
    """Corners of boxes that stand in rows, the tallest first; None: the square is too small."""
    if size.max() > 1:
        return None
    order = np.argsort(-size[:, 1], kind="stable")
    ends = np.cumsum(size[order, 0])
    corner = np.zeros_like(size)
    start, top = 0, 0.0
    while start < len(order):
        before = ends[start - 1] if start else 0.0
        end = max(int(np.searchsorted(ends, before + 1.0, "right")), start + 1)
        row = order[start:end]
        corner[row, 0] = ends[start:end] - size[row, 0] - before
        corner[row, 1] = top
        top += size[order[start], 1]
        if top > 1:
            return None
        start = end
    return corner


def _folded(placed: Array, face: Array) -> Array:
    """Faces that share texels with others."""
    raster = rasterized(placed.astype(np.float64) * _PROBE, (_PROBE, _PROBE))
    twice = raster.covers > 1
    found = np.zeros(int(face.max()) + 1, bool)
    seen = raster.triangle[twice]
    found[face[seen[seen >= 0]]] = True
    return found
