"""Dielectric coats where other renderers' differ from ours: bases below them, and thin sheets."""

from __future__ import annotations

import math

import numpy as np

from .pictures import Colored, changed


def mean_inside(ior: float) -> float:
    """Mean reflectance of an interface for diffuse light from inside the dielectric.

    Source: reciprocity, 1 - F_outside = n^2 (1 - F_inside); total reflection is in it.
    """
    if ior < 1:
        return mean_outside(1 / ior)
    return 1 - (1 - mean_outside(ior)) / ior**2


def mean_outside(ior: float) -> float:
    """Mean reflectance for diffuse light from outside, 2 times the integral of F cos; ior >= 1.

    Source: Fresnel's equations, by Gauss's rule over the cosine.
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    cosine = (nodes + 1) / 2
    root = np.sqrt(1 - (1 - cosine**2) / ior**2)
    s = (cosine - ior * root) / (cosine + ior * root)
    p = (ior * cosine - root) / (ior * cosine + root)
    return float(np.sum(weights * 0.5 * (s**2 + p**2) * cosine))


def base_below(color: Colored, ior: float) -> Colored:
    """Colour of a base that, with all light between it and a coat, looks like ``color``.

    A base of colour r below a coat reflects r / (1 - r F) of the light that enters, F the mean
    reflectance from inside; ours reflects c / (1 - F). So r = c / (1 - F + c F).
    """
    inside = mean_inside(ior)
    return changed(color, lambda shade: shade / (1 - inside + shade * inside))


def head_on(ior: float) -> float:
    """Reflectance of an interface at normal incidence."""
    return ((ior - 1) / (ior + 1)) ** 2


def sheet_ior(ior: float) -> float:
    """Index of a sheet with internal reflections that reflects like a single interface of ``ior``.

    Both at normal incidence: an interface of reflectance R makes a sheet of 2 R / (1 + R).
    """
    sheet = head_on(ior)
    root = math.sqrt(sheet / (2 - sheet))
    return (1 + root) / (1 - root)
