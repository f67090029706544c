"""Voronoi Texture.

Source: Cycles, ``kernel/svm/voronoi.h`` (Apache-2.0); I. Quilez, "Voronoi edges" and "smooth
Voronoi" (MIT).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .cells import Array, Grid, Metric, Point, euclidean, square
from .fractals import ONE, Octave, octaves_of
from .hashes import Numbers

#: Square of the distance between two points below which they have no edge.
_SAME = np.float32(0.0001)
#: Distance to an edge before any octave.
_FAR = np.float32(8)


@dataclass(frozen=True)
class Cells:
    """Parameters of the pattern; all but the detail are numbers or arrays (N,).

    Attributes:
        randomness: How far points are scattered, 0 .. 1.
        metric: Distance of an offset.
        exponent: Exponent of Minkowski's metric.
        smoothness: Width over which smooth cells blend, 0 .. 0.5.
        detail: Number of octaves after the first, 0 .. 15; a part counts in part.
        roughness: Factor between octaves on their size, 0 .. 1.
        lacunarity: Factor between octaves on their frequency.
        normalize: Whether distances are brought to 0 .. 1.
    """

    randomness: Numbers = 1.0
    metric: Metric = euclidean
    exponent: Numbers = 0.5
    smoothness: Numbers = 0.5
    detail: float = 0.0
    roughness: Numbers = 0.5
    lacunarity: Numbers = 2.0
    normalize: bool = False

    def octaves(self) -> Iterator[Octave]:
        """Octaves of the pattern."""
        return octaves_of(self.detail, self.roughness, self.lacunarity)

    def widest(self, axes: int) -> Numbers:
        """Largest distance to the nearest point, for normalization."""
        half = np.asarray(0.5 + 0.5 * self.randomness, np.float32)
        return self.metric([half] * axes, self.exponent) if axes > 1 else half


@dataclass
class Found:
    """Distance (N,), colour (three arrays) and position (an array for each axis)."""

    distance: Array
    color: list[Array]
    position: Point


Feature = Callable[[Point, Cells], Found]


def nearest(point: Point, cells: Cells) -> Found:
    """The nearest point (F1)."""
    grid = Grid.around(point, cells.randomness)
    first, _ = _ranked(grid, cells, both=False)
    return _described(grid, first)


def second(point: Point, cells: Cells) -> Found:
    """The second nearest point (F2)."""
    grid = Grid.around(point, cells.randomness)
    _, then = _ranked(grid, cells, both=True)
    return _described(grid, then)


@dataclass
class _Cell:
    """Distance to the point of a cell, the cell's offset, and the point."""

    distance: Array
    offset: Point
    there: Point

    @classmethod
    def none(cls, like: Point) -> _Cell:
        """No cell."""
        return cls(np.full_like(like[0], np.inf), _zeros(like, len(like)), _zeros(like, len(like)))

    def take(
        self, where: NDArray[np.bool_], distance: Array, offset: Sequence[Any], there: Point
    ) -> None:
        """Replaces the cell at some points."""
        targets = (self.distance, *self.offset, *self.there)
        for target, values in zip(targets, (distance, *offset, *there), strict=True):
            np.copyto(target, values, where=where, casting="unsafe")


def _ranked(grid: Grid, cells: Cells, *, both: bool) -> tuple[_Cell, _Cell]:
    """The nearest cell; and, if wanted, the next."""
    first, then = _Cell.none(grid.inside), _Cell.none(grid.inside)
    for offset in grid.near(1):
        there = grid.scattered(offset)
        distance = _distance(there, grid, cells)
        nearer = distance < first.distance
        if both:
            between = ~nearer & (distance < then.distance)
            then.take(nearer, first.distance, first.offset, first.there)
            then.take(between, distance, offset, there)
        first.take(nearer, distance, offset, there)
    return first, then


def _described(grid: Grid, cell: _Cell) -> Found:
    position = [axis + base for axis, base in zip(cell.there, grid.floors, strict=True)]
    return Found(cell.distance, grid.color(cell.offset), position)


def _distance(there: Point, grid: Grid, cells: Cells) -> Array:
    offset = _between(there, grid.inside)
    if len(offset) == 1:
        return np.abs(offset[0])
    return cells.metric(offset, cells.exponent)


def _between(a: Sequence[Array], b: Sequence[Array]) -> Point:
    return [x - y for x, y in zip(a, b, strict=True)]


