"""Points of the next level from the points of this level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .level import CLOSED, OPEN, Level, VertexGroup
from .rules import FloatArray, IntArray
from .scheme import Scheme
from .sharpness import open_weights
from .stencils import Group, side_by_side, sums


@dataclass(frozen=True)
class Step:
    """Linear map of one level.

    Attributes:
        faces: Sums that give face points, none for triangles.
        points: Sums over points of this level, then face points, that give vertices and edges.
        count: Numbers of face points, and of others.
    """

    faces: list[Group]
    points: list[Group]
    count: tuple[int, int]

    def __call__(self, points: FloatArray) -> FloatArray:
        """Points of the next level, shape (N', K)."""
        faces, others = self.count
        if not faces:
            return sums(self.points, points, others)[:, 0]
        middle = sums(self.faces, points, faces)[:, 0]
        near = np.concatenate([points, middle])
        out = np.empty((others + faces, 1, points.shape[1]))
        out[:others] = sums(self.points, near, others)
        out[others:, 0] = middle
        return out[:, 0]


def smooth_step(level: Level, scheme: Scheme) -> Step:
    """Step by the rules of a scheme."""
    points = [
        _vertices(level, scheme, group)
        for group in level.groups(scheme.regular)
        if len(group.vertices)
    ]
    points += [*_inner_edges(level, scheme), _rim(level, len(level.second))]
    return _step(level, scheme.quads, points)


def linear_step(level: Level, quads: bool) -> Step:
    """Step that keeps vertices and halves edges."""
    vertices = np.arange(level.count)[:, None]
    keep = Group(slice(0, level.count), vertices, np.ones((1, 1)))
    return _step(level, quads, [keep, _rim(level, 0)])


def _step(level: Level, quads: bool, points: list[Group]) -> Step:
    others = level.count + len(level.first)
    return Step(_faces(level) if quads else [], points, (level.faces if quads else 0, others))


def _faces(level: Level) -> list[Group]:
    """Means of the corners of faces, by size."""
    if level.size == 4:
        rows = slice(0, level.faces)
        return [Group(rows, level.vertices.reshape(-1, 4), np.full((4, 1), 1 / 4))]
    sizes, found = np.diff(level.starts), []
    for size in np.unique(sizes):
        rows_of = np.flatnonzero(sizes == size)
        index = level.vertices[level.starts[rows_of][:, None] + np.arange(size)]
        found.append(Group(rows_of, index, np.full((int(size), 1), 1 / size)))
    return found


def _rim(level: Level, begin: int) -> Group:
    """Middles of the edges from number ``begin`` on."""
    halves = level.first[begin:]
    ends = np.stack([level.vertices[halves], level.vertices[level.after(halves)]], axis=1)
    rows = slice(level.count + begin, level.count + len(level.first))
    return Group(rows, ends, np.full((2, 1), 1 / 2))


def _inner_edges(level: Level, scheme: Scheme) -> list[Group]:
    """Points of edges with two faces, smooth and sharp."""
    one, other = level.first[: len(level.second)], level.second

    def parts(some: slice) -> list[IntArray]:
        halves = np.stack([one[some], other[some]], axis=1)
        if scheme.quads:
            return [level.vertices[halves], level.count + level.faces_at(halves)]
        return [level.vertices[halves], level.vertices[level.before(halves)]]

    index = side_by_side(len(other), 4, parts)
    rows: IntArray | slice = slice(level.count, level.count + len(other))
    smooth = np.array(scheme.edge)
    sharp = level.sharp_edges
    if not len(sharp.ids):
        return [Group(rows, index, smooth[:, None])]
    blend = np.minimum(sharp.values, 1)[:, None]
    weights = (1 - blend) * smooth + blend * [1 / 2, 1 / 2, 0, 0]
    plain = np.ones(len(other), bool)
    plain[sharp.ids] = False
    rest = np.flatnonzero(plain)
    return [
        Group(level.count + rest, index[rest], smooth[:, None]),
        Group(level.count + sharp.ids, index[sharp.ids], weights[:, :, None]),
    ]


def _vertices(level: Level, scheme: Scheme, group: VertexGroup) -> Group:
    """Points of vertices of one kind and valence."""
    kind, valence, special, vertices = group
    sharpness = level.sharp_vertices.of(vertices) if special else np.zeros(0)
    if kind == OPEN:
        fan = level.fan(vertices, valence)
        ends = [level.vertices[level.after(fan[:, 0])], level.vertices[level.before(fan[:, -1])]]
        weights = open_weights(sharpness if special else np.zeros(1))
        index = np.stack([vertices, *ends], axis=1)
        return Group(vertices, index, weights[:, :, None] if special else weights[0][:, None])

    def parts(some: slice) -> list[IntArray]:
        fan = level.fan(vertices[some], valence)
        found = [vertices[some, None], level.vertices[level.after(fan)]]
        return [*found, level.count + level.faces_at(fan)] if scheme.quads else found

    index = side_by_side(len(vertices), scheme.ring(CLOSED, valence), parts)
    if not special:
        return Group(vertices, index, scheme.smooth(valence)[:, None])
    spokes = level.fan_sharpness(level.fan(vertices, valence), kind)
    weights = scheme.vertex_weights(kind, sharpness, spokes)
    return Group(vertices, index, weights[:, :, None])
