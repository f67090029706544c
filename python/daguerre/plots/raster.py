"""Paints the section of a lens as pixels, for programs that show no SVG. It needs numpy alone."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .lens_section import Drawing, Polygon

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

#: Opacity of glass, as in the SVG.
GLASS = 0.45
#: Width of the outline of glass, px.
OUTLINE = 1.0


def painted(drawing: Drawing, longest: int = 512) -> NDArray[np.float32]:
    """Paints a drawing on white, with smooth edges; dashes are left out.

    Args:
        drawing: The drawing.
        longest: Length of the longer side, px; the other follows the drawing's window.

    Returns:
        sRGB values, 0 to 1, shape (H, W, 3), row 0 on top.
    """
    span, tall = drawing.right - drawing.left, 2 * drawing.top
    scale = longest / max(span, tall)
    height, width = (max(1, round(side * scale)) for side in (tall, span))
    picture = np.ones((height, width, 3))
    for shape in drawing.shapes:
        points = (np.asarray(shape.points) - (drawing.left, drawing.top)) * (scale, -scale)
        if isinstance(shape, Polygon):
            _blend(picture, GLASS * _inside(points, (height, width)), shape.fill)
            points = np.vstack([points, points[:1]])
        thick = OUTLINE if isinstance(shape, Polygon) else shape.width
        _blend(picture, _stroke(points, thick, (height, width)), shape.stroke)
    return picture.astype(np.float32)


def _blend(picture: FloatArray, cover: FloatArray, color: str) -> None:
    """Lays a color such as ``#c0392b`` over the picture, by the share of each pixel."""
    rgb = np.array([int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)])
    met = np.nonzero(cover)
    picture[met] += cover[met][:, None] * (rgb - picture[met])


def _stroke(points: FloatArray, width: float, shape: tuple[int, int]) -> FloatArray:
    """Share of each pixel under a polyline (x, y), px."""
    cover = np.zeros(shape)
    reach = width / 2 + 0.5
    for a, b in pairwise(points):
        if not np.isfinite([a, b]).all():
            continue
        x, y = _near(a, b, reach, shape)
        p = np.stack([x + 0.5, y + 0.5], axis=-1) - a
        along = b - a
        share = np.clip(p @ along / max(float(along @ along), 1e-12), 0, 1)
        away = np.linalg.norm(p - share[:, None] * along, axis=-1)
        cover[y, x] = np.maximum(cover[y, x], np.clip(reach - away, 0, 1))
    return cover


def _near(
    a: FloatArray, b: FloatArray, reach: float, shape: tuple[int, int]
) -> tuple[IntArray, IntArray]:
    """Columns and rows of the pixels near a segment, each once."""
    run = int(abs(b[1] - a[1]) > abs(b[0] - a[0]))  # axis along which it runs farther
    size = shape[1 - run], shape[run]
    low, high = np.clip([min(a[run], b[run]) - reach, max(a[run], b[run]) + reach], 0, size[0])
    along = np.arange(int(low), int(np.ceil(high)))
    slope = (b[1 - run] - a[1 - run]) / (b[run] - a[run]) if a[run] != b[run] else 0.0
    middle = np.clip(a[1 - run] + slope * (along + 0.5 - a[run]), -size[1], 2 * size[1])
    side = int(np.ceil(1.5 * reach)) + 1  # lines of 45 degrees reach farther across
    across = np.floor(middle).astype(int)[:, None] + np.arange(-side, side + 1)
    along = np.broadcast_to(along[:, None], across.shape)
    is_on = (across >= 0) & (across < size[1])
    pair = along[is_on], across[is_on]
    return pair[run], pair[1 - run]


def _inside(points: FloatArray, shape: tuple[int, int]) -> FloatArray:
    """1 where a pixel's middle lies inside a closed polygon (x, y), by the parity of crossings."""
    y, x = (np.arange(count) + 0.5 for count in shape)
    inside = np.zeros(shape, bool)
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        rows = (ay > y) != (by > y)
        if rows.any():
            crossing = ax + (y[rows] - ay) * (bx - ax) / (by - ay)
            inside[rows] ^= x < crossing[:, None]
    return inside.astype(np.float64)
