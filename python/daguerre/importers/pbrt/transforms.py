"""Transforms of pbrt: matrices that act on column vectors, in a left-handed frame.

A transform has two ends, at the start and the end of its motion; ``ActiveTransform`` chooses which
of them a directive changes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from daguerre.motion.values import Keys, keys

from .place import FilePlace

Matrix = NDArray[np.float64]
IDENTITY = np.eye(4)
IDENTITY.flags.writeable = False


def translation(offset: NDArray[np.float64]) -> Matrix:
    """Translation by an offset (3,)."""
    made = np.eye(4)
    made[:3, 3] = offset
    return made


def scaling(factors: NDArray[np.float64]) -> Matrix:
    """Scaling along the axes by factors (3,)."""
    return np.diag([*factors.tolist(), 1.0])


def unit_of(axes: Matrix) -> float:
    """Length of a unit of pbrt's world in the scene, m; ``axes`` is the scene from it, (4, 4)."""
    return float(abs(np.linalg.det(axes[:3, :3])) ** (1 / 3))


def rotation(degrees: float, axis: NDArray[np.float64], place: FilePlace) -> Matrix:
    """Rotation about an axis (3,), counter-clockwise as its tip sees it (Rodrigues' formula)."""
    length = float(np.linalg.norm(axis))
    if not length > 0:
        place.fail("the axis must not have zero length")
    x, y, z = (axis / length).tolist()
    cross = np.array([(0, -z, y), (z, 0, -x), (-y, x, 0)])
    angle = math.radians(degrees)
    made = np.eye(4)
    made[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return made


def look_at(numbers: NDArray[np.float64], place: FilePlace) -> Matrix:
    """Camera from world of an eye, a target and an up vector (9,); the camera looks along +z."""
    eye, target, up = numbers.reshape(3, 3)
    ahead = target - eye
    right = np.cross(up, ahead)
    if not np.linalg.norm(right) > 0:
        place.fail("the up vector must not be parallel to the view direction")
    ahead, right = ahead / np.linalg.norm(ahead), right / np.linalg.norm(right)
    world = np.eye(4)
    world[:3, 0], world[:3, 1], world[:3, 2] = right, np.cross(ahead, right), ahead
    world[:3, 3] = eye
    return inverse(world, place)


def inverse(matrix: Matrix, place: FilePlace) -> Matrix:
    """Inverse of a transform.

    Raises:
        InputError: The matrix is singular.
    """
    try:
        made = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        made = np.full((4, 4), np.nan)
    if not np.isfinite(made).all():
        place.fail("the transform has no inverse")
    return np.asarray(made, np.float64)


@dataclass(frozen=True, eq=False)
class Moving:
    """A transform with its two ends.

    Attributes:
        start: Matrix at the time ``times[0]``.
        end: Matrix at the time ``times[1]``; the same object: nothing moves.
        times: Times of both ends, s.
    """

    start: Matrix = field(default_factory=lambda: IDENTITY)
    end: Matrix = field(default_factory=lambda: IDENTITY)
    times: tuple[float, float] = (0.0, 1.0)

    @property
    def moves(self) -> bool:
        """Whether both ends differ."""
        return self.start is not self.end and not np.array_equal(self.start, self.end)

    def times_matrix(self, matrix: Matrix, at_start: bool, at_end: bool) -> Moving:
        """Multiplies the chosen ends by a matrix from the right."""
        if self.start is self.end and at_start and at_end:
            both = self.start @ matrix
            return replace(self, start=both, end=both)
        return replace(
            self,
            start=self.start @ matrix if at_start else self.start,
            end=self.end @ matrix if at_end else self.end,
        )

    def set_to(self, matrix: Matrix, at_start: bool, at_end: bool) -> Moving:
        """Replaces the chosen ends by a matrix."""
        return replace(
            self, start=matrix if at_start else self.start, end=matrix if at_end else self.end
        )

    def after(self, outer: Moving) -> Moving:
        """Returns this transform followed by another; the other's times count if it moves."""
        if not (self.moves or outer.moves):
            both = outer.start @ self.start
            return Moving(both, both)
        times = outer.times if outer.moves else self.times
        return Moving(outer.start @ self.start, outer.end @ self.end, times)

    def inverse(self, place: FilePlace) -> Moving:
        """Returns the inverse."""
        start = inverse(self.start, place)
        end = start if self.end is self.start else inverse(self.end, place)
        return replace(self, start=start, end=end)

    def value(self) -> Matrix | Keys:
        """The matrix, or keys of both ends if it moves."""
        if not self.moves or not self.times[0] < self.times[1]:
            return self.start
        return keys([(self.times[0], self.start), (self.times[1], self.end)])
