"""Values per corner, refined as a separate surface that is cut at seams, which have own rules."""

from __future__ import annotations

import numpy as np

from daguerre.scene.polygons import weld

from .cut import BoolArray, Cut, Opened, opened_level
from .faces import Faces, Fans, fans
from .level import CLOSED, DART, OPEN
from .rules import INFINITE, FloatArray, IntArray


def value_indices(vertices: IntArray, values: FloatArray) -> IntArray:
    """Representative of each corner: the first corner with the same vertex and value.

    Args:
        vertices: Vertex of each corner, shape (C,).
        values: Shape (C, K).
    """
    # Adding 0 makes -0 the same as 0.
    leaders, index = weld(vertices, values + 0.0)
    return leaders[index]


def cut_values(faces: Faces, opened: Opened, rule: str, values: IntArray) -> Cut:
    """Cuts a mesh at its seams, besides its boundaries and infinitely sharp creases.

    Args:
        faces: The control mesh.
        opened: The mesh, opened along boundaries and infinitely sharp creases.
        rule: One of ``FACE_VARYING``, but "all".
        values: Number of the value of each corner, shape (C,).
    """
    edges, seam = opened.edges, _seams(faces, values)
    twins = np.where(seam, -1, opened.twins)
    found = fans(faces, twins)
    vertex, value = faces.vertices[found.heads], values[found.heads]
    kinds = np.where(found.opened, OPEN, CLOSED).astype(np.uint8)
    at_seam = _at(faces, seam)
    slit = found.opened & _ends_meet(faces, found)
    kinds[slit] = DART
    infinite = edges >= INFINITE
    inner = infinite & (np.bincount(faces.edges[1], minlength=len(edges)) > 1)
    facts = _Facts(vertex, value, found.sizes, at_seam, _at(faces, inner[faces.edges[1]]))
    sharp = facts.corners(rule, _at(faces, faces.twins < 0)) & found.opened
    sharpness = np.where(sharp, INFINITE, opened.corners.sharpness[vertex])
    return Cut(opened_level(faces, twins, found, kinds, edges, sharpness), value)


def _seams(faces: Faces, values: IntArray) -> BoolArray:
    """Whether the values at either end of a half-edge differ on both sides, shape (C,)."""
    twin = np.where(faces.twins >= 0, faces.twins, 0)
    differ = values != values[faces.after[twin]]
    differ |= values[faces.after] != values[twin]
    return np.asarray(differ & (faces.twins >= 0))


def _at(faces: Faces, halves: BoolArray) -> BoolArray:
    """Whether a vertex has one of some half-edges, shape (N,)."""
    found = np.zeros(faces.count, bool)
    found[faces.vertices[halves]] = True
    found[faces.vertices[faces.after[halves]]] = True
    return found


def _ends_meet(faces: Faces, found: Fans) -> BoolArray:
    """Whether a fan begins and ends at the same edge, shape (V,)."""
    edge_of = faces.edges[1]
    return np.asarray(edge_of[found.heads] == edge_of[faces.before[found.tails]])


class _Facts:
    """Fans at seams: which of them are corners.

    Args:
        vertex: Control vertex of each fan, shape (V,).
        value: Value of each fan, shape (V,).
        sizes: Faces of each fan, shape (V,).
        seam: Whether a control vertex has a seam, shape (N,).
        creased: Whether a control vertex has an infinitely sharp edge of two faces, shape (N,).
    """

    def __init__(
        self,
        vertex: IntArray,
        value: IntArray,
        sizes: IntArray,
        seam: BoolArray,
        creased: BoolArray,
    ) -> None:
        self._vertex, self._sizes = vertex, sizes
        self._seam, self._creased = seam[vertex], creased[vertex]
        span = int(value.max(initial=0)) + 1
        keys, pair = np.unique(vertex * span + value, return_inverse=True)
        self._values = np.bincount(keys // span, minlength=len(seam))[vertex]
        self._parts = np.bincount(pair)[pair] if len(vertex) else self._values

    def corners(self, rule: str, boundary: BoolArray) -> BoolArray:
        """Whether each fan keeps its value, shape (V,).

        Args:
            rule: One of ``FACE_VARYING``, but "all".
            boundary: Whether a control vertex has an edge without a pair, shape (N,).
        """
        outer = boundary[self._vertex]
        if rule == "boundaries":
            return self._seam | outer
        # A value of several fans, apart or beside a crease, is no smooth curve.
        found = self._seam & (self._parts > 1)
        if rule == "none":
            return found
        found |= (self._sizes == 1) & (self._seam | outer)
        if rule == "corners only":
            return found
        found |= self._values > 2
        found |= (self._values == 2) & self._seam & self._creased
        if rule == "corners plus2":
            single = np.zeros(len(boundary), bool)
            single[self._vertex[self._sizes == 1]] = True
            found |= (self._values == 2) & self._seam & single[self._vertex]
            found |= self._seam & (self._values == 1) & ~outer
        return found


def linear_corners(faces: Faces, quads: bool, levels: int, values: FloatArray) -> FloatArray:
    """Values of refined corners, linear on each face.

    Args:
        faces: The control mesh.
        quads: Whether faces become quadrangles; else they are triangles.
        levels: Number of levels.
        values: Value of each control corner, shape (C, K).
    """
    after, before = faces.after, faces.before
    for level in range(levels):
        half = (values + values[after]) / 2
        if quads:
            starts = faces.starts[:-1] if level == 0 else np.arange(0, len(values), 4)
            sizes = faces.sizes if level == 0 else np.full(len(starts), 4)
            middle = np.add.reduceat(values, starts, axis=0) / sizes[:, None]
            middle = np.repeat(middle, sizes, axis=0)
            parts = np.stack([values, half, middle, half[before]], axis=1)
        else:
            outer = np.stack([values, half, half[before]], axis=1).reshape(-1, 9, values.shape[1])
            parts = np.concatenate([outer, half.reshape(-1, 3, values.shape[1])], axis=1)
        values = parts.reshape(-1, values.shape[1])
        size = 4 if quads else 3
        corner = np.arange(len(values))
        after = corner - corner % size + (corner + 1) % size
        before = corner - corner % size + (corner + size - 1) % size
    return values
