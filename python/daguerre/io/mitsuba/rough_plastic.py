"""Light that Mitsuba's ``roughplastic`` loses under its coat.

Mitsuba takes what facets block for light that goes through, but counts none of it inside. There the
coat reflects R of the base's light, which is less than the K that keeps all energy. Its base is
p / (1 - R), or p / (1 - p R) where it is nonlinear; ours has K in place of R. A darker base makes
up for it, exactly.

Source: Mitsuba 3, documentation of ``roughplastic``; Walter et al. 2007, Microfacet Models for
Refraction through Rough Surfaces, for the reflectance of facets.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.surfaces.facets import Distribution

Numbers = NDArray[np.float64]
#: Points of the midpoint rule: cosines, steepness of facets, half of their azimuths.
_COSINES, _SLOPES, _TURNS = 100, 64, 16


class Loss:
    """Darkening of the base below a rough coat.

    Args:
        ior: Index of refraction of the coat, at least 1.
        alpha: Roughness.
        distribution: Distribution of its facets.
        nonlinear: Whether the base is p / (1 - p R).
    """

    def __init__(
        self, ior: float, alpha: float, distribution: Distribution, nonlinear: bool
    ) -> None:
        self._nonlinear = nonlinear
        self._theirs = reflectance(1 / ior, alpha, distribution, correlated=False)
        self._ours = 1 - (1 - reflectance(ior, alpha, distribution, correlated=True)) / ior**2

    def base(self, shade: Numbers) -> Numbers:
        """Reflectance of our base that looks like theirs, (...) to (...)."""
        if self._nonlinear:
            return np.asarray(shade / (1 + shade * (self._ours - self._theirs)))
        return np.asarray(shade * (1 - self._ours) / (1 - self._theirs))


@cache
def reflectance(eta: float, alpha: float, distribution: Distribution, correlated: bool) -> float:
    """Share of diffuse light that the facets of an interface reflect.

    The integral of F D G (o.h) over half vectors, twice over the cosine of o, by the midpoint rule.

    Args:
        eta: Index beyond over the index here.
        alpha: Roughness.
        distribution: Distribution of the facets.
        correlated: Whether masking and shadowing go by the same heights; else they are independent.
    """
    cosine, share, turn = np.meshgrid(
        *((np.arange(n) + 0.5) / n for n in (_COSINES, _SLOPES, _TURNS)), indexing="ij"
    )
    square = share / (1 - share) if distribution == "ggx" else -np.log1p(-share)
    up = 1 / np.sqrt(1 + alpha**2 * square)
    across = np.sqrt(1 - up**2) * np.cos(np.pi * turn)
    seen = np.maximum(cosine * up + np.sqrt(1 - cosine**2) * across, 0)
    beyond = 2 * seen * up - cosine
    here, there = (_hidden(np.maximum(c, 1e-6), alpha, distribution) for c in (cosine, beyond))
    both = 1 + here + there if correlated else (1 + here) * (1 + there)
    light = np.where(beyond > 0, _fresnel(seen, eta) * seen / (up * both), 0)
    return float(2 * light.mean())


def _hidden(cosine: Numbers, alpha: float, distribution: Distribution) -> Numbers:
    """Smith's Lambda (Heitz 2014, Understanding the Masking-Shadowing Function, JCGT 3(2))."""
    slope = alpha * np.sqrt(np.maximum(1 - cosine**2, 0)) / cosine
    if distribution == "ggx":
        return np.asarray((np.sqrt(1 + slope**2) - 1) / 2)
    a = 1 / np.maximum(slope, 1e-6)
    # Walter et al. 2007, a rational function below 1.6.
    near = (1 - 1.259 * a + 0.396 * a**2) / (3.535 * a + 2.181 * a**2)
    return np.where(a < 1.6, near, 0)


def _fresnel(cosine: Numbers, eta: float) -> Numbers:
    """Fresnel's reflectance; 1 where all is reflected."""
    square = 1 - (1 - cosine**2) / eta**2
    root = np.sqrt(np.maximum(square, 0))
    s = (cosine - eta * root) / (cosine + eta * root + 1e-12)
    p = (eta * cosine - root) / (eta * cosine + root + 1e-12)
    return np.where(square > 0, (s**2 + p**2) / 2, 1)
