"""Tangent across a crease: the left eigenvector of the map of an open ring.

Inside, its weights are sines that vanish on the crease, as for a smooth vertex with twice the
number of faces. The weights a of the vertex and b of both ends follow from the rows of the crease:
v' = 3/4 v + (e + e')/8 and e' = (v + e)/2::

    lambda b = a/8 + b/2 + r
    lambda a = 3/4 a + b + t

r and t are the contributions of inner points to an end and to the vertex.
"""

from __future__ import annotations


def across(eigenvalue: float, to_end: float, to_vertex: float) -> tuple[float, float]:
    """Weights (vertex, end) of the tangent across a crease of at least two faces."""
    one, other = eigenvalue - 1 / 2, eigenvalue - 3 / 4
    end = (to_vertex + 8 * other * to_end) / (8 * one * other - 1)
    return 8 * (one * end - to_end), end
