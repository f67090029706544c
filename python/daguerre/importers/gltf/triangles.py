"""Reads triangles of a primitive: lists, strips and fans, indexed or not.

Source: glTF 2.0 specification, chapters 3.7.2.1 and 5.24.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item

from .accessors import Accessors


def triangles_of(
    primitive: Item, indices: Item | None, mode: int, count: int, accessors: Accessors
) -> NDArray[np.uint32]:
    """Vertex indices below ``count``, shape (triangles, 3), for mode 4, 5 or 6."""
    if indices is None:
        where, corners = primitive, np.arange(count, dtype=np.uint32)
    else:
        where, corners = indices, accessors.integers(indices)
        bad = np.flatnonzero(corners >= count)
        if bad.size:
            indices.fail(
                f"element {bad[0]}: index out of range: wanted 0 .. {count - 1} (vertices), "
                f"got {corners[bad[0]]} ({bad.size} such elements)"
            )
    if mode == 4:
        if len(corners) % 3:
            where.fail(f"wrong number of corners: wanted a multiple of 3, got {len(corners)}")
        return corners.reshape(-1, 3)
    if len(corners) < 3:
        where.fail(f"wrong number of corners: wanted at least 3, got {len(corners)}")
    if mode == 5:
        # Every second triangle of a strip is reversed, so that all wind alike (3.7.2.1).
        i = np.arange(len(corners) - 2)
        strip = np.stack([corners[:-2], corners[i + 1 + i % 2], corners[i + 2 - i % 2]], axis=1)
        a, b, c = strip.T
        # Triangles without an area only stitch strips together.
        kept: NDArray[np.uint32] = strip[(a != b) & (b != c) & (a != c)]
        return kept
    hub = np.full(len(corners) - 2, corners[0], np.uint32)
    return np.stack([corners[1:-1], corners[2:], hub], axis=1)
