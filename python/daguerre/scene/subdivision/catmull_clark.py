"""Catmull-Clark surfaces: quadrangles, smooth but for four vertices, regular with four faces.

Sources: Catmull and Clark 1978; Halstead, Kass and DeRose 1993 (limit); Stam 1998, SIGGRAPH, 395.
The tangent at a crease is the left eigenvector of its ring's map, derived in ``creases.py``.
"""

from __future__ import annotations

import math

import numpy as np

from .creases import across
from .level import Level
from .rules import FloatArray
from .scheme import Scheme
from .split import into_quads


class CatmullClark(Scheme):
    """Weights of Catmull and Clark."""

    regular = 4
    quads = True
    edge = (1 / 4, 1 / 4, 1 / 4, 1 / 4)

    def split(self, level: Level, final: bool) -> Level:
        """Topology of the next level; ``final``: there is none after it."""
        return into_quads(level, final)

    def smooth(self, valence: int) -> FloatArray:
        """Weights of a smooth vertex: vertex, neighbors, face points."""
        n = valence
        weights = np.full(1 + 2 * n, 1 / n**2)
        weights[0] = (n - 2) / n
        return weights

    def smooth_limit(self, valence: int) -> FloatArray:
        """Limit of a smooth vertex, weights of the ring, shape (1 + 2 n, 3)."""
        n = valence
        turn = 2 * np.pi * np.arange(n + 1) / n
        factor = _factor(2 * math.pi / n)
        weights = np.zeros((1 + 2 * n, 3))
        weights[:, 0] = [n * n, *[4] * n, *[1] * n]
        weights[:, 0] /= n * (n + 5)
        for column, wave in ((1, np.cos(turn)), (2, np.sin(turn))):
            weights[1 : 1 + n, column] = factor * wave[:-1]
            weights[1 + n :, column] = wave[:-1] + wave[1:]
        return weights

    def crease_tangent(self, faces: int) -> FloatArray:
        """Tangent into the surface at a crease, weights of an open ring, shape (2 + 2 k,)."""
        k = faces
        weights = np.zeros(2 + 2 * k)
        if k == 1:
            weights[:3] = -2, 1, 1
            return weights
        wave = np.sin(np.pi * np.arange(k + 1) / k)
        factor = _factor(math.pi / k)
        spokes, opposite = factor * wave[1:-1], wave[:-1] + wave[1:]
        to_end = spokes[0] / 16 + opposite[0] / 4
        to_vertex = 3 / 8 * spokes.sum() + opposite.sum() / 4
        vertex, end = across((factor + 4) / 16, to_end, to_vertex)
        weights[:] = [vertex, end, *spokes, end, *opposite]
        return weights

    def pulled(self, weights: FloatArray, vertex: FloatArray, blend: FloatArray) -> FloatArray:
        """Pulls weights on the ring of the next level back to weights on the ring of this level."""
        count = blend.shape[1]
        closed = weights.shape[1] == 1 + 2 * count
        own, spokes, opposite = weights[:, :1], weights[:, 1 : 1 + count], weights[:, 1 + count :]
        sharp, soft = blend[:, :, None] / 2, (1 - blend[:, :, None]) / 4
        result = vertex[:, :, None] * own
        result[:, :1] += (spokes * (sharp + soft)).sum(axis=1, keepdims=True)
        result[:, 1 : 1 + count] += spokes * (sharp + soft)
        side = spokes * soft  # weight of each of the two face points beside a spoke
        other = np.roll(side, -1, axis=1) if closed else side[:, 1:]
        points = result[:, 1 + count :] + opposite + other + (side if closed else side[:, :-1])
        result[:, :1] += points.sum(axis=1, keepdims=True) / 4
        if closed:
            result[:, 1 : 1 + count] += (points + np.roll(points, 1, axis=1)) / 4
        else:
            result[:, 1:count] += points / 4
            result[:, 2 : 1 + count] += points / 4
        result[:, 1 + count :] = points / 4
        return np.asarray(result)


def _factor(angle: float) -> float:
    """Weight of neighbors in a tangent, against 1 for opposite corners (Halstead et al. 1993)."""
    cosine = math.cos(angle)
    return 1 + cosine + math.cos(angle / 2) * math.sqrt(2 * (9 + cosine))
