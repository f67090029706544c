"""Topology of the next level, in closed form: nothing is searched or sorted.

The vertices of the next level are the vertices of this level, a point for each edge, and, for
quadrangles, a point for each face. Edge e has the halves 2 e and 2 e + 1, plus C for edges with a
single face, as the C new edges inside of faces come between.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .level import CLOSED, OPEN, Level, Sharp
from .rules import IntArray

Edges = tuple[IntArray, IntArray, IntArray]
_NONE = np.zeros(0, np.int64)


def into_quads(level: Level, final: bool) -> Level:
    """Splits each face into one quadrangle for each corner.

    Quadrangle c has the corners: vertex, point of half-edge c, face, point of the half-edge before.

    Args:
        level: The level before.
        final: Whether there is no level after the next.
    """
    count = len(level.vertices)
    corners = np.arange(count)
    before = level.before(corners)
    vertices = np.empty((count, 4), np.int64)
    vertices[:, 0] = level.vertices
    vertices[:, 1] = level.count + level.edges
    vertices[:, 2] = level.count + len(level.first) + level.faces_at(corners)
    vertices[:, 3] = vertices[before, 1]
    sharp = _halved(level.sharp_edges)
    skip = final and not len(sharp.ids)
    first, second, edges = (_NONE, _NONE, _NONE) if skip else _quad_edges(level, corners, before)
    return Level(
        vertices=vertices.reshape(-1),
        starts=np.arange(count + 1) * 4,
        rings=_quad_rings(level, corners),
        valences=_valences(level, 4, 2, np.diff(level.starts)),
        kinds=_kinds(level, level.faces),
        first=first,
        second=second,
        edges=edges,
        sharp_edges=sharp,
        sharp_vertices=level.sharp_vertices.after(),
    )


def _quad_rings(level: Level, corners: IntArray) -> IntArray:
    """Corners around all vertices of the next level."""
    inside, rim, twin = _sides(level)
    return np.concatenate(
        [
            4 * level.rings,
            _in_turn(
                4 * level.after(inside) + 3, 4 * inside + 1, 4 * level.after(twin) + 3, 4 * twin + 1
            ),
            _in_turn(4 * level.after(rim) + 3, 4 * rim + 1),
            4 * corners + 2,
        ]
    )


def _quad_edges(level: Level, corners: IntArray, before: IntArray) -> Edges:
    """First and second halves of all edges of the next level, and the edge of each half."""
    inside, rim, twin = _sides(level)
    half = _half_of(level)
    inner = 2 * len(twin) + corners
    first = [
        _in_turn(4 * inside, 4 * level.after(inside) + 3),
        4 * corners + 1,
        _in_turn(4 * rim, 4 * level.after(rim) + 3),
    ]
    second = [_in_turn(4 * level.after(twin) + 3, 4 * twin), 4 * level.after(corners) + 2]
    edges = _in_turn(half(corners, 0), inner, inner[before], half(before, 1))
    return np.concatenate(first), np.concatenate(second), edges


def into_triangles(level: Level, final: bool) -> Level:
    """Splits each triangle into four: a triangle at each corner, and the middle triangle.

    Corner c of triangle f gives the triangle c + f; the middle triangle is 4 f + 3.

    Args:
        level: The level before.
        final: Whether there is no level after the next.
    """
    corners = np.arange(len(level.vertices))
    points = level.count + level.edges
    outer = _in_turn(level.vertices, points, points[level.before(corners)]).reshape(-1, 9)
    sharp = _halved(level.sharp_edges)
    skip = final and not len(sharp.ids)
    first, second, edges = (_NONE, _NONE, _NONE) if skip else _triangle_edges(level, corners)
    return Level(
        vertices=np.concatenate([outer, points.reshape(-1, 3)], axis=1).reshape(-1),
        starts=np.arange(4 * level.faces + 1) * 3,
        rings=_triangle_rings(level),
        valences=_valences(level, 6, 3, _NONE),
        kinds=_kinds(level, 0),
        first=first,
        second=second,
        edges=edges,
        sharp_edges=sharp,
        sharp_vertices=level.sharp_vertices.after(),
    )


def _outer(corners: IntArray) -> IntArray:
    """First corner of the triangle at each corner."""
    return 3 * corners + 3 * (corners // 3)


def _middle(halves: IntArray) -> IntArray:
    """Corner of the middle triangle at the point of each half-edge."""
    return 9 * (halves // 3) + halves + 9


def _triangle_rings(level: Level) -> IntArray:
    """Corners around all vertices of the next level."""
    inside, rim, twin = _sides(level)

    def around(halves: IntArray) -> list[IntArray]:
        return [_outer(level.after(halves)) + 2, _middle(halves), _outer(halves) + 1]

    return np.concatenate(
        [
            _outer(level.rings),
            _in_turn(*around(inside), *around(twin)),
            _in_turn(*around(rim)),
        ]
    )


def _triangle_edges(level: Level, corners: IntArray) -> Edges:
    """First and second halves of all edges of the next level, and the edge of each half.

    The new edge c runs from the point of half-edge c to the point of the half-edge before.
    """
    inside, rim, twin = _sides(level)
    half, before = _half_of(level), level.before(corners)
    inner = 2 * len(twin) + corners
    first = [
        _in_turn(_outer(inside), _outer(level.after(inside)) + 2),
        _outer(corners) + 1,
        _in_turn(_outer(rim), _outer(level.after(rim)) + 2),
    ]
    second = [_in_turn(_outer(level.after(twin)) + 2, _outer(twin)), _middle(before)]
    sides = _in_turn(half(corners, 0), inner, half(before, 1)).reshape(-1, 9)
    middle = inner[level.after(corners)].reshape(-1, 3)
    edges = np.concatenate([sides, middle], axis=1).reshape(-1)
    return np.concatenate(first), np.concatenate(second), edges


def _sides(level: Level) -> tuple[IntArray, IntArray, IntArray]:
    """Half-edges: first half-edges of inner edges, half-edges of the rim, second half-edges."""
    inner = len(level.second)
    return level.first[:inner], level.first[inner:], level.second


def _in_turn(*parts: IntArray) -> IntArray:
    """Arrays of one length, one element of each in turn."""
    result = np.empty((len(parts[0]), len(parts)), np.int64)
    for column, part in enumerate(parts):
        result[:, column] = part
    return result.reshape(-1)


def _half_of(level: Level) -> Callable[[IntArray, int], IntArray]:
    """Function of half-edges and an end (0: start, 1: end): the half of their edge at that end."""
    count = len(level.vertices)
    backward = np.ones(count, np.int64)
    backward[level.first] = 0
    edge = 2 * level.edges + np.where(level.edges >= len(level.second), count, 0)

    def half(halves: IntArray, end: int) -> IntArray:
        return edge[halves] + (backward[halves] ^ end)

    return half


def _valences(level: Level, inside: int, rim: int, faces: IntArray) -> IntArray:
    """Numbers of faces at all vertices of the next level."""
    edges = np.full(len(level.first), rim)
    edges[: len(level.second)] = inside
    return np.concatenate([level.valences, edges, faces])


def _kinds(level: Level, faces: int) -> NDArray[np.uint8]:
    """Kinds of all vertices of the next level."""
    edges = np.full(len(level.first) + faces, CLOSED, np.uint8)
    edges[len(level.second) : len(level.first)] = OPEN
    return np.concatenate([level.kinds, edges])


def _halved(sharp: Sharp) -> Sharp:
    """Sharpness of the two halves of edges with two faces."""
    left = sharp.after()
    return Sharp(_in_turn(2 * left.ids, 2 * left.ids + 1), np.repeat(left.values, 2))
