"""Whether two scenes have the same triangles in the world, in any order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import daguerre as dg

#: Longest distance between centroids of the same triangle, m; also that between their texture
#: coordinates. Shading normals may differ by ten times as much, directions by a thousandth.
NEAR = 1e-5
#: Area of triangles without a direction, m2.
SMALL = 1e-11


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
    out = []
    if not np.isclose(*(_areas(x).sum() for x in (one, other)), rtol=1e-6):
        out.append("the surfaces have different areas")
    trees = [cKDTree(_keys(x)) for x in (one, other)]
    for first, second in (trees, trees[::-1]):
        distances, _ = second.query(first.data)
        apart = distances > NEAR
        if apart.any():
            out.append(
                f"{apart.sum()} of {counts[0]} have no counterpart, by {distances.max():.3g}"
            )
    return out


def _keys(values: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    """Rows that differ by ``NEAR`` where triangles differ: in m, or as much of other values."""
    large = _areas(values)[:, None] > SMALL
    facing = np.where(large, _unit(values["facing"]), 0) * 0.01
    return np.hstack([values["centroid"], facing, values["shading"] * 0.1, values["uv"]])


def _areas(values: dict[str, NDArray[np.float64]]) -> NDArray[np.float64]:
    return np.asarray(np.linalg.norm(values["facing"], axis=1))


def _unit(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    return rows / np.maximum(np.linalg.norm(rows, axis=1, keepdims=True), 1e-300)