def smooth(point: Point, cells: Cells) -> Found:
    """The nearest points, blended (smooth F1)."""
    grid = Grid.around(point, cells.randomness)
    width = np.asarray(cells.smoothness, np.float32)
    values: list[Array] = []
    for offset in grid.near(2):
        there = grid.scattered(offset)
        distance = _distance(there, grid, cells)
        here = [distance, *grid.color(offset), *there]
        if not values:  # the first point has all the weight
            values = here
            continue
        nearer = np.float32(0.5) + np.float32(0.5) * (values[0] - distance) / width
        share = _step(np.asarray(nearer, np.float32))
        less = width * share * (ONE - share)
        little = less / (ONE + np.float32(3) * width)
        values = [
            old + share * (new - old) - (little if i else less)
            for i, (old, new) in enumerate(zip(values, here, strict=True))
        ]
    position = [axis + base for axis, base in zip(values[4:], grid.floors, strict=True)]
    return Found(values[0], values[1:4], position)


def _step(t: Array) -> Array:
    t = np.clip(t, 0, 1)
    return t * t * (np.float32(3) - np.float32(2) * t)


def sphere_radius(point: Point, cells: Cells) -> Array:
    """Half the distance between the nearest point and that point's nearest neighbour."""
    grid = Grid.around(point, cells.randomness)
    cell, _ = _ranked(grid, Cells(), both=False)
    least = np.full(point[0].shape, np.inf, np.float32)
    for by in grid.near(1):
        if any(by):
            offset = [a + np.float32(b) for a, b in zip(cell.offset, by, strict=True)]
            least = np.minimum(least, square(_between(grid.scattered(offset), cell.there)))
    return np.asarray(np.sqrt(least) / np.float32(2))


def edge(point: Point, cells: Cells) -> Array:
    """Distance to the nearest edge between two cells."""
    if len(point) == 1:
        return _edge_of_line(point, cells)
    grid = Grid.around(point, cells.randomness)
    cell, _ = _ranked(grid, Cells(), both=False)
    closest = _between(cell.there, grid.inside)
    least = np.full(point[0].shape, np.inf, np.float32)
    for offset in grid.near(1):
        other = _between(grid.scattered(offset), grid.inside)
        across = _between(other, closest)
        size = square(across)
        both = zip(closest, other, across, strict=True)
        along = [(a + b) / np.float32(2) * c for a, b, c in both]
        with np.errstate(all="ignore"):
            distance = sum(along[1:], along[0]) / np.sqrt(size)
        np.copyto(least, np.minimum(least, distance), where=size > _SAME)
    return least


def _edge_of_line(point: Point, cells: Cells) -> Array:
    grid = Grid.around(point, cells.randomness)
    left, middle, right = (grid.scattered((i,))[0] for i in (-1, 0, 1))
    ends = [np.abs((middle + end) / np.float32(2) - grid.inside[0]) for end in (left, right)]
    return np.asarray(np.minimum(*ends))


def fractal(point: Point, cells: Cells, feature: Feature, widest: Numbers) -> Found:
    """Octaves of a feature, summed; positions are mixed.

    Args:
        point: Coordinates.
        cells: Parameters.
        feature: Pattern of one octave.
        widest: Distance that becomes 1 if the pattern is normalized.
    """
    if cells.detail == 0 or not np.any(cells.roughness):
        found = feature(point, cells)
        return _normalized(found, ONE, widest) if cells.normalize else found
    total: Numbers = np.float32(0)
    sum_ = Found(np.zeros_like(point[0]), _zeros(point, 3), _zeros(point, len(point)))
    for share, size, scale in cells.octaves():
        octave = feature([axis * scale for axis in point], cells)
        total = total + share * size
        sum_.distance = sum_.distance + share * size * octave.distance
        pairs = zip(sum_.color, octave.color, strict=True)
        sum_.color = [old + share * size * new for old, new in pairs]
        places = zip(sum_.position, octave.position, strict=True)
        sum_.position = [old + share * size * (new / scale - old) for old, new in places]
    return _normalized(sum_, total, widest) if cells.normalize else sum_


def _zeros(point: Point, count: int) -> list[Array]:
    return [np.zeros_like(point[0]) for _ in range(count)]


def _normalized(found: Found, total: Numbers, widest: Numbers) -> Found:
    color = [channel / total for channel in found.color]
    return Found(found.distance / (total * widest), color, found.position)


def fractal_edge(point: Point, cells: Cells) -> Array:
    """Octaves of distances to edges: the least one, mixed in by the size of its octave."""
    widest = np.asarray(0.5 + 0.5 * cells.randomness, np.float32)
    if cells.detail == 0 or not np.any(cells.roughness):
        found = edge(point, cells)
        return np.asarray(found / widest) if cells.normalize else found
    most: Numbers = widest
    distance: Numbers = _FAR
    for share, size, scale in cells.octaves():
        least = np.minimum(distance, edge([axis * scale for axis in point], cells) / scale)
        mixed = distance + size * (least - distance)
        widened = most + size * (widest / scale - most)
        if share < 1:
            most = most + share * (widened - most)
            distance = distance + share * (np.minimum(distance, mixed) - distance)
        else:
            distance, most = mixed, widened
    return np.asarray(distance / most) if cells.normalize else np.asarray(distance)
