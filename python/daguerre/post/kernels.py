"""Kernels of spread light, each with sum 1 over its window.

Rows from the top; odd numbers of pixels, with the source in the middle pixel.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
FINE = 5  # points across a pixel near the source


def delta(size: int) -> Floats:
    """Identity kernel."""
    out = np.zeros((size, size), np.float32)
    out[size // 2, size // 2] = 1
    return out


def radial(
    size: int,
    profile: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    *,
    fading: bool = False,
) -> Floats:
    """Makes a round kernel from light per area by distance in px, averaged over each pixel.

    A long tail ends at the square window, which shows around a bright lamp. With ``fading`` it
    falls to 0 over the outer third of the window's half width.
    """
    at = np.arange(size) - size // 2.0
    distance = np.hypot(at[:, None], at)
    kernel = profile(distance)
    if fading:
        rim = np.clip(3 * (1 - distance / (0.5 * size)), 0, 1)
        kernel *= rim * rim * (3 - 2 * rim)
    near = min(size // 2, 8)  # within this distance a pixel is not small
    inner = slice(size // 2 - near, size // 2 + near + 1)
    fine = (np.arange(FINE * (2 * near + 1)) + 0.5) / FINE - near - 0.5
    values = profile(np.hypot(fine[:, None], fine))
    kernel[inner, inner] = values.reshape(2 * near + 1, FINE, 2 * near + 1, FINE).mean(axis=(1, 3))
    return np.asarray(kernel / kernel.sum(), np.float32)


def bloom(radius_px: float, size: int) -> Floats:
    """Bloom kernel: light scattered around a source, half of it within the radius.

    It is (1 + (r / a)^2)^(-3/2) / (2 pi a^2) with a = radius / sqrt(3); the share within R is
    1 - 1 / sqrt(1 + (R / a)^2). Its tail falls as 1 / r^3, as in glare of the eye (Spencer,
    Shirley, Zimmerman and Greenberg 1995, Physically-based glare effects for digital images).
    """
    a = radius_px / math.sqrt(3)
    return radial(size, lambda r: (1 + (r / a) ** 2) ** -1.5, fading=True)


def halation(thickness_px: float, index: float, size: int) -> Floats:
    """Halation kernel: light scattered by the emulsion and reflected at the back of the base.

    A Lambertian point over a base of thickness t lights the emulsion again at r = 2 t tan(theta)
    with R(theta) cos^4(theta) / (4 pi t^2), R by Fresnel's equations. R is 1 beyond the critical
    angle, which gives the ring of radius 2 t / sqrt(n^2 - 1).
    """

    def profile(r: NDArray[np.float64]) -> NDArray[np.float64]:
        cosine = 1 / np.sqrt(1 + (r / (2 * thickness_px)) ** 2)
        beyond = np.maximum(0, 1 - index**2 * (1 - cosine**2))
        out = np.sqrt(beyond)  # cosine in air; 0 at total reflection
        s = (index * cosine - out) / (index * cosine + out)
        p = (index * out - cosine) / (index * out + cosine)
        reflected = np.where(beyond > 0, 0.5 * (s * s + p * p), 1)
        return np.asarray(reflected * cosine**4)

    return radial(size, profile, fading=True)


def scatter(shoulder_px: float, slope: float, size: int) -> Floats:
    """Veiling glare kernel: (1 + (r / shoulder)^2)^(-slope / 2).

    This is the form of Harvey and Shack for scatter by polished and dusty surfaces (Harvey 1976,
    Light-scattering characteristics of optical surfaces): flat within the shoulder, then a power
    law.
    """
    return radial(size, lambda r: (1 + (r / shoulder_px) ** 2) ** (-0.5 * slope))
