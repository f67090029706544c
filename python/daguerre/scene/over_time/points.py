"""Points that move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.motion.values import Dynamic

Array = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Ballistic(Value):
    """Points that leave each time sample at a velocity.

    Attributes:
        times: Times of the samples, rising, shape (K,), s.
        points: K arrays (N, 3).
        velocities: K arrays (N, 3), per second.
        accelerations: K arrays (N, 3), per second squared, or None.
    """

    times: NDArray[np.float64]
    points: tuple[Array, ...]
    velocities: tuple[Array, ...]
    accelerations: tuple[Array, ...] | None

    def at(self, time_s: float) -> Array:
        """The points at a time, s, from the last sample up to it, else from the first sample."""
        i = max(int(np.searchsorted(self.times, time_s, side="right")) - 1, 0)
        dt = np.float32(time_s - self.times[i])
        moved = self.points[i] + dt * self.velocities[i]
        if self.accelerations is not None:
            moved = moved + np.float32(0.5) * dt * dt * self.accelerations[i]
        return np.asarray(moved, np.float32)

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the samples inside of (begin, end), s."""
        return [float(t) for t in self.times if begin < t < end]


@dataclass(frozen=True, eq=False)
class ChosenOverTime(Value):
    """Chosen points of a prim over time, such as the point of each vertex of a polygon mesh.

    Attributes:
        points: Points of the prim over time, shape (P, 3).
        origins: Indices of the chosen points, shape (N,).
    """

    points: Dynamic
    origins: NDArray[np.int64]

    def at(self, time_s: float) -> Array:
        """Positions at a time, s, shape (N, 3)."""
        found: Array = np.asarray(self.points.at(time_s), np.float32)[self.origins]
        return found

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the points, s."""
        return [float(t) for t in self.points.breaks(begin, end)]
