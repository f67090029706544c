"""Whether two scenes have the same triangles in the world, in any order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import daguerre as dg

#: Longest distance between centroids of the same triangle, m.
NEAR = 1e-5


def triangles_of(scene: dg.Scene) -> dict[str, NDArray[np.float64]]:
    """Values of all triangles, each of shape (T, K): centroid, facing, shading and uv.

    ``facing`` is the unit normal times the area. Meshes without normals or uv have zeros.
    """
    found: dict[str, list[NDArray[np.float64]]] = {}
    for instance in scene.instances:
        mesh, place = scene.meshes[instance.mesh], instance.transform
        turn = place[:3, :3]
        corners = mesh.positions[mesh.indices].astype(float) @ turn.T + place[:3, 3]
        a, b, c = np.moveaxis(corners, 1, 0)
        shading = np.zeros((len(a), 3))
        if mesh.normals is not None:
            rows = mesh.normals[mesh.indices].astype(float).mean(axis=1)
            shading = rows @ np.linalg.inv(turn)
        uv = np.zeros((len(a), 2))
        if mesh.uv is not None:
            uv = mesh.uv[mesh.indices].astype(float).mean(axis=1)
        flip = np.sign(np.linalg.det(turn))
        values = {
            "centroid": corners.mean(axis=1),
            "facing": flip * np.cross(b - a, c - a) / 2,
            "shading": shading,
            "uv": uv,
        }
        for name, rows in values.items():
            found.setdefault(name, []).append(rows)
    return {name: np.concatenate(rows) for name, rows in found.items()}


def triangle_differences(a: dg.Scene, b: dg.Scene) -> list[str]:
    """Says how the triangles of scenes differ; empty: they are the same."""
    one, other = triangles_of(a), triangles_of(b)
    counts = len(one["centroid"]), len(other["centroid"])
    if counts[0] != counts[1]:
        return [f"{counts[0]} and {counts[1]} triangles"]
    # Triangles at one place differ in their sides; areas in m2 become lengths beside it.
    keys = [np.hstack([x["centroid"], _unit(x["facing"]) * NEAR]) for x in (one, other)]
    distances, index = cKDTree(keys[1]).query(keys[0])
    out = []
    if distances.max() > NEAR:
        out.append(f"{(distances > NEAR).sum()} triangles are elsewhere, by {distances.max():.3g}")
    if len(np.unique(index)) < len(index):
        out.append(f"{len(index) - len(np.unique(index))} triangles are there several times")
    for name, tolerance in (("facing", 1e-8), ("shading", 1e-4), ("uv", 1e-5)):
        apart = np.abs(one[name] - other[name][index]).max(axis=1)
        if apart.max() > tolerance:
            out.append(f"{name}: {(apart > tolerance).sum()} differ, by {apart.max():.3g}")
    return out


def _unit(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    return rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-300)
