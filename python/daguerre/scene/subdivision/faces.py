"""Control faces: checked numbers, half-edges, their pairs, and fans of faces around vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.cached import cached_property
from daguerre.checks import MAX_NUMBERS, whole
from daguerre.errors import InputError
from daguerre.files.value import Value

from .rules import IntArray, integers


@dataclass(frozen=True, eq=False)
class Faces(Value):
    """Faces of a control mesh.

    Attributes:
        count: Number of vertices.
        sizes: Corners of each face, shape (F,).
        vertices: Vertex of each corner, shape (C,).
    """

    count: int
    sizes: IntArray
    vertices: IntArray

    @cached_property
    def starts(self) -> IntArray:
        """First corner of each face, and C, shape (F + 1,)."""
        return np.concatenate([[0], np.cumsum(self.sizes)])

    @cached_property
    def face_of(self) -> IntArray:
        """Face of each corner, shape (C,)."""
        return np.repeat(np.arange(len(self.sizes)), self.sizes)

    @cached_property
    def after(self) -> IntArray:
        """Next corner in the face, shape (C,)."""
        after = np.arange(1, len(self.vertices) + 1)
        after[self.starts[1:] - 1] = self.starts[:-1]
        return after

    @cached_property
    def before(self) -> IntArray:
        """Corner before in the face, shape (C,)."""
        before = np.empty(len(self.vertices), np.int64)
        before[self.after] = np.arange(len(self.vertices))
        return before

    def keys(self, one: IntArray, other: IntArray) -> IntArray:
        """Numbers of pairs of vertices, in either order."""
        return np.minimum(one, other) * self.count + np.maximum(one, other)

    @cached_property
    def edges(self) -> tuple[IntArray, IntArray]:
        """Keys of all edges, rising, shape (E,), and the edge of each half-edge, shape (C,)."""
        keys = self.keys(self.vertices, self.vertices[self.after])
        found, edge_of = np.unique(keys, return_inverse=True)
        return found, edge_of.reshape(-1)

    @cached_property
    def twins(self) -> IntArray:
        """Opposite half-edge of each, shape (C,); -1 unless exactly two run in two directions."""
        found, edge_of = self.edges
        order = np.argsort(edge_of, kind="stable")
        counts = np.bincount(edge_of, minlength=len(found))
        pairs = order[counts[edge_of[order]] == 2].reshape(-1, 2)
        starts = self.vertices[pairs]
        opposite = (starts[:, 0] != starts[:, 1]) & (
            starts[:, 0] == self.vertices[self.after[pairs[:, 1]]]
        )
        pairs = pairs[opposite]
        twins = np.full(len(self.vertices), -1)
        twins[pairs[:, 0]], twins[pairs[:, 1]] = pairs[:, 1], pairs[:, 0]
        return twins


def checked_faces(count: int, sizes: ArrayLike, vertices: ArrayLike, where: str) -> Faces:
    """Checks the faces of a control mesh.

    Args:
        count: Number of vertices.
        sizes: Corners of each face, at least 3, shape (F,).
        vertices: Vertex of each corner, shape (sum of sizes,).
        where: Owner of the faces, for messages.

    Raises:
        InputError: Numbers do not fit together.
    """
    count = whole(count, f"{where}: count", 0, MAX_NUMBERS - 1)
    each = integers(sizes, where, "sizes", MAX_NUMBERS).reshape(-1)
    if each.size and each.min() < 3:
        face = int(np.argmin(each))
        raise InputError(f"{where}: sizes[{face}]: wanted at least 3 corners, got {each[face]}")
    flat = integers(vertices, where, "vertices", count).reshape(-1)
    if int(each.sum()) != len(flat):
        raise InputError(
            f"{where}: vertices: wanted {int(each.sum())} corners (the sum of sizes), "
            f"got {len(flat)}"
        )
    return Faces(count, each, flat)


@dataclass(frozen=True)
class Fans:
    """Fans of faces around vertices.

    Attributes:
        rings: Corners, one fan after the other, each counter-clockwise, shape (C,).
        sizes: Corners of each fan, shape (V,).
        of_corner: Fan of each corner, shape (C,).
        opened: Whether a fan has two ends, shape (V,).
    """

    rings: IntArray
    sizes: IntArray
    of_corner: IntArray
    opened: NDArray[np.bool_]

    @property
    def heads(self) -> IntArray:
        """First corner of each fan; the clockwise end if it has one."""
        return np.asarray(self.rings[np.cumsum(self.sizes) - self.sizes])

    @property
    def tails(self) -> IntArray:
        """Last corner of each fan."""
        return np.asarray(self.rings[np.cumsum(self.sizes) - 1])


def fans(faces: Faces, twins: IntArray) -> Fans:
    """Walks from face to face around each vertex, across half-edges that have twins.

    Fans are sorted by vertex. Lists are ranked by doubling of steps (Wyllie 1979), so that a
    vertex of many faces costs no more than many vertices.
    """
    corners = np.arange(len(faces.vertices))
    head = twins < 0
    clockwise = np.where(head, corners, faces.after[twins])
    loops, least = _loops(head, clockwise)
    begins = head | (loops & (least == corners))
    steps, place = np.where(begins, corners, clockwise), np.where(begins, 0, 1)
    while not begins[steps].all():
        place = place + place[steps]
        steps = steps[steps]
    order = np.lexsort((place, steps, faces.vertices))
    first = begins[order]
    of_corner = np.empty(len(corners), np.int64)
    of_corner[order] = np.cumsum(first) - 1
    heads = order[first]
    sizes = np.bincount(of_corner, minlength=len(heads))
    return Fans(order, sizes, of_corner, ~loops[heads])


def _loops(head: NDArray[np.bool_], step: IntArray) -> tuple[NDArray[np.bool_], IntArray]:
    """Whether steps from a corner never come to a head, and the least corner that they reach.

    A set of corners without a head that steps do not leave is made of loops.
    """
    least, jump = np.arange(len(step)), step
    while True:
        least, jump = np.minimum(least, least[jump]), jump[jump]
        endless = ~head[jump]
        if (~endless | (endless[step] & (least == least[step]))).all():
            return endless, least
