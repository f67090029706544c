"""Quaternions x, y, z, w, also over time: interpolated along the shorter arc (``GfSlerp``)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.motion.values import Keys

Array = NDArray[np.float64]


def normalized(quaternions: Array) -> Array:
    """Scales quaternions (..., 4) to length 1; quaternions of length 0 become the identity."""
    lengths = np.linalg.norm(quaternions, axis=-1, keepdims=True)
    made: Array = np.where(
        lengths > 0, quaternions / np.where(lengths > 0, lengths, 1), (0.0, 0.0, 0.0, 1.0)
    )
    return made


def product(a: Array, b: Array) -> Array:
    """Quaternions (..., 4) of the turns ``b``, then ``a`` (Hamilton's product)."""
    u, v, s, t = a[..., :3], b[..., :3], a[..., 3:], b[..., 3:]
    vector = s * v + t * u + np.cross(u, v)
    return np.concatenate([vector, s * t - np.sum(u * v, axis=-1, keepdims=True)], axis=-1)


def of_vectors(turns: Array) -> Array:
    """Unit quaternions (..., 4) of turns about vectors (..., 3) by their lengths, rad."""
    angles = np.linalg.norm(turns, axis=-1, keepdims=True)
    return np.concatenate([0.5 * np.sinc(angles / (2 * np.pi)) * turns, np.cos(angles / 2)], -1)


def slerp(a: Array, b: Array, share: float) -> Array:
    """Interpolates quaternions (..., 4) on the unit sphere, along the shorter arc.

    Source: Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985.
    """
    dot = np.sum(a * b, axis=-1, keepdims=True)
    b = np.where(dot < 0, -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0, 1))
    close = angle < 1e-6
    sine = np.where(close, 1.0, np.sin(angle))
    first = np.where(close, 1 - share, np.sin((1 - share) * angle) / sine)
    second = np.where(close, share, np.sin(share * angle) / sine)
    mixed: Array = first * a + second * b
    return mixed


@dataclass(frozen=True, eq=False)
class QuaternionKeys(Value):
    """Quaternions at some times.

    Attributes:
        times: Rising, shape (K,), s.
        values: Shape (K, ..., 4), as x, y, z, w.
    """

    times: Array
    values: Array

    def at(self, time_s: float) -> Array:
        """The quaternions at a time, s, shape (..., 4)."""
        i = int(np.searchsorted(self.times, time_s, side="right")) - 1
        if i < 0 or i == len(self.times) - 1:
            held: Array = self.values[max(i, 0)]
            return held
        share = (time_s - self.times[i]) / (self.times[i + 1] - self.times[i])
        return slerp(self.values[i], self.values[i + 1], float(share))

    def breaks(self, begin: float, end: float) -> list[float]:
        """Times of the keys inside of (begin, end), s."""
        inside = self.times[(self.times > begin) & (self.times < end)]
        return [float(t) for t in inside]


def moving_turns(value: Keys) -> QuaternionKeys | Keys:
    """Interpolates keyed quaternions along arcs, unless they are held."""
    if value.interpolation == "step":
        return value
    return QuaternionKeys(value.times, np.array(value.values, np.float64))
