"""Tests of equality for noisy pictures: Welch's t per pixel, per 8x8 block and on the mean.

Each picture brings its own variance of the mean; the family-wise error rate is held by
Sidak's correction (1 - (1 - p)^n). Source: Welch 1947, Biometrika 34; the procedure follows
Mitsuba 3's render tests.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import daguerre as dg

ALPHA = 0.01
BLOCK = 8
OFTEN = 25  # times that a pixel has met what is bright, to know how much it varies


def batch_means(
    scene: dg.Scene, camera: dg.Camera, batches: int, spp: int, **options: object
) -> NDArray[np.float64]:
    """Independent renders of different seeds, shape (batches, H, W, 3)."""
    first = int(options.pop("seed", 1000))  # type: ignore[call-overload]
    return np.array(
        [dg.render(scene, camera, spp=spp, seed=first + i, **options).rgb for i in range(batches)],
        np.float64,
    )


@dataclass(frozen=True)
class Reference:
    """A picture (H, W, C) as mean and variance of the mean, from so many independent batches.

    ``samples`` per pixel tell how much one sample varies; 0: unknown.
    """

    mean: NDArray[np.float64]
    variance: NDArray[np.float64]
    batches: int
    samples: int = 0


@dataclass(frozen=True)
class Rare:
    """Independent batches (n, H, W, C) of which some pixels have met a bright path seldom or never.

    Such pixels do not know their own spread: ``floor`` (H, W, C) is the least variance of the mean.
    Pixels have independent errors as far as it goes.
    """

    batches: NDArray[np.float64]
    floor: NDArray[np.float64]

    def moments(self) -> Reference:
        own = _moments(self.batches)
        return Reference(own.mean, np.maximum(own.variance, self.floor), own.batches)


Values = NDArray[np.float64] | Reference | Rare


def seldom_met(
    batches: NDArray[np.float64], found: NDArray[np.float64], brightest: float, samples: int
) -> Rare:
    """Pictures whose pixels know how rarely they meet a lamp.

    At the edge of a disc no ray may have met it yet, and there is no spread. A value of mean m that
    is never above b has a variance of m b at most, which it has where b is met or nothing. Where a
    lamp was met often, its spread is known.

    Args:
        batches: Independent pictures, (n, H, W, 3).
        found: Light that lamps bring, by other means, (H, W, 3).
        brightest: b.
        samples: Samples of each pixel, in all batches.
    """
    one = brightest / samples
    return Rare(batches, np.where(found < OFTEN * one, np.maximum(found, 0) * one, 0))


def _moments(values: Values) -> Reference:
    if isinstance(values, Reference):
        return values
    if isinstance(values, Rare):
        return values.moments()
    return Reference(values.mean(axis=0), values.var(axis=0, ddof=1) / len(values), len(values))


def welch_p(a: Values, b: Values) -> NDArray[np.float64]:
    """Two-sided p-values along axis 0 of batches; values that agree exactly have p = 1."""
    a, b = _moments(a), _moments(b)
    scale = np.maximum(np.abs(a.mean), 1e-12)
    spread = np.maximum(a.variance + b.variance, (1e-6 * scale) ** 2)
    dof = spread**2 / np.maximum(
        a.variance**2 / (a.batches - 1) + b.variance**2 / (b.batches - 1), 1e-300
    )
    dof = np.clip(dof, 1, 1e6)
    difference = a.mean - b.mean
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


def _tiles(picture: NDArray[np.float64]) -> NDArray[np.float64]:
    """The whole 8x8 blocks of (..., H, W, C) as (..., h, w, 64, C)."""
    *rest, height, width, channels = picture.shape
    h, w = height // BLOCK, width // BLOCK
    cut = picture[..., : h * BLOCK, : w * BLOCK, :]
    cut = cut.reshape(*rest, h, BLOCK, w, BLOCK, channels)
    return np.moveaxis(cut, -4, -3).reshape(*rest, h, w, BLOCK * BLOCK, channels)


def _blocks(values: Values) -> Values:
    """Means over 8x8 blocks; a reference's pixels have independent errors."""
    if isinstance(values, Reference):
        mean, variance = _tiles(values.mean), _tiles(values.variance)
        return Reference(mean.mean(axis=-2), variance.sum(axis=-2) / BLOCK**4, values.batches)
    if isinstance(values, Rare):
        return Rare(
            _tiles(values.batches).mean(axis=-2), _tiles(values.floor).sum(axis=-2) / BLOCK**4
        )
    return np.asarray(_tiles(values).mean(axis=-2))


def _mean(values: Values) -> Values:
    """The mean over the picture."""
    if isinstance(values, Reference):
        height, width, _ = values.mean.shape
        variance = values.variance.sum(axis=(0, 1)) / (height * width) ** 2
        return Reference(values.mean.mean(axis=(0, 1)), variance, values.batches)
    if isinstance(values, Rare):
        height, width, _ = values.floor.shape
        floor = values.floor.sum(axis=(0, 1)) / (height * width) ** 2
        return Rare(values.batches.mean(axis=(1, 2)), floor)
    return np.asarray(values.mean(axis=(1, 2)))


def _expected_spread(a: NDArray[np.float64], b: Values, samples: int) -> Values:
    """A pixel that met a rare bright path by chance never, or once, knows too little of its spread.

    The reference, of many times more samples, knows it: the pixel's variance is at least what so
    many of the reference's samples have. Blocks and the mean are left as they are.
    """
    if not (isinstance(b, Reference) and b.samples and samples):
        return a
    own = _moments(a)
    floor = b.variance * (b.samples / samples)
    return Reference(own.mean, np.maximum(own.variance, floor), own.batches)


def differences(
    a: NDArray[np.float64], b: Values, samples: int = 0, alpha: float = ALPHA
) -> list[str]:
    """Says how pictures have different means; empty: they have the same.

    Args:
        a: Independent batches, (n, H, W, 3).
        b: The same, or a reference; its one channel stands for three.
        samples: Per pixel in all batches of ``a`` together, to hold against a reference's.
        alpha: Chance that equal pictures are called different, by each of the three tests.
    """
    out = []
    for name, x, y in (
        ("pixel", _expected_spread(a, b, samples), b),
        ("block", _blocks(a), _blocks(b)),
        ("mean", _mean(a), _mean(b)),
    ):
        p = welch_p(x, y)
        if not p.size:
            continue
        limit = 1 - (1 - alpha) ** (1 / p.size)
        failed = p < limit
        # 99.75 % of the pixels must pass; no block and no channel of the mean may fail.
        if failed.mean() > (0.0025 if name == "pixel" else 0):
            out.append(
                f"{name}: {failed.sum()} of {p.size} differ, smallest p {p.min():.2e} "
                f"(limit {limit:.2e})"
            )
    return out
