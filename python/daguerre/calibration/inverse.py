"""The inverse of a Brown-Conrady distortion as another one: a fit, with its largest error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Rational:
    """x (1 + a r2 + ...) / (1 + b r2 + ...) and two tangential terms, points in focal lengths.

    Attributes:
        over: Of r^2, r^4, r^6 in the numerator.
        under: The same in the denominator.
        aside: p1, p2, in OpenCV's order.
    """

    over: tuple[float, ...] = (0.0, 0.0, 0.0)
    under: tuple[float, ...] = (0.0, 0.0, 0.0)
    aside: tuple[float, ...] = (0.0, 0.0)

    @property
    def opencv(self) -> tuple[float, ...]:
        """In OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6."""
        return (*self.over[:2], *self.aside, self.over[2], *self.under)

    def __call__(self, points: FloatArray) -> FloatArray:
        """Points, shape (N, 2), distorted."""
        powers = _powers(points)
        factor = (1 + powers @ self.over) / (1 + powers @ self.under)
        return np.asarray(points * factor[:, None] + _aside(points) @ self.aside)


def _powers(points: FloatArray) -> FloatArray:
    r2 = (points**2).sum(axis=1)
    return np.stack([r2, r2**2, r2**3], axis=-1)


def _aside(points: FloatArray) -> FloatArray:
    """What p1 and p2 are multiplied with, shape (N, 2, 2)."""
    x, y = points.T
    r2 = x * x + y * y
    of_x, of_y = (2 * x * y, r2 + 2 * x * x), (r2 + 2 * y * y, 2 * x * y)
    return np.stack([np.stack(of_x, axis=-1), np.stack(of_y, axis=-1)], axis=1)


def fit_inverse(model: Rational, points: FloatArray, steps: int = 4) -> tuple[Rational, float]:
    """The model that takes ``model(points)`` back to ``points``, and its largest error.

    With the denominator on the other side the equations are linear; divided by that of the step
    before, their errors become those of the points (Sanathanan and Koerner 1963).
    """
    targets, ideal = points, model(points)
    powers, aside = _powers(ideal)[:, None], _aside(ideal)
    found = Rational()
    for _ in range(steps):
        weight = 1 / (1 + powers @ found.under)[:, :, None]
        over, under = ideal[:, :, None] * powers * weight, -targets[:, :, None] * powers * weight
        rows = np.concatenate([over, under, aside], axis=2).reshape(-1, 8)
        right = ((targets - ideal) * weight[..., 0]).reshape(-1)
        solved = [float(v) for v in np.linalg.lstsq(rows, right, rcond=1e-13)[0]]
        found = Rational(tuple(solved[:3]), tuple(solved[3:6]), tuple(solved[6:]))
    return found, float(np.hypot(*(found(ideal) - targets).T).max())
