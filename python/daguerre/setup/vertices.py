"""Resampling of vertices over time to even steps of an interval."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from daguerre.motion.resample import BOUND, PATH_BOUND
from daguerre.motion.subdivision import FIRST, some_breaks
from daguerre.motion.values import Dynamic
from daguerre.scene.motion import Vertices

#: Steps of a mesh (Embree has no more), and vertices in all steps of one together.
MAX_STEPS = 129
MAX_STEP_VERTICES = 1 << 24
# Breaks that are looked at.
_MAX_BREAKS = 64
#: Bound of the angle between normals and those interpolated from steps, rad, and the share of
#: vertices that may exceed it, as normals at folds jump.
_NORMAL_BOUND, _FOLDS = 2e-3, 1e-3


def resample_vertices(
    dynamic: Dynamic, open_s: float, close_s: float
) -> tuple[list[Vertices], bool]:
    """Resamples vertices to even steps with linear interpolation.

    One step means that nothing changes. Otherwise there are 2, 3, 5, ... 129, until no vertex is
    off by more than ``BOUND`` of the radius of the mesh, or ``PATH_BOUND`` of the longest path if
    that is more.

    Args:
        dynamic: The vertices.
        open_s: Begin of the interval, s.
        close_s: End of the interval, s.

    Returns:
        The vertices at each step, and whether they are within the bound.
    """
    grid = _Grid(dynamic, open_s, close_s)
    first = grid.at(0.0)
    if open_s == close_s:
        return [first], True
    some = some_breaks(dynamic, open_s, close_s, _MAX_BREAKS)
    checks = [(t - open_s) / (close_s - open_s) for t in some]
    if all(_same(grid.once(s), first) for s in (*FIRST, *checks, 1.0)):
        return [first], True
    most = min(MAX_STEPS, max(2, MAX_STEP_VERTICES // max(1, len(first.positions))))
    count = 1
    while True:
        middles = [(i + 0.5) / count for i in range(count)]
        keeps = grid.fits(count, middles) and grid.fits(count, [*FIRST, *checks])
        if keeps or 2 * count + 1 > most:
            return [grid.at(i / count) for i in range(count + 1)], keeps
        count *= 2


class _Grid:
    """Vertices at fractions of the interval."""

    def __init__(self, dynamic: Dynamic, open_s: float, close_s: float) -> None:
        self._dynamic, self._open, self._close = dynamic, open_s, close_s
        self._kept: dict[float, Vertices] = {}

    def once(self, fraction: float) -> Vertices:
        """Evaluates the vertices without caching, as they may be many."""
        found = self._kept.get(fraction)
        time = (1 - fraction) * self._open + fraction * self._close
        return self._dynamic.at(time) if found is None else found

    def at(self, fraction: float) -> Vertices:
        """Evaluates the vertices, with caching."""
        self._kept[fraction] = self.once(fraction)
        return self._kept[fraction]

    def fits(self, count: int, checks: Sequence[float]) -> bool:
        """Whether ``count`` segments are within the bound at some fractions."""
        first, last = _points(self.at(0.0)), _points(self.at(1.0))
        radius = 0.5 * float(np.linalg.norm(np.ptp(first, axis=0)))
        way = float(np.linalg.norm(last - first, axis=1).max())
        limit = max(BOUND * radius, PATH_BOUND * way)
        for check in checks:
            left = min(int(check * count), count - 1)
            a, b = _points(self.at(left / count)), _points(self.at((left + 1) / count))
            s = check * count - left
            dyadic = s == 0.5  # a step of twice as many
            found = self.at(check) if dyadic else self.once(check)
            if np.linalg.norm(_points(found) - (1 - s) * a - s * b, axis=1).max() > limit:
                return False
            if not self._turns_evenly(found, left / count, (left + 1) / count, s):
                return False
        return True

    def _turns_evenly(self, found: Vertices, begin: float, end: float, share: float) -> bool:
        """Whether normals lie within the bound of those between two steps."""
        a, b = self.at(begin).normals, self.at(end).normals
        if found.normals is None or a is None or b is None:
            return True
        between = (1 - share) * a + share * b
        lengths = np.linalg.norm(between, axis=1, keepdims=True)
        off = found.normals - between / np.where(lengths > 0, lengths, 1)
        return bool(np.mean(np.linalg.norm(off, axis=1) > _NORMAL_BOUND) <= _FOLDS)


def _points(vertices: Vertices) -> NDArray[np.float64]:
    return vertices.positions.astype(np.float64)


def _same(a: Vertices, b: Vertices) -> bool:
    return all(same_array(x, getattr(b, name)) for name, x in vars(a).items())


def same_array(a: NDArray[np.float32] | None, b: NDArray[np.float32] | None) -> bool:
    """Whether two arrays are equal, or both absent."""
    return a is b or (a is not None and b is not None and np.array_equal(a, b))
