"""Loop surfaces: triangles, regular with six faces.

Sources: Loop 1987; Hoppe et al. 1994 (limit, creases). The tangent at a crease is the left
eigenvector of its ring's map, derived in ``creases.py``.
"""

from __future__ import annotations

import math

import numpy as np

from .creases import across
from .level import Level
from .rules import FloatArray
from .scheme import Scheme
from .split import into_triangles


class Loop(Scheme):
    """Weights of Loop."""

    regular = 6
    quads = False
    edge = (3 / 8, 3 / 8, 1 / 8, 1 / 8)

    def split(self, level: Level, final: bool) -> Level:
        """Topology of the next level; ``final``: there is none after it."""
        return into_triangles(level, final)

    def smooth(self, valence: int) -> FloatArray:
        """Weights of a smooth vertex: vertex, neighbors."""
        beta = _beta(valence)
        return np.array([1 - valence * beta, *[beta] * valence])

    def smooth_limit(self, valence: int) -> FloatArray:
        """Limit of a smooth vertex, weights of the ring, shape (1 + n, 3)."""
        n = valence
        turn = 2 * np.pi * np.arange(n) / n
        near = 1 / (n + 3 / (8 * _beta(n)))
        weights = np.zeros((1 + n, 3))
        weights[:, 0] = [1 - n * near, *[near] * n]
        weights[1:, 1], weights[1:, 2] = np.cos(turn), np.sin(turn)
        return weights

    def crease_tangent(self, faces: int) -> FloatArray:
        """Tangent into the surface at a crease, weights of an open ring, shape (2 + k,)."""
        k = faces
        if k == 1:
            return np.array([-2.0, 1.0, 1.0])
        spokes = np.sin(np.pi * np.arange(1, k) / k)
        eigenvalue = 3 / 8 + math.cos(math.pi / k) / 4
        vertex, end = across(eigenvalue, spokes[0] / 8, 3 / 8 * spokes.sum())
        return np.array([vertex, end, *spokes, end])

    def pulled(self, weights: FloatArray, vertex: FloatArray, blend: FloatArray) -> FloatArray:
        """Pulls weights on the ring of the next level back to weights on the ring of this level.

        Only the outer spokes of an open ring differ: they are creases, and do not depend on
        neighbors, which would be missing before the first and after the last spoke.
        """
        own, spokes = weights[:, :1], weights[:, 1:]
        sharp, soft = blend[:, :, None] / 2, 1 - blend[:, :, None]
        result = vertex[:, :, None] * own
        result[:, :1] += (spokes * (sharp + soft * 3 / 8)).sum(axis=1, keepdims=True)
        side = spokes * soft / 8
        result[:, 1:] += spokes * (sharp + soft * 3 / 8)
        result[:, 1:] += np.roll(side, 1, axis=1) + np.roll(side, -1, axis=1)
        return np.asarray(result)


def _beta(valence: int) -> float:
    """Weight of each neighbor of a smooth vertex (Loop 1987)."""
    return (5 / 8 - (3 / 8 + math.cos(2 * math.pi / valence) / 4) ** 2) / valence
