"""Transforms of many copies over time: by keys, or along velocities and angular velocities.

Source: OpenUSD, UsdGeomPointInstancer, "Computing an Instance Transform" and "Applying Timesampled
Velocities to Geometry".
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.scene.transforms import compose

from .quaternions import of_vectors, product, slerp

Array = NDArray[np.float64]
_PARTS = ("positions", "turns", "scales", "velocities", "accelerations", "spins")
#: A sample, and one of the copies or all of them.
_Rows = tuple[int, int | slice]
_ALL = slice(None)


@dataclass(frozen=True, eq=False)
class Crowd(Value):
    """Transforms of N copies over time.

    Attributes:
        times: Times of the samples, rising, shape (K,), s.
        positions: Shape (K, N, 3).
        turns: Unit quaternions x, y, z, w, shape (K, N, 4).
        scales: Shape (K, N, 3).
        velocities: Per second, shape (K, N, 3); None: positions are linear between samples.
        accelerations: Per second squared, shape (K, N, 3), or None.
        spins: Angular velocities, rad/s, shape (K, N, 3); None: turns follow arcs between samples.
        held: Whether values are held between samples.
    """

    times: Array
    positions: Array
    turns: Array
    scales: Array
    velocities: Array | None = None
    accelerations: Array | None = None
    spins: Array | None = None
    held: bool = False

    def at(self, time_s: float, copy: int | slice = _ALL) -> Array:
        """The matrices at a time, s, shape (N, 4, 4); the matrix of one copy, shape (4, 4)."""
        last = len(self.times) - 1
        i = min(max(int(np.searchsorted(self.times, time_s, side="right")) - 1, 0), last)
        j = min(i + 1, last)
        dt, length = time_s - self.times[i], self.times[j] - self.times[i]
        share = 0.0 if self.held or i == j else min(max(dt / length, 0.0), 1.0)
        one, other = (i, copy), (j, copy)
        place, turn = self._place(one, other, share, dt), self._turn(one, other, share, dt)
        return compose(place, turn, (1 - share) * self.scales[one] + share * self.scales[other])

    def _place(self, one: _Rows, other: _Rows, share: float, dt: float) -> Array:
        if self.velocities is None:
            mixed: Array = (1 - share) * self.positions[one] + share * self.positions[other]
            return mixed
        speed = self.velocities[one]
        if self.accelerations is not None:
            speed = speed + 0.5 * dt * self.accelerations[one]
        moved: Array = self.positions[one] + dt * speed
        return moved

    def _turn(self, one: _Rows, other: _Rows, share: float, dt: float) -> Array:
        if self.spins is not None:
            return product(of_vectors(dt * self.spins[one]), self.turns[one])
        return slerp(self.turns[one], self.turns[other], share) if share else self.turns[one]

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the samples, s."""
        return [float(t) for t in self.times if begin < t < end]

    @property
    def moves(self) -> bool:
        """Whether it may move."""
        return len(self.times) > 1 or self.velocities is not None or self.spins is not None

    def each(self) -> list[OneOfCrowd]:
        """Each copy as a separate value."""
        return [OneOfCrowd(self, number) for number in range(self.positions.shape[1])]

    def of(self, chosen: NDArray[np.int64]) -> Crowd:
        """Some of the copies."""
        parts = {name: getattr(self, name) for name in _PARTS}
        some: dict[str, Any] = {
            name: None if part is None else np.ascontiguousarray(part[:, chosen])
            for name, part in parts.items()
        }
        return replace(self, **some)


@dataclass(frozen=True, eq=False)
class OneOfCrowd(Value):
    """One copy of a crowd, which holds the numbers of all: there may be a million of them."""

    crowd: Crowd
    number: int

    def at(self, time_s: float) -> Array:
        """Its matrix at a time, s, shape (4, 4)."""
        return self.crowd.at(time_s, self.number)

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the samples, s."""
        return self.crowd.breaks(begin, end)
