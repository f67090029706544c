"""Spherical harmonics of order 2 and their irradiance of a matt surface.

The irradiance of a surface with normal n by light of coefficients L_lm is the sum of
A_l L_lm Y_lm(n) with A = pi, 2 pi / 3, pi / 4: higher orders hardly matter on a matt ball. Source:
Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps, SIGGRAPH
2001, equations 3 and 8.
"""

from __future__ import annotations

import math

import numpy as np

from .latlong import FloatArray

#: Factor of each of the nine functions from light to irradiance.
IRRADIANCE = np.array([math.pi] + [2 * math.pi / 3] * 3 + [math.pi / 4] * 5)


def basis(toward: FloatArray) -> FloatArray:
    """The nine real functions up to order 2 at unit vectors (..., 3), shape (..., 9)."""
    x, y, z = np.moveaxis(toward, -1, 0)
    parts = [
        np.full_like(x, 0.282095),
        *(0.488603 * v for v in (y, z, x)),
        *(1.092548 * v for v in (x * y, y * z, x * z)),
        0.315392 * (3 * z * z - 1),
        0.546274 * (x * x - y * y),
    ]
    return np.stack(parts, axis=-1)


def scattered(count: int) -> FloatArray:
    """Evenly distributed directions on the sphere (Fibonacci lattice), shape (N, 3)."""
    i = np.arange(count) + 0.5
    z, turn = 1 - 2 * i / count, math.pi * (1 + math.sqrt(5)) * i
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)
