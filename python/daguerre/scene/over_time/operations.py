"""Transforms over time: stacks of operations, and values derived from them.

USD interpolates the value of each operation, then multiplies; so a turn by keyed angles is a turn
at any time. Matrices here act on column vectors; USD's act on rows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import Value
from daguerre.motion.values import Dynamic, is_dynamic
from daguerre.motion.values import at as value_at
from daguerre.scene.transforms import compose, without_scale

Matrix = NDArray[np.float64]
_AXES = {"X": 0, "Y": 1, "Z": 2}


@dataclass(frozen=True, eq=False)
class Operation(Value):
    """An operation of a stack.

    Attributes:
        kind: ``transform``, ``translate``, ``scale``, ``rotate`` or ``orient``.
        axes: Axes of a translation or scale along some axes, or of rotations, in their order.
        value: Its numbers: a matrix, lengths, factors, degrees or a quaternion; constant or over
            time.
        inverse: Whether the inverse is meant.
    """

    kind: str
    axes: str
    value: Any
    inverse: bool

    def at(self, time_s: float) -> Matrix:
        """The matrix at a time, s."""
        value = value_at(self.value, time_s)
        if self.kind == "transform":
            made = np.array(value, np.float64)
        elif self.kind == "orient":
            made = _of_quaternion(value)
        else:
            numbers = np.atleast_1d(np.asarray(value, np.float64))
            made = _MAKERS[self.kind](numbers, self.axes)
        return np.asarray(np.linalg.inv(made), np.float64) if self.inverse else made

    def breaks(self, begin: float, end: float) -> Sequence[float] | NDArray[np.float64]:
        """Times of the keys of its value, s."""
        return self.value.breaks(begin, end) if is_dynamic(self.value) else []


@dataclass(frozen=True, eq=False)
class Transform(Value):
    """A product of transforms, constant or over time, the outermost first."""

    parts: tuple[Matrix | Dynamic, ...]

    def at(self, time_s: float) -> Matrix:
        """The matrix at a time, s."""
        made = np.eye(4)
        for part in self.parts:
            made = made @ (part if isinstance(part, np.ndarray) else part.at(time_s))
        return made

    def breaks(self, begin: float, end: float) -> list[float]:
        """Breaks of all parts, s."""
        moving = [part for part in self.parts if not isinstance(part, np.ndarray)]
        return sorted({float(t) for part in moving for t in part.breaks(begin, end)})


@dataclass(frozen=True, eq=False)
class Rigid(Value):
    """A transform without its scale, over time, for a camera or a lamp."""

    transform: Dynamic

    def at(self, time_s: float) -> Matrix:
        """The matrix at a time, s; the identity where an axis vanishes."""
        found = without_scale(self.transform.at(time_s))
        return np.eye(4) if found is None else found

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the transform, s."""
        return [float(t) for t in self.transform.breaks(begin, end)]


@dataclass(frozen=True, eq=False)
class Place(Value):
    """A point of a transform over time: its origin."""

    transform: Dynamic

    def at(self, time_s: float) -> Matrix:
        """World position at a time, s, shape (3,), m."""
        return np.array(self.transform.at(time_s)[:3, 3])

    def breaks(self, begin: float, end: float) -> Sequence[float]:
        """Breaks of the transform, s."""
        return [float(t) for t in self.transform.breaks(begin, end)]


def _translation(lengths: Matrix, axes: str) -> Matrix:
    made = np.eye(4)
    for axis, length in zip(axes, lengths, strict=True):
        made[_AXES[axis], 3] = length
    return made


def _scale(factors: Matrix, axes: str) -> Matrix:
    made = np.eye(4)
    for axis, factor in zip(axes, factors, strict=True):
        made[_AXES[axis], _AXES[axis]] = factor
    return made


def _rotation(degrees: Matrix, axes: str) -> Matrix:
    """Turns about axes, the first innermost; the angles are about x, y and z, in this order."""
    made = np.eye(4)
    for axis in axes:
        angle = degrees[0] if len(axes) == 1 else degrees[_AXES[axis]]
        made = _turn(_AXES[axis], math.radians(float(angle))) @ made
    return made


def _turn(axis: int, angle: float) -> Matrix:
    made, i, j = np.eye(4), (axis + 1) % 3, (axis + 2) % 3
    made[i, i] = made[j, j] = math.cos(angle)
    made[j, i] = math.sin(angle)
    made[i, j] = -made[j, i]
    return made


def _of_quaternion(xyzw: object) -> Matrix:
    q = np.asarray(xyzw, np.float64)
    length = float(np.linalg.norm(q))
    unit = q / length if length > 0 else np.array([0.0, 0.0, 0.0, 1.0])
    return compose(np.zeros(3), unit, np.ones(3))


_MAKERS = {"translate": _translation, "scale": _scale, "rotate": _rotation}
