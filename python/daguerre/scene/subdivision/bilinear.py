"""Bilinear surfaces: quadrangles, divided without smoothing.

Each control face has its own normals, so the mesh is cut along all edges. Four corners span a
bilinear patch; the tangents of ``Scheme.limit`` at corners are exact for it.
"""

from __future__ import annotations

import numpy as np

from .level import Level
from .rules import FloatArray
from .scheme import Scheme
from .split import into_quads


class Bilinear(Scheme):
    """Means of corners; no weights of a smooth surface are asked for."""

    regular = 4
    quads = True
    linear = True
    edge = (1 / 2, 1 / 2, 0.0, 0.0)

    def split(self, level: Level, final: bool) -> Level:
        """Topology of the next level; ``final``: there is none after it."""
        return into_quads(level, final)

    def smooth(self, valence: int) -> FloatArray:
        """Weights of a vertex: itself."""
        return np.asarray(np.eye(1 + 2 * valence)[0])

    def smooth_limit(self, valence: int) -> FloatArray:
        """Position and tangents of a vertex, as ``limit`` gives them for all kinds."""
        raise NotImplementedError("a bilinear vertex is a corner")

    def crease_tangent(self, faces: int) -> FloatArray:
        """Tangent at a crease, as ``limit`` gives it for all kinds."""
        raise NotImplementedError("a bilinear vertex is a corner")

    def pulled(self, weights: FloatArray, vertex: FloatArray, blend: FloatArray) -> FloatArray:
        """Weights of a level, which no sharpness changes."""
        return weights
