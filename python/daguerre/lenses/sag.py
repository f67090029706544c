"""Sag of surfaces in numpy; for edge checks, not for tracing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .surface import LensSurface

Array = NDArray[np.float64]


def sag(surface: LensSurface, x: Array, y: Array) -> Array:
    """Sag of a surface over its vertex plane, mm; NaN where the surface has none."""
    s = surface
    c = 1 / s.radius if s.radius else 0.0
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        if s.kind == "cyl-x":
            z = _conic(c, s.conic, y)
        elif s.kind == "cyl-y":
            z = _conic(c, s.conic, x)
        elif s.kind == "biconic":
            z = _biconic(s, c, x, y)
        elif s.kind == "toroid":
            z = _toroid(s, c, x, y)
        else:
            z = _conic(c, s.conic, np.hypot(x, y))
        r = np.hypot(x, y)
        for power, coefficient in s.asphere.items():
            z = z + coefficient * r**power
    return np.asarray(z)


def _conic(c: float, k: float, r: Array) -> Array:
    return np.asarray(c * r * r / (1 + np.sqrt(1 - (1 + k) * c * c * r * r)))


def _biconic(s: LensSurface, c: float, x: Array, y: Array) -> Array:
    cx = 1 / s.radius_x if s.radius_x else 0.0
    root = 1 - (1 + s.conic_x) * (cx * x) ** 2 - (1 + s.conic) * (c * y) ** 2
    return np.asarray((cx * x * x + c * y * y) / (1 + np.sqrt(root)))


def _toroid(s: LensSurface, c: float, x: Array, y: Array) -> Array:
    """Sag of the y-z section turned about an axis parallel to y at distance radius_x."""
    profile = _conic(c, s.conic, y)
    if not s.radius_x:
        return profile
    left = s.radius_x - profile
    return np.asarray(s.radius_x - np.sign(left) * np.sqrt(left * left - x * x))
