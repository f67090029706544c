"""Transforms as 4x4 matrices that act on column vectors.

Source: glTF 2.0 specification, chapter 3.5.3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.files.json_item import Item

from .limits import invertible

Matrix = NDArray[np.float64]
#: Description for notes of a transform with a rank below 3.
FLAT = "scaled to zero or sheared flat"


def affine(matrices: Matrix, item: Item) -> Matrix:
    """Sets the last row of matrices (..., 4, 4) to exactly 0, 0, 0, 1; it must be close to that."""
    last = matrices[..., 3, :].reshape(-1, 4)
    bad = np.flatnonzero(np.abs(last - (0, 0, 0, 1)).max(axis=1) > 1e-5)
    if bad.size:
        item.fail(f"wanted 0, 0, 0, 1 as its last row, got {last[bad[0]].tolist()}")
    matrices[..., 3, :] = (0, 0, 0, 1)
    return matrices


def compose(t: Matrix, q: Matrix, s: Matrix) -> Matrix:
    """Composes translation (..., 3), rotation (..., 4; unit x, y, z, w) and scale (..., 3)."""
    x, y, z, w = q.tolist() if q.ndim == 1 else q.T  # single floats are faster than arrays
    rows = np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)),
        )
    )
    matrix = np.zeros((*q.shape[:-1], 4, 4))
    matrix[..., :3, :3] = (rows if q.ndim == 1 else rows.transpose(2, 0, 1)) * s[..., None, :]
    matrix[..., :3, 3] = t
    matrix[..., 3, 3] = 1
    return matrix


def without_scale(world: Matrix) -> Matrix | None:
    """Removes scale from a transform, keeping position, -z and +y; None if an axis is degenerate.

    Cameras and lights ignore the scale of their node (glTF 2.0, 3.10; KHR_lights_punctual).
    """
    z, y = world[:3, 2], world[:3, 1]
    x = _cross(y, z)
    lengths = np.linalg.norm(z), np.linalg.norm(x)
    if lengths[0] < 1e-20 or lengths[1] < 1e-30:
        return None
    rigid = np.eye(4)
    rigid[:3, 2] = z / lengths[0]
    rigid[:3, 0] = x / lengths[1]
    rigid[:3, 1] = _cross(rigid[:3, 2], rigid[:3, 0])
    rigid[:3, 3] = world[:3, 3]
    return rigid


def _cross(a: Matrix, b: Matrix) -> Matrix:
    """Cross product of two vectors; NumPy's takes ten times as long for one pair."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array((a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0))


def ranks(linear: Matrix) -> NDArray[np.int64]:
    """Ranks of transforms, shape (N, 3, 3); 2 also where single precision cannot invert them."""
    volumes, sizes = np.abs(np.linalg.det(linear)), np.abs(linear).max(axis=(1, 2))
    found = np.full(len(linear), 3)
    solid = (volumes > 1e-30) & (volumes > 1e-12 * sizes**3) & invertible(linear)
    for i in np.flatnonzero(~solid):
        rank = int(np.linalg.matrix_rank(linear[i], tol=1e-12 * sizes[i]))
        found[i] = min(rank, 2)
    return found
