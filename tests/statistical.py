"""Tests of equality for noisy pictures: Welch's t per pixel, per 8x8 block and on the mean.

Each picture brings its own variance of the mean; the family-wise error rate is held by Sidak's correction
(1 - (1 - p)^n). Source: Welch 1947, Biometrika 34; the procedure follows Mitsuba 3's render tests.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

import daguerre as dg

ALPHA = 0.01
BLOCK = 8


def batch_means(
    scene: dg.Scene, camera: dg.Camera, batches: int, spp: int, **options: object
) -> NDArray[np.float64]:
    """Independent renders of different seeds, shape (batches, H, W, 3)."""
    first = int(options.pop("seed", 1000))  # type: ignore[call-overload]
    return np.array(
        [dg.render(scene, camera, spp=spp, seed=first + i, **options).rgb for i in range(batches)],
        np.float64,
    )


def welch_p(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Two-sided p-values along axis 0; values that agree exactly have p = 1."""
    va, vb = a.var(axis=0, ddof=1) / len(a), b.var(axis=0, ddof=1) / len(b)
    difference = a.mean(axis=0) - b.mean(axis=0)
    scale = np.maximum(np.abs(a).mean(axis=0), 1e-12)
    spread = np.maximum(va + vb, (1e-6 * scale) ** 2)
    dof = spread**2 / np.maximum(
        va**2 / (len(a) - 1) + vb**2 / (len(b) - 1), 1e-300
    )
    dof = np.clip(dof, 1, 1e6)
    return np.vectorize(student_t_p)(difference / np.sqrt(spread), dof)


def student_t_p(t: float, dof: float) -> float:
    """Two-sided p-value of Student's t by the continued fraction of the incomplete beta function.

    Source: Press et al., Numerical Recipes, section 6.4.
    """
    x = dof / (dof + t * t)
    return _incomplete_beta(dof / 2, 0.5, x)


def _incomplete_beta(a: float, b: float, x: float) -> float:
    if x <= 0 or x >= 1:
        return float(x >= 1)
    front = math.exp(
        math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x)
    )
    if x > (a + 1) / (a + b + 2):
        return 1 - front * _beta_fraction(b, a, 1 - x) / b
    return front * _beta_fraction(a, b, x) / a


def _beta_fraction(a: float, b: float, x: float) -> float:
    tiny = 1e-300
    c, d = 1.0, 1 / max(1 - (a + b) * x / (a + 1), tiny)
    h = d
    for m in range(1, 1000):
        even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
        for step in (even, odd):
            d = 1 + step * d
            d = 1 / (d if abs(d) > tiny else tiny)
            c = 1 + step / c
            c = c if abs(c) > tiny else tiny
            h *= d * c
        if abs(d * c - 1) < 1e-12:
            break
    return h


def _blocks(pictures: NDArray[np.float64]) -> NDArray[np.float64]:
    n, height, width, channels = pictures.shape
    h, w = height // BLOCK * BLOCK, width // BLOCK * BLOCK
    cut = pictures[:, :h, :w].reshape(n, h // BLOCK, BLOCK, w // BLOCK, BLOCK, channels)
    return cut.mean(axis=(2, 4))


def differences(a: NDArray[np.float64], b: NDArray[np.float64]) -> list[str]:
    """What is wrong if the two batches (n, H, W, 3) have different means; empty: nothing."""
    out = []
    for name, x, y in (
        ("pixel", a, b),
        ("block", _blocks(a), _blocks(b)),
        ("mean", a.mean(axis=(1, 2)), b.mean(axis=(1, 2))),
    ):
        p = welch_p(x, y)
        if not p.size:
            continue
        limit = 1 - (1 - ALPHA) ** (1 / p.size)
        failed = p < limit
        # 99.75 % of the pixels must pass; no block and no channel of the mean may fail.
        if failed.mean() > (0.0025 if name == "pixel" else 0):
            out.append(
                f"{name}: {failed.sum()} of {p.size} differ, smallest p {p.min():.2e} (limit {limit:.2e})"
            )
    return out
