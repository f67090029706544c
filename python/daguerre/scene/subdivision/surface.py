"""A cut mesh with all its levels, and the linear maps to its limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from daguerre.cached import cached_property

from .cut import Cut
from .level import Level, Sharp
from .limit import limit_groups
from .rules import FloatArray, IntArray
from .scheme import Scheme
from .stencils import Group, sums
from .step import Step, linear_step, smooth_step

_CHUNK = 1 << 16


class RefinedSurface:
    """Points of a surface from its control points.

    Args:
        cut: The control mesh.
        scheme: The scheme.
        levels: Number of levels, at least 1.
    """

    def __init__(self, cut: Cut, scheme: Scheme, levels: int) -> None:
        level = cut.level
        if scheme.linear:
            level = replace(level, sharp_vertices=Sharp(np.zeros(0, np.int64), np.zeros(0)))
        self.source = cut.source
        self._scheme = scheme
        self._levels = [level]
        for step in range(levels):
            self._levels.append(scheme.split(self._levels[-1], step == levels - 1))

    @property
    def last(self) -> Level:
        """The finest level."""
        return self._levels[-1]

    @cached_property
    def _linear(self) -> list[Step]:
        return [linear_step(level, self._scheme.quads) for level in self._levels[:-1]]

    @cached_property
    def _smooth(self) -> list[Step]:
        if self._scheme.linear:
            return self._linear
        return [smooth_step(level, self._scheme) for level in self._levels[:-1]]

    @cached_property
    def _limit(self) -> list[Group]:
        return limit_groups(self.last, self._scheme)

    @cached_property
    def _places(self) -> list[Group]:
        """Groups of ``_limit`` without their tangents."""
        return [Group(g.rows, g.index, g.weights[..., :1]) for g in self._limit]

    def varying(self, values: FloatArray) -> FloatArray:
        """Values (N, K), interpolated linearly; shape (V, K)."""
        return _through(self._linear, values[self.source])

    def limit(self, values: FloatArray) -> FloatArray:
        """Values (N, K) by the smooth rules at the limit; shape (V, K)."""
        return sums(self._places, _through(self._smooth, values[self.source]), self.last.count)[
            :, 0
        ]

    def positions_and_normals(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Limit of points (N, 3), and unit normals; each of shape (V, 3)."""
        near = _through(self._smooth, points[self.source])
        found = sums(self._limit, near, self.last.count, 3)
        normals = np.empty((len(found), 3))
        for begin in range(0, len(found), _CHUNK):
            some = slice(begin, begin + _CHUNK)
            normals[some] = _cross(found[some, 1], found[some, 2])
        return found[:, 0].copy(), self._unit(normals, near)

    def _unit(self, normals: FloatArray, near: FloatArray) -> FloatArray:
        """Unit normals; in place of length 0 the normal of a face at the vertex, or (0, 1, 0)."""
        lengths = np.sqrt(np.einsum("ij,ij->i", normals, normals))
        empty = np.flatnonzero(~(lengths > 0))
        if len(empty):
            normals[empty] = _of_faces(self.last, empty, near)
            lengths[empty] = np.sqrt(np.einsum("ij,ij->i", normals[empty], normals[empty]))
            lost = empty[~(lengths[empty] > 0)]
            normals[lost], lengths[lost] = (0, 1, 0), 1
        normals /= lengths[:, None]
        return normals


def _through(steps: list[Step], values: FloatArray) -> FloatArray:
    for step in steps:
        values = step(values)
    return values


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    """Cross products of rows."""
    out = np.empty(a.shape)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[:, i] = a[:, j] * b[:, k] - a[:, k] * b[:, j]
    return out


def _of_faces(level: Level, vertices: IntArray, points: FloatArray) -> FloatArray:
    """Normal of one face at each vertex."""
    corner = level.rings[level.ring_starts[vertices]]
    own, after = points[vertices], points[level.vertices[level.after(corner)]]
    return _cross(after - own, points[level.vertices[level.before(corner)]] - own)
