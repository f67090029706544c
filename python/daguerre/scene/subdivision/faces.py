"""Control faces: checked numbers, half-edges, their pairs, and fans of faces around vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.cached import cached_property
from daguerre.checks import MAX_NUMBERS, integers, whole
from daguerre.errors import InputError
from daguerre.files.value import Value

from .rules import IntArray


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
        halves = np.arange(len(edge_of))
        one, other = np.empty_like(found), np.empty_like(found)
        one[edge_of[::-1]], other[edge_of] = halves[::-1], halves  # the first and the last half
        two = np.bincount(edge_of, minlength=len(found)) == 2
        one, other = one[two], other[two]
        starts = self.vertices[one]
        opposite = (starts != self.vertices[other]) & (starts == self.vertices[self.after[other]])
        one, other = one[opposite], other[opposite]
        twins = np.full(len(edge_of), -1)
        twins[one], twins[other] = other, one
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
        rings: Corners, fan by fan, each counter-clockwise, shape (C,).
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
        """First corner of each fan: its clockwise end if it is open."""
        return np.asarray(self.rings[np.cumsum(self.sizes) - self.sizes])

    @property
    def tails(self) -> IntArray:
        """Last corner of each fan."""
        return np.asarray(self.rings[np.cumsum(self.sizes) - 1])


def fans(faces: Faces, twins: IntArray) -> Fans:
    """Walks from face to face around each vertex, across half-edges that have twins.

    Fans are sorted by vertex, then by their first corner: that without a twin, else the least.
    """
    corners = np.arange(len(faces.vertices))
    head = twins < 0
    first, place = _ranked(head, np.where(head, corners, faces.after[twins]))
    heads = np.flatnonzero(first == corners)
    heads = heads[np.argsort(faces.vertices[heads] * len(corners) + heads)]
    number = np.empty(len(corners), np.int64)
    number[heads] = np.arange(len(heads))
    of_corner = number[first]
    sizes = np.bincount(of_corner, minlength=len(heads))
    rings = np.empty(len(corners), np.int64)
    rings[(np.cumsum(sizes) - sizes)[of_corner] + place] = corners
    return Fans(rings, sizes, of_corner, head[heads])


def _ranked(head: NDArray[np.bool_], step: IntArray) -> tuple[IntArray, IntArray]:
    """First corner of the list or loop of each corner, and the number of steps to it.

    Lists end at a head, which steps to itself; loops have no head and begin at their least corner.
    Lists are ranked by doubling of steps (Wyllie 1979), so that a vertex of many faces costs no
    more than many vertices. While the least corner is sought, heads compare as less than all other
    corners: the result is final once each step reaches around its loop, or to the end of its list.
    """
    corners = np.arange(len(step))
    least, jump = np.where(head, corners - len(corners), corners), step
    place, width = np.zeros(len(step), np.int64), 1
    while True:
        farther = least[jump]
        less = farther < least
        if not less.any():
            return np.where(least < 0, least + len(corners), least), place
        place = np.where(less, place[jump] + width, place)
        least, jump, width = np.minimum(least, farther), jump[jump], 2 * width
