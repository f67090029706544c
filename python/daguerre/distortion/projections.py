"""Fisheye projections, and the division model.

Source of the projections: Miyamoto 1964, Fish Eye Lens, JOSA 54(8). All have the scale of an ideal
lens of the same focal length near the axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.cached import cached_property

from .model import FloatArray, Radial
from .monotone import SAMPLES, Monotone
from .projected import Projected


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class Equidistant(Projected):
    """Equidistant fisheye: radius = theta; equal angles are equal lengths."""

    _projection: ClassVar = "equidistant"


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class Equisolid(Projected):
    """Equisolid fisheye: radius = 2 sin(theta / 2); equal solid angles are equal areas."""

    _projection: ClassVar = "equisolid"


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class Stereographic(Projected):
    """Stereographic fisheye: radius = 2 tan(theta / 2); small shapes are kept."""

    _projection: ClassVar = "stereographic"


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class Orthographic(Projected):
    """Orthographic fisheye: radius = sin(theta); the hemisphere seen from far away."""

    _projection: ClassVar = "orthographic"


@guarded(init=True, arrays=False)
@dataclass(frozen=True)
class Division(Radial):
    """Division model: ideal radius = r / (1 + k1 r^2 + k2 r^4), r the lens's radius.

    After Fitzgibbon 2001, Simultaneous linear estimation of multiple view geometry and lens
    distortion. One parameter suffices even for wide lenses.
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
