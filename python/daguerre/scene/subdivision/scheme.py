"""A scheme of subdivision: its weights, and the limit of the ring around a vertex.

A ring is a vertex, its neighbors along the spokes, and for quadrangles the opposite corner of each
face. Weights of rings are rows (vertex, spokes, opposite corners). The ring of the next level is a
linear map of the ring, so a limit weight of the next level is one of this level (``pulled``).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import lru_cache

import numpy as np

from .level import CLOSED, OPEN, Level, softened
from .rules import INFINITE, FloatArray
from .sharpness import fan_weights, open_weights

#: Steps until weights converge; each multiplies the error by at most 0.66.
_STEPS = 100
#: Weights of a vertex on a crease and its two neighbors at the limit: a cubic B-spline.
LIMIT_VERTEX, LIMIT_END = 2 / 3, 1 / 6


class Scheme(ABC):
    """Weights of a scheme.

    Attributes:
        regular: Number of faces at a regular vertex.
        quads: Whether faces become quadrangles, with a point for each face.
        linear: Whether vertices keep their places and edges are halved.
        edge: Weights of a smooth edge: its ends, and the face points or opposite corners.
    """

    regular: int
    quads: bool
    linear: bool = False
    edge: tuple[float, float, float, float]

    @abstractmethod
    def split(self, level: Level, final: bool) -> Level:
        """Topology of the next level; ``final``: there is none after it."""

    @abstractmethod
    def smooth(self, valence: int) -> FloatArray:
        """Weights of a smooth vertex: vertex, neighbors, and points of its faces if it has them."""

    @abstractmethod
    def smooth_limit(self, valence: int) -> FloatArray:
        """Limit of a smooth vertex: weights of the ring for position and two tangents, (P, 3)."""

    @abstractmethod
    def crease_tangent(self, faces: int) -> FloatArray:
        """Tangent into the surface at a crease, weights of an open ring of so many faces, (P,)."""

    @abstractmethod
    def pulled(self, weights: FloatArray, vertex: FloatArray, blend: FloatArray) -> FloatArray:
        """Pulls weights on the ring of the next level back to weights on the ring of this level.

        Args:
            weights: Shape (M, P, J).
            vertex: Weights of the vertex of the next level, shape (M, P), as of ``smooth``.
            blend: Weight of the crease rule for each spoke, 0 to 1, shape (M, spokes). An open ring
                has one spoke more than faces, and its outer spokes are creases.
        """

    def limit(self, kind: int, faces: int, corner: bool) -> FloatArray:
        """Limit weights of a ring, position and two tangents, shape (P, 3); kept once made."""
        return _limit(self, kind, faces, corner or self.linear)

    def spokes(self, kind: int, faces: int) -> int:
        """Number of spokes of a ring."""
        return faces + (kind == OPEN)

    def ring(self, kind: int, faces: int) -> int:
        """Number of points of a ring."""
        return 1 + self.spokes(kind, faces) + (faces if self.quads else 0)

    def vertex_weights(self, kind: int, vertex: FloatArray, spokes: FloatArray) -> FloatArray:
        """Weights of the next vertex by the sharpness of vertices (M,) and spokes (M, S)."""
        if kind != OPEN:
            return fan_weights(vertex, spokes, self.smooth(spokes.shape[1]))
        count = spokes.shape[1]
        ends = open_weights(vertex)
        weights = np.zeros((len(vertex), self.ring(OPEN, count - 1)))
        weights[:, 0], weights[:, 1], weights[:, count] = ends.T
        return weights


@lru_cache(maxsize=64)
def _limit(scheme: Scheme, kind: int, faces: int, corner: bool) -> FloatArray:
    if corner:
        return _corner_limit(scheme, kind, faces)
    if kind == CLOSED:
        return scheme.smooth_limit(faces)
    return _crease_limit(scheme, faces) if kind == OPEN else _dart_limit(scheme, faces)


def _crease_limit(scheme: Scheme, faces: int) -> FloatArray:
    """Limit at a crease: limit and tangent of the crease curve, and the scheme's cross tangent."""
    weights = np.zeros((scheme.ring(OPEN, faces), 3))
    last = 1 + faces
    weights[[0, 1, last], 0] = LIMIT_VERTEX, LIMIT_END, LIMIT_END
    weights[[1, last], 1] = 1, -1
    weights[:, 2] = scheme.crease_tangent(faces)
    return weights


def _corner_limit(scheme: Scheme, kind: int, faces: int) -> FloatArray:
    """Limit at a corner: the vertex, and first harmonics of its spokes.

    The spokes of a single face are its tangents. A corner of several faces has no tangent plane;
    the harmonics span a mean plane.
    """
    weights = np.zeros((scheme.ring(kind, faces), 3))
    weights[0, 0] = 1
    count = scheme.spokes(kind, faces)
    turn = np.pi * (np.arange(count) + 0.5) / count * (1 if kind == OPEN else 2)
    weights[1 : 1 + count, 1], weights[1 : 1 + count, 2] = np.cos(turn), np.sin(turn)
    weights[0, 1:] = -weights[1:, 1:].sum(axis=0)
    return weights


def _dart_limit(scheme: Scheme, faces: int) -> FloatArray:
    """Limit at the end of a crease, by powers of the map of its ring.

    The odd tangent is the tangent of a smooth vertex, as its weights vanish on the crease. The even
    tangent is iterated from a smooth vertex, without its constant part.
    """
    vertex, blend = scheme.smooth(faces)[None], np.zeros((1, faces))
    blend[:, 0] = 1
    weights = scheme.smooth_limit(faces)[None].copy()
    for _ in range(_STEPS):
        position = weights[:, :, :1]
        weights[:, :, 1] -= position[:, :, 0] * weights[:, :, 1].sum()
        weights[:, :, 1] /= np.abs(weights[:, :, 1]).max()
        pulled = scheme.pulled(weights[:, :, :2], vertex, blend)
        weights[:, :, :2] = pulled
    return np.asarray(weights[0])


def pulled_through(
    scheme: Scheme, kind: int, weights: FloatArray, vertex: FloatArray, spokes: FloatArray
) -> FloatArray:
    """Limit weights of rings with sharpness that ends after some more levels.

    Args:
        scheme: The scheme.
        kind: CLOSED, OPEN or DART.
        weights: Limit weights of rings after their sharpness ended, shape (P, 3).
        vertex: Sharpness of the vertices, shape (M,).
        spokes: Sharpness of the spokes, shape (M, S).
    """
    levels = []
    while ((spokes > 0) & (spokes < INFINITE)).any() or ((vertex > 0) & (vertex < INFINITE)).any():
        rows = scheme.vertex_weights(kind, vertex, spokes)
        levels.append((rows, np.minimum(spokes, 1)))
        vertex, spokes = softened(vertex), softened(spokes)
    result = np.tile(weights, (len(vertex), 1, 1))
    for rows, blend in reversed(levels):
        result = scheme.pulled(result, rows, blend)
    scale = np.abs(result[:, :, 1:]).max(axis=1, keepdims=True)
    result[:, :, 1:] /= np.where(scale > 0, scale, 1)
    return result
