"""Conversion of curves in any basis to Bezier segments, which the core traces.

A cubic segment of control points p0 .. p3 is rewritten by a matrix; both forms are the same curve.
Sources: Farin 2002, Curves and Surfaces for CAGD (B-splines); Catmull and Rom 1974, A class of
local interpolating splines; OpenUSD, UsdGeomBasisCurves (which points a curve has, its wraps and
the points that a pinned curve adds at its ends).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.cached import cached_property
from daguerre.files.value import FixedArrays

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

#: Bezier points (rows) of a segment from its four control points (columns).
_TO_BEZIER: dict[str, Array] = {
    "bezier": np.eye(4),
    "bspline": np.array([[1, 4, 1, 0], [0, 4, 2, 0], [0, 2, 4, 0], [0, 1, 4, 1]]) / 6,
    "catmull-rom": np.array([[0, 6, 0, 0], [-1, 6, 1, 0], [0, 1, 6, -1], [0, 0, 6, 0]]) / 6,
}


def wanted_count(basis: str, wrap: str) -> str:
    """Says how many control points a curve has."""
    if basis == "bezier":
        return "3, 6, 9, ..." if wrap == "periodic" else "4, 7, 10, ..."
    if wrap == "periodic":
        return "at least 3"
    return "at least 2" if wrap == "pinned" or basis == "linear" else "at least 4"


def are_counts(counts: Counts, basis: str, wrap: str) -> NDArray[np.bool_]:
    """Whether curves may have these numbers of control points."""
    return np.asarray((counts > 0) & (fitting_counts(counts, basis, wrap) == counts))


def fitting_counts(counts: Counts, basis: str, wrap: str) -> Counts:
    """Largest numbers of control points up to these that curves may have; 0: they are too few."""
    if basis == "bezier":
        end = 0 if wrap == "periodic" else 1
        segments = (counts - end) // 3
        return np.where(segments > 0, 3 * segments + end, 0)
    least = int(wanted_count(basis, wrap).split()[-1])
    return np.where(counts >= least, counts, 0)


@dataclass(frozen=True, eq=False)
class BezierForm(FixedArrays):
    """Map from the control points of curves to the control points of their segments.

    Attributes:
        basis: Basis of the curves.
        first: Control points, including points that wraps add: ``2 p[first] - p[second]`` where
            ``mirrored``, else ``p[first]``; shape (E,).
        second: See ``first``.
        mirrored: See ``first``.
        windows: First of the control points of each segment, in the list that ``first`` makes;
            shape (S,).
        starts: First position of each segment, shape (S,).
        ends: One past the last segment of each curve, shape (C,).
    """

    basis: str
    first: Counts
    second: Counts
    mirrored: NDArray[np.bool_]
    windows: Counts
    starts: NDArray[np.uint32]
    ends: NDArray[np.uint32]

    def of(self, values: NDArray[np.generic]) -> Array:
        """Computes positions, or other values that points have, shape (N, K) to (P, K)."""
        given = np.asarray(values, np.float64)
        points = given[self.first]
        points[self.mirrored] = 2 * points[self.mirrored] - given[self.second[self.mirrored]]
        if self.basis == "linear":
            return points
        matrix = _TO_BEZIER[self.basis]
        out = np.empty((len(self.starts) * 3 + len(self.ends), given.shape[1]))
        for row in range(4):
            used = [(column, w) for column, w in enumerate(matrix[row]) if w != 0]
            sums = sum(points[self.windows + column] * w for column, w in used)
            if row < 3:
                out[self.starts.astype(np.int64) + row] = sums
            else:
                last = self.ends.astype(np.int64) - 1
                out[self.starts[last].astype(np.int64) + 3] = np.asarray(sums)[last]
        return out


def bezier_form(counts: Counts, basis: str, wrap: str) -> BezierForm:
    """Lays out the segments of curves with these numbers of control points, which fit the basis."""
    pinned = wrap == "pinned" and basis in ("bspline", "catmull-rom")
    before = int(pinned)
    after = _wrapped_points(basis) if wrap == "periodic" else before
    lengths = counts + before + after
    place = _places(lengths) - before
    base = np.repeat(np.cumsum(counts) - counts, lengths)
    n = np.repeat(counts, lengths)
    inside = np.clip(place, 0, n - 1)
    mirrored = (place != inside) if pinned else np.zeros(len(place), bool)
    first = base + (place % n if wrap == "periodic" else inside)
    toward = np.where(place < 0, np.minimum(1, n - 1), np.maximum(n - 2, 0))
    per_curve, step = _segments(lengths, basis)
    windows = np.repeat(np.cumsum(lengths) - lengths, per_curve) + step * _places(per_curve)
    segments = np.arange(len(windows))
    starts = (3 if basis != "linear" else 1) * segments + np.repeat(
        np.arange(len(counts)), per_curve
    )
    ends = np.cumsum(per_curve)
    return BezierForm(
        basis, first, base + toward, mirrored, windows,
        starts.astype(np.uint32), ends.astype(np.uint32),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Layout(FixedArrays):
    """Counts, basis and wrap of curves, from which their segments follow.

    Attributes:
        counts: Number of control points of each curve, shape (C,).
        basis: One of ``curves.BASES``.
        wrap: One of ``curves.WRAPS``.
    """

    counts: Counts
    basis: str
    wrap: str

    @cached_property
    def form(self) -> BezierForm:
        """Map to the control points of the segments."""
        return bezier_form(self.counts, self.basis, self.wrap)


def _wrapped_points(basis: str) -> int:
    """Points at the beginning that a closed curve uses again at its end."""
    return 1 if basis in ("bezier", "linear") else 3


def _segments(lengths: Counts, basis: str) -> tuple[Counts, int]:
    """Segments of each curve, and control points from one to the next."""
    if basis == "bezier":
        return (lengths - 1) // 3, 3
    return lengths - (1 if basis == "linear" else 3), 1


def _places(lengths: Counts) -> Counts:
    """Index of each element within its list, for concatenated lists of these lengths."""
    return np.arange(lengths.sum()) - np.repeat(np.cumsum(lengths) - lengths, lengths)
