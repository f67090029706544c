"""Normalization of glTF normals and tangents after quantisation, morphs and skins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.files.notes import Notes

FloatArray = NDArray[np.float32]


def unit_normals(
    normals: FloatArray, positions: FloatArray, triangles: NDArray[np.uint32], notes: Notes
) -> FloatArray:
    """Normalizes normals; one of length 0 becomes the normal of an adjacent face."""
    lengths = np.sqrt(np.einsum("ij,ij->i", normals, normals, dtype=np.float64))
    empty = lengths == 0
    if empty.any():
        a, b, c = (positions[triangles[:, k]].astype(np.float64) for k in range(3))
        faces = np.cross(b - a, c - a)
        by_vertex = np.zeros_like(positions, np.float64)
        by_vertex[triangles.ravel()] = np.repeat(faces, 3, axis=0)
        normals[empty] = by_vertex[empty]
        lengths[empty] = np.linalg.norm(by_vertex[empty], axis=1)
        lost = lengths == 0
        normals[lost], lengths[lost] = (0, 1, 0), 1
        notes.add("a vertex normal of length 0 is replaced", int(empty.sum()))
    normals /= lengths[:, None]
    return normals


def unit_tangents(tangents: FloatArray | None, notes: Notes) -> FloatArray | None:
    """Normalizes tangents and their signs; drops all if any has length 0."""
    if tangents is None:
        return None
    lengths = np.linalg.norm(tangents[:, :3].astype(np.float64), axis=1)
    if (lengths == 0).any():
        notes.add("tangents of length 0: the mesh's tangents are derived from its uv")
        return None
    tangents[:, :3] = tangents[:, :3] / lengths[:, None]
    tangents[:, 3] = np.where(tangents[:, 3] < 0, -1, 1)
    return tangents
