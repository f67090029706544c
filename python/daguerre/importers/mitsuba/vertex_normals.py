"""Vertex normals of meshes without normals: means of the adjacent faces, weighted by their angles.

Source: Thurmer and Wuthrich 1998, Computing vertex normals from polygonal facets; Mitsuba 3 uses
this rule for every mesh unless ``face_normals`` is set.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def vertex_normals(
    positions: NDArray[np.float32], corners: NDArray[np.uint32], sizes: NDArray[np.uint32] | None
) -> NDArray[np.float32]:
    """Normals of vertices.

    Args:
        positions: Shape (N, 3).
        corners: Vertices of the faces' corners, shape (C,).
        sizes: Corners of each face, shape (F,); None: triangles.

    Returns:
        Shape (N, 3); +z where no face of any area is.
    """
    points = positions.astype(np.float64)
    index = corners.astype(np.int64).reshape(-1)
    before, after = _neighbours(len(index), sizes)
    here = points[index]
    to_next, to_last = points[index[after]] - here, points[index[before]] - here
    across = np.cross(to_next, to_last)
    lengths = np.linalg.norm(across, axis=1)
    angles = np.arctan2(lengths, np.einsum("ij,ij->i", to_next, to_last))
    faces = _of_faces(across, sizes)
    sums = np.zeros_like(points)
    np.add.at(sums, index, faces * angles[:, None])
    norms = np.linalg.norm(sums, axis=1, keepdims=True)
    made = np.where(norms > 0, sums / np.where(norms > 0, norms, 1), (0.0, 0.0, 1.0))
    return np.ascontiguousarray(made, np.float32)


def lie_against(
    positions: NDArray[np.float32],
    corners: NDArray[np.uint32],
    sizes: NDArray[np.uint32] | None,
    normals: NDArray[np.float32],
) -> bool:
    """Whether faces look the other way than normals do, by their areas.

    Args:
        positions: Shape (N, 3).
        corners: Vertices of the faces' corners, shape (C,).
        sizes: Corners of each face, shape (F,); None: triangles.
        normals: Normals of vertices or of corners, shape (N, 3) or (C, 3).
    """
    index = corners.astype(np.int64).reshape(-1)
    points = positions.astype(np.float64)[index]
    before, after = _neighbours(len(index), sizes)
    across = np.cross(points[after] - points, points[before] - points)
    by_corner = len(normals) == len(index) != len(positions)
    return float((across * (normals if by_corner else normals[index])).sum()) < 0


def _neighbours(count: int, sizes: NDArray[np.uint32] | None) -> tuple[Integers, Integers]:
    """Corners before and after each corner of its face."""
    corner = np.arange(count)
    if sizes is None:
        begins, lengths = corner - corner % 3, np.full(count, 3)
    else:
        ends = np.cumsum(sizes.astype(np.int64))
        begins = np.repeat(ends - sizes, sizes)
        lengths = np.repeat(sizes.astype(np.int64), sizes)
    place = corner - begins
    return begins + (place - 1) % lengths, begins + (place + 1) % lengths


def _of_faces(across: Floats, sizes: NDArray[np.uint32] | None) -> Floats:
    """Unit normals of faces, one per corner."""
    count = np.full(len(across) // 3, 3) if sizes is None else sizes.astype(np.int64)
    face = np.repeat(np.arange(len(count)), count)
    sums = np.zeros((len(count), 3))
    np.add.at(sums, face, across)
    norms = np.linalg.norm(sums, axis=1, keepdims=True)
    return (sums / np.where(norms > 0, norms, 1))[face]
