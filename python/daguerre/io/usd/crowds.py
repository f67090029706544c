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


@dataclass(frozen=True, eq=False)
class Crowd(Value):
    """Transforms of N copies over time, or of one, where N is missing in all shapes.

    Attributes:
        times: Times of the samples, rising, shape (K,), s.
        positions: Shape (K, N, 3).
        turns: Unit quaternions x, y, z, w, shape (K, N, 4).
        scales: Shape (K, N, 3).
        velocities: Per second, shape (K, N, 3); None: positions lie on lines between samples.
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

    def at(self, time_s: float) -> Array:
        """The matrices at a time, s, shape (N, 4, 4)."""
        last = len(self.times) - 1
        i = min(max(int(np.searchsorted(self.times, time_s, side="right")) - 1, 0), last)
        j = min(i + 1, last)
        dt, length = time_s - self.times[i], self.times[j] - self.times[i]
        share = 0.0 if self.held or i == j else min(max(dt / length, 0.0), 1.0)
        place, turn = self._place(i, j, share, dt), self._turn(i, j, share, dt)
        return compose(place, turn, (1 - share) * self.scales[i] + share * self.scales[j])

    def _place(self, i: int, j: int, share: float, dt: float) -> Array:
        if self.velocities is None:
            mixed: Array = (1 - share) * self.positions[i] + share * self.positions[j]
            return mixed
        speed = self.velocities[i]
        if self.accelerations is not None:
            speed = speed + 0.5 * dt * self.accelerations[i]
        moved: Array = self.positions[i] + dt * speed
        return moved

    def _turn(self, i: int, j: int, share: float, dt: float) -> Array:
        if self.spins is not None:
            return product(of_vectors(dt * self.spins[i]), self.turns[i])
        return slerp(self.turns[i], self.turns[j], share) if share else self.turns[i]

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the samples, s."""
        return [float(t) for t in self.times if begin < t < end]

    @property
    def moves(self) -> bool:
        """Whether it may move."""
        return len(self.times) > 1 or self.velocities is not None or self.spins is not None

    def each(self) -> list[Crowd]:
        """All copies, one by one."""
        count = self.positions.shape[1]
        parts: list[list[Any]] = [
            [None] * count if part is None else list(np.ascontiguousarray(part.swapaxes(0, 1)))
            for part in (getattr(self, name) for name in _PARTS)
        ]
        return [Crowd(self.times, *one) for one in zip(*parts, [self.held] * count, strict=True)]

    def of(self, chosen: NDArray[np.int64]) -> Crowd:
        """Some of the copies."""
        parts = {name: getattr(self, name) for name in _PARTS}
        some: dict[str, Any] = {
            name: None if part is None else np.ascontiguousarray(part[:, chosen])
            for name, part in parts.items()
        }
        return replace(self, **some)
