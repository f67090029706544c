"""Opens a control mesh along boundaries, infinitely sharp creases and seams.

Both sides of an infinitely sharp crease follow the rules of a boundary. So the mesh is opened there
before the first level: each vertex gets one copy for each fan of faces. Copies keep equal positions
and have the normals of their side. Edges with three or more faces, or with two faces of opposite
orientation, are opened in the same way.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .faces import Faces, Fans, fans
from .level import CLOSED, DART, OPEN, Level, Sharp, sharp_of
from .rules import INFINITE, FloatArray, IntArray, Rules

BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Cut:
    """A cut control mesh.

    Attributes:
        level: Its faces.
        source: Control vertex, or value of a face-varying mesh, of each vertex, shape (V,).
    """

    level: Level
    source: IntArray


@dataclass(frozen=True)
class Corners:
    """Sharpness of the vertices of the uncut mesh, from their edges and fans.

    Attributes:
        infinite: Number of infinitely sharp edges at each vertex, shape (N,).
        sharpness: Sharpness of each vertex itself, shape (N,).
    """

    infinite: IntArray
    sharpness: FloatArray


@dataclass(frozen=True)
class Opened:
    """A control mesh opened along its boundaries and infinitely sharp creases.

    Attributes:
        edges: Sharpness of each edge of the uncut mesh, shape (E,).
        twins: Opposite half-edge of each, shape (C,); -1 where the mesh is open.
        fans: Fans of faces between openings.
        corners: Facts of the vertices.
    """

    edges: FloatArray
    twins: IntArray
    fans: Fans
    corners: Corners


def opened_mesh(faces: Faces, rules: Rules, *, everywhere: bool = False) -> Opened:
    """Opens a control mesh; ``everywhere``: along all its edges."""
    edges = edge_sharpness(faces, rules)
    if everywhere:
        edges = np.full_like(edges, INFINITE)
    twins = np.where(edges[faces.edges[1]] >= INFINITE, -1, faces.twins)
    found = fans(faces, twins)
    return Opened(edges, twins, found, classify(faces, rules, edges, found))


def cut_mesh(faces: Faces, opened: Opened) -> Cut:
    """Makes a separate vertex for each fan of an opened mesh."""
    found, corners = opened.fans, opened.corners
    vertex = faces.vertices[found.heads]
    kinds = np.where(found.opened, OPEN, CLOSED).astype(np.uint8)
    kinds[found.opened & (corners.infinite[vertex] == 1)] = DART
    sharpness = corners.sharpness[vertex]
    return Cut(opened_level(faces, opened.twins, found, kinds, opened.edges, sharpness), vertex)


def edge_sharpness(faces: Faces, rules: Rules) -> FloatArray:
    """Sharpness of each edge of the uncut mesh, shape (E,); without a pair it is infinite."""
    sharpness = given_sharpness(faces, rules)
    sharpness[faces.edges[1][faces.twins < 0]] = np.inf
    return sharpness


def given_sharpness(faces: Faces, rules: Rules) -> FloatArray:
    """Sharpness of each edge of the uncut mesh by its creases, shape (E,)."""
    keys = faces.edges[0]
    sharpness = np.zeros(len(keys))
    pairs = np.asarray(rules.creases)
    wanted = faces.keys(pairs[:, 0], pairs[:, 1])
    if len(keys) and len(wanted):
        place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
        known = keys[place] == wanted
        np.maximum.at(sharpness, place[known], np.asarray(rules.crease_sharpness)[known])
    return sharpness


def classify(faces: Faces, rules: Rules, edges: FloatArray, found: Fans) -> Corners:
    """Sharpness of vertices, by the rules and by their edges and fans.

    With two infinitely sharp edges, and all fans between them, a vertex is a crease; with a single
    sharp edge it is a dart, the end of a crease; without sharp edges it is smooth. All other
    vertices are corners.
    """
    one, other = np.divmod(faces.edges[0], max(faces.count, 1))
    ends = np.concatenate([one, other[other != one]])
    each = np.concatenate([edges, edges[other != one]])
    infinite = np.bincount(ends[each >= INFINITE], minlength=faces.count)
    sharpness = np.zeros(faces.count)
    np.maximum.at(sharpness, np.asarray(rules.corners), np.asarray(rules.corner_sharpness))
    _keep_sharp_while_edges_are(sharpness, infinite, ends, each)
    sharpness[_are_corners(faces, found, infinite)] = INFINITE
    if rules.boundary == "edge and corner":
        boundary = np.bincount(faces.edges[1])[faces.edges[1]] == 1
        outer = boundary & boundary[faces.before]
        alone = np.bincount(faces.vertices, minlength=faces.count) == 1
        sharpness[faces.vertices[outer & alone[faces.vertices]]] = INFINITE
    return Corners(infinite, sharpness)


def _keep_sharp_while_edges_are(
    sharpness: FloatArray, infinite: IntArray, ends: IntArray, each: FloatArray
) -> None:
    """Makes vertices on creases corners for as long as other edges at them are sharp.

    The fraction of the last level is the mean of the edges that end there, as for all vertices.
    """
    finite = (each > 0) & (each < INFINITE) & (infinite[ends] >= 2)
    own = np.flatnonzero((sharpness > 0) & (sharpness < INFINITE) & (infinite >= 2))
    vertex = np.concatenate([ends[finite], own])
    value = np.concatenate([each[finite], sharpness[own]])
    longest = np.zeros(len(sharpness))
    np.maximum.at(longest, vertex, value)
    last = np.ceil(value) == np.ceil(longest[vertex])
    total = np.bincount(vertex[last], value[last], minlength=len(sharpness))
    number = np.bincount(vertex[last], minlength=len(sharpness))
    some = (number > 0) & (sharpness < INFINITE)
    sharpness[some] = total[some] / number[some]


def _are_corners(faces: Faces, found: Fans, infinite: IntArray) -> BoolArray:
    """Whether vertices are corners by their topology, shape (N,)."""
    vertex = faces.vertices[found.heads]
    number = np.bincount(vertex, minlength=faces.count)
    opened = np.bincount(vertex[found.opened], minlength=faces.count)
    edge_of = faces.edges[1]
    same = edge_of[found.heads] == edge_of[faces.before[found.tails]]
    slits = np.bincount(vertex[found.opened & same], minlength=faces.count)
    tiny = np.bincount(vertex[~found.opened & (found.sizes < 2)], minlength=faces.count) > 0
    smooth = (infinite == 0) & (number == 1) & (opened == 0)
    dart = (infinite == 1) & (number == 1) & (slits == 1)
    crease = (infinite == 2) & (number == opened) & (slits == 0)
    return np.asarray((number > 0) & (tiny | ~(smooth | dart | crease)))


def opened_level(
    faces: Faces,
    twins: IntArray,
    found: Fans,
    kinds: NDArray[np.uint8],
    edges: FloatArray,
    sharpness: FloatArray,
) -> Level:
    """First level of a cut mesh; ``edges`` is the sharpness of the edges of the uncut mesh."""
    corners = np.arange(len(faces.vertices))
    first = np.concatenate([corners[twins > corners], corners[twins < 0]])
    second = twins[twins > corners]
    edge_of = np.empty(len(corners), np.int64)
    edge_of[first] = np.arange(len(first))
    edge_of[second] = np.arange(len(second))
    inner = edges[faces.edges[1][first[: len(second)]]]
    return Level(
        vertices=found.of_corner,
        starts=faces.starts,
        rings=found.rings,
        valences=found.sizes,
        kinds=kinds,
        first=first,
        second=second,
        edges=edge_of,
        sharp_edges=sharp_of(np.arange(len(second)), inner),
        sharp_vertices=_of_vertices(kinds, sharpness),
    )


def _of_vertices(kinds: NDArray[np.uint8], sharpness: FloatArray) -> Sharp:
    return sharp_of(np.arange(len(kinds)), sharpness)
