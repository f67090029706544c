"""Emitters that are not surfaces. They sit at the origin of their transform and shine along its -z."""

from __future__ import annotations

import math
from dataclasses import dataclass

Color = tuple[float, float, float]


@dataclass(frozen=True)
class PointLight:
    """Intensity in cd; with a radius (m) it becomes a visible ball of the same intensity."""

    intensity: Color = (1.0, 1.0, 1.0)
    range: float = math.inf
    radius: float = 0.0
    name: str = ""


@dataclass(frozen=True)
class SpotLight:
    """Intensity on the axis in cd; half angles in degrees."""

    intensity: Color = (1.0, 1.0, 1.0)
    inner_angle: float = 0.0
    outer_angle: float = 45.0
    range: float = math.inf
    name: str = ""


@dataclass(frozen=True)
class DirectionalLight:
    """Illuminance in lux on a facing surface."""

    illuminance: Color = (1.0, 1.0, 1.0)
    name: str = ""


@dataclass(frozen=True)
class SphereLight:
    """A ball of even luminance (cd/m2) that rays can hit; radius in m."""

    luminance: Color = (1.0, 1.0, 1.0)
    radius: float = 0.1
    name: str = ""
