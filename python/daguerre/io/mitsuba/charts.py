"""How far texture coordinates reach on a mesh, for bump maps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.parts import Mesh


def lengths_of(mesh: Mesh, world: NDArray[np.float64]) -> tuple[float, float]:
    """Lengths of a unit of u and of v, m: means over the area of a mesh in the scene.

    Args:
        mesh: Triangles; without texture coordinates lengths are 1.
        world: Scene from the mesh, shape (4, 4).
    """
    if mesh.uv is None or not len(mesh.indices):
        return 1.0, 1.0
    points = mesh.positions.astype(np.float64) @ world[:3, :3].T
    a, b, c = (points[mesh.indices[:, k]] for k in range(3))
    s, t, r = (mesh.uv[mesh.indices[:, k]].astype(np.float64) for k in range(3))
    edges = np.stack([b - a, c - a], axis=1)  # shape (M, 2, 3)
    steps = np.stack([t - s, r - s], axis=1)
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    good = np.abs(np.linalg.det(steps)) > 1e-12
    if not areas[good].sum() > 0:
        return 1.0, 1.0
    tangents = np.linalg.solve(steps[good], edges[good])  # dp/du and dp/dv, shape (K, 2, 3)
    weights = areas[good] / areas[good].sum()
    u, v = (float(weights @ np.linalg.norm(tangents[:, k], axis=1)) for k in range(2))
    return max(u, 1e-12), max(v, 1e-12)
