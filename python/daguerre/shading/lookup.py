"""Values of a picture at given texture coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .channels import Texel

Array = NDArray[Any]


def looked_up(texel: Texel, u: object, v: object) -> Array:
    """Samples a picture at coordinates with (0, 0) at the bottom left, by its filter."""
    a, b, c, d, e, f = texel.mapping.transform
    u, v = np.asarray(u, np.float64), np.asarray(v, np.float64)
    values = texel.values()
    height, width = values.shape
    column: Array = _finite(a * u + b * v + c) * width
    row: Array = (1 - _finite(d * u + e * v + f)) * height
    across, down = texel.mapping.wrap
    if texel.mapping.filter == "nearest":
        return values[_index(np.floor(row), height, down), _index(np.floor(column), width, across)]
    column, row = column - 0.5, row - 0.5
    left: Array = np.floor(column)
    top: Array = np.floor(row)
    share_x, share_y = (column - left).astype(np.float32), (row - top).astype(np.float32)
    columns = [_index(left + i, width, across) for i in (0, 1)]
    rows = [_index(top + i, height, down) for i in (0, 1)]
    upper, lower = (
        values[at, columns[0]] * (1 - share_x) + values[at, columns[1]] * share_x for at in rows
    )
    found: Array = upper * (1 - share_y) + lower * share_y
    return found


def _finite(values: Array) -> Array:
    clipped: Array = np.clip(np.nan_to_num(values), -1e9, 1e9)
    return clipped


def _index(at: Array, count: int, wrap: str) -> NDArray[np.int64]:
    index = at.astype(np.int64)
    if wrap == "repeat":
        return index % count
    if wrap == "mirror":
        index = index % (2 * count)
        return np.minimum(index, 2 * count - 1 - index)
    return np.clip(index, 0, count - 1)
