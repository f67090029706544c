"""The models of lensfun, fitted by linear least squares.

Editors look up each point of the corrected picture in the lens's picture, so the models map
corrected radii to real ones:

``poly5``: real = r (1 + k1 r^2 + k2 r^4)
``ptlens``: real = r (1 - a - b - c + c r + b r^2 + a r^3)
``poly3``, for red and blue each: real = g (v + c g + b g^2), g the real radius of green
``pa``: light = 1 + k1 r^2 + k2 r^4 + k3 r^6, r a real radius

A radius of 1 is half of the frame's short side, for ``pa`` half of its diagonal. The scale of the
corrected picture is free: ``poly5`` keeps it on the axis, ``ptlens`` at radius 1.

Source: https://lensfun.github.io/manual/latest/corrections.html.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .frame import FloatArray

POLY5, PTLENS = "poly5", "ptlens"
#: Powers of the radius in each model of distortion.
POWERS = {POLY5: (1, 3, 5), PTLENS: (1, 2, 3, 4)}
DIGITS = 7  # behind the point, in files
#: Least light, as a share of the axis's, that vignetting is fitted to; the last makes it 1.
FLOORS = (2.0**-4, 2.0**-3, 2.0**-2, 2.0**-1, 1.0)
CORNER = 0.02  # least weight, of the largest: corners are no area, but must not turn black


@dataclass(frozen=True)
class Fit:
    """Coefficients of a model, and its residual over the frame: px, or EV of light.

    Attributes:
        terms: Coefficients by their names in files.
        rms: RMS residual over the area.
        largest: Largest residual.
    """

    terms: dict[str, float]
    rms: float
    largest: float


def fit_distortion(model: str, ideal: FloatArray, real: FloatArray, area: FloatArray) -> Fit:
    """Fits a model of distortion.

    Args:
        model: ``POLY5`` or ``PTLENS``.
        ideal: Radii without distortion, at any scale.
        real: Radii in the lens's picture.
        area: Weights.

    Returns:
        The fit, with its residual in units of radius.
    """
    powers = POWERS[model]
    factors = _solved(ideal, real, powers, area)
    misses = _sum(factors, ideal, powers) - real
    if model == POLY5:
        k = factors / factors[0] ** np.array(powers)
        return _fit({"k1": k[1], "k2": k[2]}, misses, area)
    where = np.roots([*factors[::-1], -1.0])
    corrected = 1 / min(x.real for x in where if abs(x.imag) < 1e-9 and x.real > 0)
    k = factors / corrected ** np.array(powers)
    return _fit({"a": k[3], "b": k[2], "c": k[1]}, misses, area)


def fit_colour(channel: str, green: FloatArray, other: FloatArray, area: FloatArray) -> Fit:
    """Fits lateral colour of red (``r``) or blue (``b``) radii; its residual is in their units."""
    powers = (1, 2, 3)
    factors = _solved(green, other, powers, area)
    names = (f"v{channel}", f"c{channel}", f"b{channel}")
    terms = dict(zip(names, factors, strict=True))
    return _fit(terms, _sum(factors, green, powers) - other, area)


def fit_vignetting(light: FloatArray, radius: FloatArray, area: FloatArray) -> Fit:
    """Fits light relative to the axis by its relative error; the residual is in EV.

    Corrections divide by the polynomial, so it must stay above 0. Where a corner is black, it is
    fitted to a corner that is not as dark.
    """
    powers = (2, 4, 6)
    weights = np.maximum(area, CORNER * area.max())
    fine = np.linspace(0, radius.max(), 200)
    for floor in FLOORS:
        wanted = np.maximum(light, floor)
        k = _solved(radius, wanted - 1, powers, weights / wanted**2)
        if (1 + _sum(k, fine, powers)).min() > 0.5 * floor:
            break
    misses = np.log2((1 + _sum(k, radius, powers)) / np.maximum(light, FLOORS[0]))
    return _fit(dict(zip(("k1", "k2", "k3"), k, strict=True)), misses, area)


def _solved(x: FloatArray, y: FloatArray, powers: Sequence[int], weights: FloatArray) -> FloatArray:
    root = np.sqrt(weights)
    columns = np.stack([x**p for p in powers], axis=1)
    return np.asarray(np.linalg.lstsq(columns * root[:, None], y * root, rcond=None)[0])


def _sum(factors: FloatArray, x: FloatArray, powers: Sequence[int]) -> FloatArray:
    return np.asarray(sum(k * x**p for k, p in zip(factors, powers, strict=True)))


def _fit(terms: dict[str, float], misses: FloatArray, area: FloatArray) -> Fit:
    rms = math.sqrt(float((area * misses**2).sum() / area.sum()))
    rounded = {name: round(float(k), DIGITS) for name, k in terms.items()}
    return Fit(rounded, rms, float(np.abs(misses).max()))
