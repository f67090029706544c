"""Rules of semi-sharp vertices: their sharpness, or their edges', ends after some levels.

Source: DeRose, Kass and Truong 1998 (semi-sharp creases, uniform); the fraction of the last level
is the mean over the edges and vertices with sharpness that ends in it, as OpenSubdiv documents.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .level import softened
from .rules import FloatArray

#: Weights of a vertex and of its two neighbors on a crease.
CREASE_VERTEX, CREASE_END = 3 / 4, 1 / 8
_SMOOTH, _CREASE, _CORNER = 0, 1, 2


def open_weights(vertex: FloatArray) -> FloatArray:
    """Weights of vertices on a crease or boundary, (vertex, end, end), shape (M, 3).

    Args:
        vertex: Sharpness of the vertices, shape (M,).
    """
    share = np.minimum(vertex, 1)[:, None]
    crease = np.array([CREASE_VERTEX, CREASE_END, CREASE_END])
    return np.asarray(share * np.eye(3)[0] + (1 - share) * crease)


def fan_weights(vertex: FloatArray, spokes: FloatArray, smooth: FloatArray) -> FloatArray:
    """Weights of vertices with a closed fan.

    Args:
        vertex: Sharpness of the vertices, shape (M,).
        spokes: Sharpness of the edges around them, shape (M, n).
        smooth: Weights of a smooth vertex: vertex, n neighbors, others; shape (P,).

    Returns:
        Weights, shape (M, P).
    """
    later_vertex, later_spokes = softened(vertex), softened(spokes)
    rule, later = _rule(vertex, spokes), _rule(later_vertex, later_spokes)
    ends = np.concatenate([spokes, vertex[:, None]], axis=1)
    ending = (ends > 0) & (np.concatenate([later_spokes, later_vertex[:, None]], axis=1) <= 0)
    number = np.maximum(ending.sum(axis=1), 1)
    share = np.minimum((ends * ending).sum(axis=1) / number, 1)
    share[(rule == later) | (rule == _SMOOTH)] = 1
    now, then = _weights(rule, spokes, smooth), _weights(later, later_spokes, smooth)
    return np.asarray(share[:, None] * now + (1 - share[:, None]) * then)


def _rule(vertex: FloatArray, spokes: FloatArray) -> NDArray[np.int64]:
    sharp = (spokes > 0).sum(axis=1)
    rule = np.where(sharp == 2, _CREASE, np.where(sharp > 2, _CORNER, _SMOOTH))
    return np.where(vertex > 0, _CORNER, rule)


def _weights(rule: NDArray[np.int64], spokes: FloatArray, smooth: FloatArray) -> FloatArray:
    """Weights by rule; a crease has exactly two sharp spokes."""
    weights = np.tile(smooth, (len(rule), 1))
    weights[rule != _SMOOTH] = 0
    weights[rule == _CORNER, 0] = 1
    crease = rule == _CREASE
    weights[crease, 0] = CREASE_VERTEX
    weights[crease, 1 : 1 + spokes.shape[1]] = CREASE_END * (spokes[crease] > 0)
    return weights
