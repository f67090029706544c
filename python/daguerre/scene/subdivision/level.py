"""Faces, edges and rings of one level of a subdivision surface.

The mesh is cut (``cut.py``), so each edge has one or two faces and each vertex one fan of faces. A
corner of a face is also its half-edge to the next corner. Edges with two faces come first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from daguerre.cached import cached_property

from .rules import INFINITE, FloatArray, IntArray

#: Kinds of vertices: inside of the surface, on its edge, and the end of a sharp crease, with a fan
#: that begins and ends at the crease.
CLOSED, OPEN, DART = 0, 1, 2


@dataclass(frozen=True)
class Sharp:
    """Sharpness of few edges or vertices; all others have 0.

    Attributes:
        ids: Edges or vertices, rising, shape (S,).
        values: Sharpness, above 0, shape (S,).
    """

    ids: IntArray
    values: FloatArray

    def of(self, ids: IntArray) -> FloatArray:
        """Sharpness of edges or vertices, of any shape."""
        if not len(self.ids):
            return np.zeros(ids.shape)
        place = np.minimum(np.searchsorted(self.ids, ids), len(self.ids) - 1)
        return np.where(self.ids[place] == ids, self.values[place], 0.0)

    def after(self) -> Sharp:
        """Sharpness one level later, for the same numbers."""
        left = softened(self.values)
        return Sharp(self.ids[left > 0], left[left > 0])


class VertexGroup(NamedTuple):
    """Vertices of one kind and valence.

    Attributes:
        kind: ``CLOSED``, ``OPEN`` or ``DART``.
        valence: Number of spokes.
        special: Whether the vertices are sharp, or have a sharp spoke.
        vertices: The vertices, shape (M,).
    """

    kind: int
    valence: int
    special: bool
    vertices: IntArray


def softened(sharpness: FloatArray) -> FloatArray:
    """Sharpness one level later (uniform creases)."""
    return np.where(sharpness >= INFINITE, sharpness, np.maximum(sharpness - 1, 0))


def sharp_of(ids: IntArray, values: FloatArray) -> Sharp:
    """Sorted record of those above 0; ids are unique."""
    order = np.argsort(ids)
    order = order[values[order] > 0]
    return Sharp(ids[order], values[order])


@dataclass(frozen=True)
class Level:
    """One level of a cut mesh.

    Attributes:
        vertices: Vertex of each corner, shape (C,).
        starts: First corner of each face, and C, shape (F + 1,).
        rings: Corners around each vertex, counter-clockwise, vertex by vertex, shape (C,). An open
            fan begins at its clockwise end.
        valences: Number of faces at each vertex, shape (V,).
        kinds: CLOSED, OPEN or DART, shape (V,).
        first: Half-edge of each edge, shape (E,).
        second: Opposite half-edge of each edge with two faces, shape (I,), I <= E.
        edges: Edge of each half-edge, shape (C,).
        sharp_edges: Sharpness of edges with two faces.
        sharp_vertices: Sharpness of vertices.

    The finest level leaves out its edges if none of them is sharp.
    """

    vertices: IntArray
    starts: IntArray
    rings: IntArray
    valences: IntArray
    kinds: NDArray[np.uint8]
    first: IntArray
    second: IntArray
    edges: IntArray
    sharp_edges: Sharp
    sharp_vertices: Sharp

    @property
    def count(self) -> int:
        """Number of vertices."""
        return len(self.valences)

    @property
    def faces(self) -> int:
        """Number of faces."""
        return len(self.starts) - 1

    @cached_property
    def size(self) -> int:
        """Number of corners that all faces have; 0: it differs."""
        corners, faces = len(self.vertices), self.faces
        size = corners // faces if faces else 4
        even = np.array_equal(self.starts, np.arange(faces + 1) * size)
        return size if even and size in (3, 4) else 0

    @cached_property
    def face_of(self) -> IntArray:
        """Face of each corner, shape (C,)."""
        return np.repeat(np.arange(self.faces), np.diff(self.starts))

    def faces_at(self, corners: IntArray) -> IntArray:
        """Face of corners of any shape."""
        if self.size == 4:
            return corners >> 2
        return corners // 3 if self.size == 3 else self.face_of[corners]

    def after(self, corners: IntArray) -> IntArray:
        """Next corner in the face."""
        if self.size == 4:
            return (corners & ~3) | ((corners + 1) & 3)
        return self._turns[0][corners]

    def before(self, corners: IntArray) -> IntArray:
        """Corner before in the face."""
        if self.size == 4:
            return (corners & ~3) | ((corners + 3) & 3)
        return self._turns[1][corners]

    @cached_property
    def _turns(self) -> tuple[IntArray, IntArray]:
        """Next corner in the face, and the corner before, of all corners, each of shape (C,)."""
        firsts, lasts = self.starts[:-1], self.starts[1:] - 1
        corners = np.arange(len(self.vertices))
        after, before = corners + 1, corners - 1
        after[lasts], before[firsts] = firsts, lasts
        return after, before

    @cached_property
    def ring_starts(self) -> IntArray:
        """First entry of ``rings`` of each vertex, shape (V,)."""
        return np.cumsum(self.valences) - self.valences

    def fan(self, vertices: IntArray, valence: int) -> IntArray:
        """Corners around vertices of one valence, shape (M, valence)."""
        return np.asarray(self.rings[self.ring_starts[vertices][:, None] + np.arange(valence)])

    def fan_sharpness(self, fan: IntArray, kind: int) -> FloatArray:
        """Sharpness of the spokes of fans; infinite for the crease at a dart.

        An open fan has one spoke more than corners; its outer spokes are infinitely sharp.
        """
        some = len(self.sharp_edges.ids) > 0
        spokes = self.sharp_edges.of(self.edges[fan]) if some else np.zeros(fan.shape)
        if kind != CLOSED:
            spokes[:, 0] = INFINITE
        if kind == OPEN:
            spokes = np.concatenate([spokes, np.full((len(fan), 1), INFINITE)], axis=1)
        return spokes

    @cached_property
    def special(self) -> IntArray:
        """Vertices that are sharp, or have a sharp spoke, rising."""
        halves = self.first[self.sharp_edges.ids]
        ends = self.vertices[halves], self.vertices[self.after(halves)]
        return np.unique(np.concatenate([*ends, self.sharp_vertices.ids]))

    def groups(self, regular: int) -> list[VertexGroup]:
        """Vertices by kind, valence and whether they are special."""
        plain = (self.valences == regular) & (self.kinds == CLOSED)
        plain[self.special] = False
        found = [VertexGroup(CLOSED, regular, False, np.flatnonzero(plain))]
        rest = np.flatnonzero(~plain)
        special = np.zeros(self.count, bool)
        special[self.special] = True
        keys = (self.valences[rest] * 4 + self.kinds[rest]) * 2 + special[rest]
        order = np.argsort(keys, kind="stable")
        cuts = np.flatnonzero(np.diff(keys[order])) + 1
        for part in np.split(rest[order], cuts) if len(rest) else []:
            kind, valence = int(self.kinds[part[0]]), int(self.valences[part[0]])
            found.append(VertexGroup(kind, valence, bool(special[part[0]]), part))
        return found
