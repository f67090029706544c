"""Blends the transforms of joints at vertices (linear blend skinning)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value

FloatArray = NDArray[np.float32]
# Vertices at a time, as their matrices need far more memory than their positions.
_CHUNK = 1 << 15


@dataclass(frozen=True, eq=False)
class Influences(Value):
    """Joints that move the vertices of a mesh, and their weights.

    Attributes:
        joints: Indices into the joints of the skin, one array (N, 4) for each set.
        weights: Weights in the same shape; the sum over all sets is 1 at each vertex.
    """

    joints: list[NDArray[Any]]
    weights: list[FloatArray]


def blended(
    found: Influences, matrices: NDArray[np.float64], count: int
) -> Iterator[tuple[slice, NDArray[np.float64]]]:
    """Blends the transforms of joints at vertices, some vertices at a time.

    Args:
        found: Joints and weights of the vertices.
        matrices: Transform of each joint, shape (joints, 4, 4).
        count: Number of vertices.

    Yields:
        Vertices, and the upper three rows of their transforms, shape (N, 3, 4).
    """
    rows = matrices[:, :3].reshape(-1, 12)
    for start in range(0, count, _CHUNK):
        piece = slice(start, start + _CHUNK)
        blend = sum(
            np.einsum("nk,nkm->nm", weights[piece].astype(np.float64), rows[joints[piece]])
            for joints, weights in zip(found.joints, found.weights, strict=True)
        )
        yield piece, np.asarray(blend).reshape(-1, 3, 4)
