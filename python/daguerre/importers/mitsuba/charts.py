"""Mapping of texture coordinates on a mesh, for normal maps and bump maps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.parts import Mesh

from .look import Chart


def chart_of(mesh: Mesh, world: NDArray[np.float64]) -> Chart:
    """Chart of a mesh in the scene.

    Args:
        mesh: Triangles; the chart is the default without texture coordinates.
        world: Scene from the mesh, shape (4, 4).
    """
    if mesh.uv is None or not len(mesh.indices):
        return Chart()
    points = mesh.positions.astype(np.float64) @ world[:3, :3].T
    a, b, c = (points[mesh.indices[:, k]] for k in range(3))
    s, t, r = (mesh.uv[mesh.indices[:, k]].astype(np.float64) for k in range(3))
    edges = np.stack([b - a, c - a], axis=1)  # shape (M, 2, 3)
    steps = np.stack([t - s, r - s], axis=1)
    areas = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
    turns = np.linalg.det(steps)
    good = np.abs(turns) > 1e-12
    if not areas[good].sum() > 0:
        return Chart()
    tangents = np.linalg.solve(steps[good], edges[good])  # dp/du and dp/dv, shape (K, 2, 3)
    weights = areas[good] / areas[good].sum()
    u, v = (float(weights @ np.linalg.norm(tangents[:, k], axis=1)) for k in range(2))
    mirrored = np.linalg.det(world[:3, :3]) < 0
    counter_clockwise = float(weights @ np.sign(turns[good])) > 0
    return Chart(counter_clockwise != mirrored, (max(u, 1e-12), max(v, 1e-12)))
