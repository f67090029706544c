"""Fisheye projections, and the division model.

Source of the projections: Miyamoto 1964, Fish Eye Lens, JOSA 54(8). All have the scale of an ideal
lens of the same focal length near the axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .model import FloatArray, Radial
from .monotone import SAMPLES, Monotone
from .opencv import tangent


@dataclass(frozen=True)
class Equidistant(Radial):
    """Radius = theta: equal angles are equal lengths."""

    def _bent(self, radius: FloatArray) -> FloatArray:
        return np.asarray(np.arctan(radius))

    def _straight(self, radius: FloatArray) -> FloatArray:
        return tangent(radius)


@dataclass(frozen=True)
class Equisolid(Radial):
    """Radius = 2 sin(theta / 2): equal solid angles are equal areas."""

    def _bent(self, radius: FloatArray) -> FloatArray:
        return np.asarray(2 * np.sin(0.5 * np.arctan(radius)))

    def _straight(self, radius: FloatArray) -> FloatArray:
        return tangent(2 * np.arcsin(_up_to_one(0.5 * radius)))


@dataclass(frozen=True)
class Stereographic(Radial):
    """Radius = 2 tan(theta / 2): small shapes stay as they are."""

    def _bent(self, radius: FloatArray) -> FloatArray:
        return np.asarray(2 * np.tan(0.5 * np.arctan(radius)))

    def _straight(self, radius: FloatArray) -> FloatArray:
        return tangent(2 * np.arctan(0.5 * radius))


@dataclass(frozen=True)
class Orthographic(Radial):
    """Radius = sin(theta): the half sphere seen from far away."""

    def _bent(self, radius: FloatArray) -> FloatArray:
        return np.asarray(np.sin(np.arctan(radius)))

    def _straight(self, radius: FloatArray) -> FloatArray:
        return tangent(np.arcsin(_up_to_one(radius)))


@dataclass(frozen=True)
class Division(Radial):
    """Ideal radius = r / (1 + k1 r^2 + k2 r^4), r that of the lens.

    After Fitzgibbon 2001, Simultaneous linear estimation of multiple view geometry and lens
    distortion: one number serves even wide lenses.
    """

    k1: float = 0.0
    k2: float = 0.0

    @cached_property
    def _to_ideal(self) -> Monotone:
        return Monotone(self._formula, np.tan(np.linspace(0, 1.5, SAMPLES)))

    def _formula(self, radius: FloatArray) -> FloatArray:
        r2 = radius * radius
        below = 1 + r2 * (self.k1 + r2 * self.k2)
        return np.where(below > 0, radius / below, np.nan)

    def _bent(self, radius: FloatArray) -> FloatArray:
        return self._to_ideal.inverse(radius)

    def _straight(self, radius: FloatArray) -> FloatArray:
        return self._to_ideal(radius)


def _up_to_one(value: FloatArray) -> FloatArray:
    return np.where(value <= 1, value, np.nan)
