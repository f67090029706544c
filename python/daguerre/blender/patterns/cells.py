"""Random feature points on a grid, a point in each cell, and distances to them.

Source: S. Worley 1996, "A cellular texture basis function"; Cycles, ``kernel/svm/voronoi.h``
(Apache-2.0, MIT): order of the cells, and the hashes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .hashes import Numbers, color_of_numbers, of_cell, of_numbers

Array = NDArray[np.float32]
Point = list[Array]
Metric = Callable[[Sequence[Array], Any], Array]


def euclidean(offset: Sequence[Array], exponent: Numbers) -> Array:
    """Length of an offset."""
    return np.sqrt(square(offset))


def manhattan(offset: Sequence[Array], exponent: Numbers) -> Array:
    """Sum of the sizes along the axes."""
    return _total([np.abs(one) for one in offset])


def chebychev(offset: Sequence[Array], exponent: Numbers) -> Array:
    """Largest size along an axis."""
    return np.asarray(np.maximum.reduce([np.abs(one) for one in offset]))


def minkowski(offset: Sequence[Array], exponent: Numbers) -> Array:
    """Length by powers with an exponent, a number or array."""
    total = _total([np.asarray(np.abs(one) ** exponent, np.float32) for one in offset])
    return np.asarray(total ** (np.float32(1) / exponent))


#: Metrics by Blender's name.
METRICS: dict[str, Metric] = {
    "EUCLIDEAN": euclidean,
    "MANHATTAN": manhattan,
    "CHEBYCHEV": chebychev,
    "MINKOWSKI": minkowski,
}


def square(offset: Sequence[Array]) -> Array:
    """Square of the length of an offset."""
    return _total([one * one for one in offset])


def _total(terms: Sequence[Array]) -> Array:
    total = terms[0]
    for one in terms[1:]:
        total = total + one
    return total


@dataclass(frozen=True)
class Grid:
    """Cells around points of a pattern.

    Attributes:
        floors: Corner of the cell of each point, one array (N,) for each axis.
        inside: Place of each point in its cell.
        randomness: How far the points of cells are scattered, 0 .. 1, a number or array.
    """

    floors: Point
    inside: Point
    randomness: Numbers

    @classmethod
    def around(cls, point: Sequence[Array], randomness: Numbers) -> Grid:
        """Grid around points."""
        floors = [np.floor(axis) for axis in point]
        inside = [axis - floor for axis, floor in zip(point, floors, strict=True)]
        return cls(floors, inside, randomness)

    def near(self, reach: int) -> Iterator[tuple[int, ...]]:
        """Offsets of the cells up to a number of cells away, the first axis changing fastest."""
        for offset in product(range(-reach, reach + 1), repeat=len(self.floors)):
            yield offset[::-1]

    def scattered(self, offset: Sequence[Any]) -> Point:
        """Point of the cell at an offset, numbers or arrays, from the corner of the own cell."""
        cell = self._cell(offset)
        if len(cell) == 1:
            fractions = [of_numbers(*cell)]
        else:
            fractions = of_cell([_word(axis) for axis in cell], len(cell))
        return [
            by + one * self.randomness for by, one in zip(_singles(offset), fractions, strict=True)
        ]

    def color(self, offset: Sequence[Any]) -> list[Array]:
        """Colour of the cell at an offset."""
        cell = self._cell(offset)
        if len(cell) == 1:
            return color_of_numbers(cell)
        return of_cell([_word(axis) for axis in cell], 3)

    def _cell(self, offset: Sequence[Any]) -> Point:
        return [floor + by for floor, by in zip(self.floors, _singles(offset), strict=True)]


def _singles(offset: Sequence[Any]) -> list[Any]:
    return [np.asarray(one, np.float32) for one in offset]


def _word(axis: Array) -> NDArray[np.uint32]:
    return axis.astype(np.int32).view(np.uint32)
