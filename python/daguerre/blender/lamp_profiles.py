"""Falloff of spot lamps and of area lamps with a spread, as light profiles.

Source: measured in pictures by Cycles 5.0; ``tests/blender/test_lights.py`` repeats that. With c
the cosine of the angle to the axis, and h half of the cone, a spot has the factor 3 t^2 - 2 t^3,
where t = (c - cos h) / ((1 - cos h) blend) within 0 and 1. An area lamp with a spread of 2 h has
max(tan h - tan theta, 0) / (tan h - h): a grid of cells with walls that block light, normalized to
the power of the lamp.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.light_profile import LightProfile

Array = NDArray[np.float64]
_ANGLES = 257
#: Least width of an edge, radians: a table cannot jump.
_EDGE = 1e-4
#: Least step of a table, radians, that single precision tells apart.
_STEP = 1e-6
#: Spread above which a lamp shines evenly.
_EVEN = math.pi - 1e-3


def spot_profile(half: float, blend: float) -> LightProfile:
    """Makes the factor of a spot lamp, 1 on its axis.

    Args:
        half: Angle from the axis to the edge of the cone, radians.
        blend: Share of the cone, by cosine, over which light fades, 0 to 1.
    """
    edge = min(max(half, 2 * _EDGE), math.pi)
    width = (1 - math.cos(edge)) * max(blend, 0.0)
    inner = min(math.acos(min(math.cos(edge) + width, 1.0)), edge - _EDGE)
    count = min(max(int((edge - inner) / _STEP), 2), _ANGLES)
    theta = np.linspace(inner, edge, count)
    share = (np.cos(theta) - math.cos(edge)) / (math.cos(inner) - math.cos(edge))
    share = np.clip(share, 0.0, 1.0)
    return _table(theta, share**2 * (3 - 2 * share))


def spread_profile(spread: float) -> LightProfile | None:
    """Makes the factor of an area lamp with a spread, radians; None: it shines evenly."""
    if spread >= _EVEN:
        return None
    half = max(spread / 2, 1e-3)
    theta = half * np.sin(np.linspace(0.0, math.pi / 2, _ANGLES))
    factor = (math.tan(half) - np.tan(theta)) / (math.tan(half) - half)
    return _table(theta, np.maximum(factor, 0.0))


def _table(theta: Array, values: Array) -> LightProfile:
    """A profile of angles, radians; from the axis to the first angle it is the first value."""
    if theta[0] > 0:
        theta, values = np.append(0.0, theta), np.append(values[0], values)
    return LightProfile.table(np.degrees(theta), values)
