"""Adaptive sampling: draws a picture in rounds that add samples where they are needed.

The error of a frame is relative: sqrt(mean(variance / (value^2 + 0.01))) over pixels and channels,
with the variance that the film estimates. To reach it at least cost, pixel p needs n(p) samples in
proportion to sqrt(V(p)), V the relative variance of one sample. A round decides from the sums of
complete rounds alone, so neither threads nor interruptions change a bit.

If the sample count of a pixel depends on its own values, its mean is biased: a pixel that missed
its bright paths by chance looks clean and stays so. So pixels have three colours in a cycle, and V
of a pixel comes from neighbours of the next colour alone: the values of a pixel affect its own
count after three rounds at the earliest, and faintly.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import daguerre._core as _core
from daguerre.checks import number, whole

#: Samples of every pixel before the first decision, and step of all counts: aligned powers of two
#: keep the sampler's points stratified.
START = 16
STEP = 8
#: A round at most doubles the samples, as it relies on estimated variances, and adds at least this
#: share, so that there are few last rounds.
GROWTH = 1.06, 2.0
#: Each pixel gets at least this share of the mean: it may not have met its brightest light yet.
FLOOR = 1 / 3
#: Largest distance of neighbours, px; their variances are weighted by 1 / distance^2. (Standard
#: deviations would scatter less, but grow with the samples of a pixel that has rare light: a spiky
#: picture came out 0.6 % too dark, and 3 % where rounds began at 8 samples.)
REACH = 7
MAX_SPP = 16384
#: Added to the square of a value, so that values below 0.1 need less relative accuracy.
DARK = 0.01
PARTS: int = _core.ROUND_PARTS

Counts = NDArray[np.uint32]
Plane = NDArray[np.float32]


@dataclass(frozen=True)
class Round:
    """A round: samples to draw, a different number for each pixel.

    Attributes:
        begin: First sample index of each pixel, shape (H, W).
        count: Number of samples of each pixel, shape (H, W).
        drawn: Number of parts of the round, of ``PARTS``, that are drawn.
        noise: Relative error of the frame before this round.
        expected: Estimated mean samples per pixel for the target noise.
    """

    begin: Counts
    count: Counts
    drawn: int = 0
    noise: float = 1.0
    expected: float = 0.0

    @property
    def complete(self) -> bool:
        """Whether the whole round is drawn."""
        return self.drawn >= PARTS

    def samples(self) -> float:
        """Mean samples per pixel drawn so far."""
        return float(self.begin.mean() + self.count.mean() * self.drawn / PARTS)


def check_noise(noise: object, spp: object, where: str = "noise") -> tuple[float, int]:
    """Checks the target relative error and the maximum samples per pixel.

    Raises:
        UsageError: A value is out of range.
    """
    ceiling = MAX_SPP if spp is None else whole(spp, "spp", 2, 1 << 31, "2 .. 2^31")
    return number(noise, where, high=1.0, above=0.0), ceiling


def noise_of(variance: Plane, counts: Counts) -> float:
    """Relative error of a frame, from the relative variance of one sample of each pixel."""
    return float(np.sqrt(mean_over(variance, counts)))


def next_counts(
    variance: Plane, counts: Counts, factor: float, ceiling: int
) -> tuple[Counts, float]:
    """Samples of each pixel in the next round, and the estimated mean in the end.

    Args:
        variance: Relative variance of one sample, (H, W).
        counts: Samples drawn, (H, W).
        factor: Target relative variance of the frame over the present relative variance.
        ceiling: Maximum samples of a pixel.
    """
    # A subset of the pixels suffices to find the number, and is faster.
    subset = slice(None, None, (variance.size >> 16) | 1)
    drawn, variances = counts.ravel()[subset].astype(np.float32), variance.ravel()[subset]
    spread = around(variance)
    np.sqrt(spread, out=spread)
    need, wanted = spread.ravel()[subset], factor * mean_over(variances, drawn)

    def reaches(scale: float) -> bool:
        return mean_over(variances, share(need, drawn, scale, ceiling)) <= wanted

    def grows(by: float) -> Callable[[float], bool]:
        return lambda s: bool(share(need, drawn, s, ceiling).mean() >= by * drawn.mean())

    enough = first_scale(reaches)
    least, most = (first_scale(grows(by)) for by in GROWTH)
    expected = share(need, drawn, enough, ceiling).mean()
    more = share(spread, counts, min(max(enough, least), most), ceiling)
    more -= counts
    more /= STEP
    more += dither(counts.shape)
    np.floor(more, out=more)
    more *= STEP
    room = np.maximum(counts, np.uint32(ceiling)) - counts  # 0 if another ceiling was higher
    return np.clip(more, 0, room, out=more).astype(np.uint32), float(expected)


def mean_over(values: Plane, counts: Counts | Plane) -> float:
    """Mean of values / counts."""
    return float(np.divide(values, counts, dtype=np.float32).mean(dtype=np.float64))


def share(need: Plane, have: Counts | Plane, scale: float, ceiling: int) -> Plane:
    """Counts in proportion to need, at least the present ones and the floor."""
    wanted = need * np.float32(scale)
    np.clip(wanted, have, ceiling, out=wanted, casting="same_kind")
    floor = FLOOR * float(wanted.mean(dtype=np.float64))
    return np.clip(wanted, min(floor, ceiling), ceiling, out=wanted)


def dither(shape: tuple[int, ...]) -> Plane:
    """Dither values in [0, 1), even in every neighbourhood: added before flooring, they keep means.

    Source: Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences (R2).
    """
    y = np.arange(shape[0])[:, None] * 0.5698402909980532 % 1.0
    x = np.arange(shape[1])[None] * 0.7548776662466927 % 1.0
    both = y.astype(np.float32) + x.astype(np.float32)
    return np.mod(both, np.float32(1), out=both)


def first_scale(holds: Callable[[float], bool]) -> float:
    """Smallest scale, to 1 part in 1000, from which on a condition holds."""
    low, high = 1e-6, 1e12
    if not holds(high):
        return high
    while high > 1.001 * low:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if holds(middle) else (middle, high)
    return high


def around(variance: Plane) -> Plane:
    """Estimates each pixel's variance from its neighbours; see ``REACH``."""
    return np.asarray(_core.mean_of_next_colour(variance, REACH))
