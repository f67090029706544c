"""Photon transfer: gain and read noise from the variance of a picture's flat blocks.

Electrons are Poisson distributed, so the variance of values grows with their mean by the gain g (DN
per electron). Read noise adds r^2, rounding 1/12, and PRNU p^2 times the squared mean:
V(s) = r^2 + 1/12 + g s + p^2 s^2, s above black (Janesick 2007, Photon Transfer, ch. 5).
In a single picture r includes the offsets of the photosites (DSNU).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .blocks import HIGH_COUNT, Blocks

FloatArray = NDArray[np.float64]
#: Least number of flat blocks for a fit.
LEAST = 64
_BINS, _FINE_BINS, _FIRST_SHARE, _ROUNDS = 24, 96, 0.1, 6
#: Width of a bin, standard deviations of a photosite; a block's mean has 1/8 of that deviation.
_BIN_WIDTH = 2.0
#: Largest mean squares of flat blocks over their variance: 1 % of the means over low frequencies
#: are larger, and 0.01 % of the means over high frequencies (chi-square of 9 and 16).
_FLAT, _OUTLIER = 2.41, 2.90
#: Largest slope of gradients, over the variance; edges have larger slopes.
_STEEP = 1000.0
#: Least distance of a block's mean from the ends of the range, standard deviations.
_CLEAR = 5.0
ROUNDING = 1 / 12  # DN^2
#: Largest relative difference of the channels' gains.
_ONE_GAIN = 0.5
#: Error of the gain over the excess of the blocks' mean squares; excess due to chance: a share plus
#: a number over sqrt(blocks), for their spread and for the mean of low frequencies.
_OFF, _CHANCE, _BY_COUNT = 0.4, 0.05, (5.0, 1.5)
#: Error of the gain by texture above which there is no result.
_TOO_MIXED = 0.3
#: Largest PRNU of a sensor; texture looks like more.
MOST_PRNU = 0.05


@dataclass(frozen=True)
class Transfer:
    """A photon transfer curve.

    Attributes:
        gain: Gain, DN per electron.
        gain_error: Relative standard error of the gain; larger if flat blocks include texture.
        read_noise: Noise in the dark, DSNU included, e-.
        read_noise_error: Relative standard error of the read noise; infinite if nothing is dark.
        prnu: Relative standard deviation of the photosites' responses.
        blocks: Number of flat blocks.
        darkest: Mean of the darkest blocks, e-.
        by_channel: Gain of each channel, DN per electron; NaN: too few blocks.
    """

    gain: float
    gain_error: float
    read_noise: float
    read_noise_error: float
    prnu: float
    blocks: int
    darkest: float
    by_channel: tuple[float, ...]


def transfer_of(blocks: Blocks, span: tuple[float, float], channels: int, where: str) -> Transfer:
    """Fits a photon transfer curve.

    Args:
        blocks: Blocks of one picture, or of several with the same settings.
        span: Least and largest value above black, DN.
        channels: Number of channels.
        where: Name of the picture, for messages.

    Raises:
        InputError: Too few blocks are flat, or they do not determine the gain, for example because
            all have one brightness.
    """
    flat, line = _flat(blocks, span, where)
    fitted = _fit(flat.level, flat.high, line)
    a, g, q = fitted.values
    error = fitted.errors
    if q > MOST_PRNU**2:
        raise InputError(
            f"{where}: noise: wanted flat parts, got only texture (its variance would mean a PRNU "
            f"of {np.sqrt(q):.0%}); add a photograph of an even surface with --flat FILE"
        )
    if not (g > 0 and error[1] < 0.5 * g):
        raise InputError(
            f"{where}: noise: wanted flat parts of different brightness, got {len(flat.level)} "
            "flat blocks whose noise does not grow with light; is this an unprocessed raw file?"
        )
    by_channel = tuple(_gain_of(flat, c, line) for c in range(channels))
    if any(abs(gain - g) > _ONE_GAIN * g for gain in by_channel):
        raise InputError(
            f"{where}: noise: wanted flat parts of different brightness, got {len(flat.level)} "
            "flat blocks that give each colour a different gain; add a photograph of an even "
            "surface with --flat FILE"
        )
    mixed = _texture_among(flat, line)
    if mixed > _TOO_MIXED:
        raise InputError(
            f"{where}: noise: wanted flat parts, got nearly flat texture, which makes the gain "
            f"uncertain by {mixed:.0%}; add a photograph of an even surface with --flat FILE"
        )
    dark = a - ROUNDING
    read = float(np.sqrt(max(dark, 0.0))) / g
    spread = error[0] / (2 * dark) if dark > 0 else np.inf
    return Transfer(
        gain=float(g),
        gain_error=float(np.hypot(error[1] / g, mixed)),
        read_noise=read,
        read_noise_error=float(np.hypot(spread, np.hypot(error[1] / g, mixed))),
        prnu=float(np.sqrt(q)),
        blocks=len(flat.level),
        darkest=float(np.quantile(flat.level, 0.01) / g),
        by_channel=by_channel,
    )


@dataclass(frozen=True)
class _Line:
    """Coefficients of 1, s and s^2, with their standard errors."""

    values: tuple[float, float, float]
    errors: tuple[float, float, float]

    def __call__(self, level: FloatArray) -> FloatArray:
        a, g, q = self.values
        return np.asarray(np.maximum(a + g * level + q * level**2, 1e-6))


def _flat(blocks: Blocks, span: tuple[float, float], where: str) -> tuple[Blocks, _Line]:
    """Finds flat blocks and the variance by level that selects them, alternating."""
    if len(blocks.level) < LEAST:
        raise InputError(
            f"{where}: noise: wanted at least {LEAST} blocks that are not clipped, got "
            f"{len(blocks.level)}"
        )
    level, variance = _first_guess(blocks)
    line = _fit(level, variance, None)
    chosen = blocks
    for _ in range(_ROUNDS):
        expected = line(blocks.level)
        clear = _CLEAR * np.sqrt(expected)
        good = (blocks.low < _FLAT * expected) & (blocks.high < _OUTLIER * expected)
        good &= blocks.slope < _STEEP * expected
        good &= (blocks.level - clear > span[0]) & (blocks.level + clear < span[1])
        chosen = blocks.only(good)
        if len(chosen.level) < LEAST:
            raise InputError(
                f"{where}: noise: wanted at least {LEAST} flat blocks, got {len(chosen.level)} of "
                f"{len(blocks.level)}; add a photograph of an even surface with --flat FILE"
            )
        line = _fit(chosen.level, chosen.high, line)
    return chosen, line


def _first_guess(blocks: Blocks) -> tuple[FloatArray, FloatArray]:
    """Levels, and the variance of the blocks with least structure in each bin of levels."""
    order = np.argsort(blocks.level)
    found = []
    for part in np.array_split(order, min(_BINS, len(order) // 8)):
        count = max(int(_FIRST_SHARE * len(part)), 4)
        flattest = part[np.argsort(blocks.low[part])[:count]]
        found.append((blocks.level[flattest].mean(), blocks.high[flattest].mean()))
    level, variance = np.array(found).T
    return level, variance


def _fit(level: FloatArray, variance: FloatArray, last: _Line | None) -> _Line:
    """Fits bins of levels by least squares, weighted by the variance of a variance.

    Negative coefficients of s^2, then of 1, are set to 0.
    """
    number = np.arange(len(level)) if last is None else _bins(level, last)
    count = np.bincount(number)
    s = np.bincount(number, level)[count > 0] / count[count > 0]
    v = np.bincount(number, variance)[count > 0] / count[count > 0]
    expected = _smooth(s, v) if last is None else last(s)
    weight = np.sqrt(count[count > 0]) / expected
    columns = np.stack([np.ones_like(s), s, s**2], axis=1) * weight[:, None]
    kept = [0, 1, 2]
    while True:
        inverse = _inverse(columns[:, kept])
        found = inverse @ (columns[:, kept].T @ (v * weight))
        low = [k for k, value in zip(kept, found, strict=True) if value < 0 and k != 1]
        if not low:
            break
        kept.remove(max(low))
    values, errors = np.zeros(3), np.zeros(3)
    values[kept] = found
    known = sorted({0, 1, *kept})  # setting the first to 0 does not reduce its error
    sure = _inverse(columns[:, known])
    errors[known] = np.sqrt(np.maximum(np.diag(sure), 0) * 2 / HIGH_COUNT)
    return _Line((values[0], values[1], values[2]), (errors[0], errors[1], errors[2]))


def _bins(level: FloatArray, line: _Line) -> NDArray[np.intp]:
    """Index of each block's bin, from the darkest on; bins are wider than the noise of a mean.

    Weights by a block's level would prefer blocks with a mean that noise has lowered, and so raise
    the line there.
    """
    a, g, _ = line.values
    if not g > 0:
        return np.zeros(len(level), np.intp)
    steps = 2 / g * np.sqrt(np.maximum(a + g * (level - level.min()), 0))  # standard deviations
    steps -= steps.min()
    width = max(_BIN_WIDTH, float(steps.max()) / _FINE_BINS)
    return np.asarray(steps / width, np.intp)


def _smooth(level: FloatArray, variance: FloatArray) -> FloatArray:
    """Linear trend of variances, for the weights of the first fit."""
    trend = np.polyval(np.polyfit(level, variance, 1), level)
    return np.asarray(np.maximum(trend, 0.1 * variance.mean()))


def _inverse(columns: FloatArray) -> FloatArray:
    """Inverse of the normal matrix of columns that differ widely in size."""
    scale = np.linalg.norm(columns, axis=0)
    scale[scale == 0] = 1
    unit = columns / scale
    return np.asarray(np.linalg.pinv(unit.T @ unit) / np.outer(scale, scale))


def _texture_among(flat: Blocks, line: _Line) -> float:
    """Relative error of the gain by texture among the flat blocks; 0: no texture.

    In noise, the spread of the mean squares is known, and low frequencies have as much power as
    high frequencies; texture makes both larger.
    """
    expected = line(flat.level)
    spread = float(np.square(flat.high / expected - 1).mean() * HIGH_COUNT / 2)
    low = float((flat.low / expected).mean())
    chance = [1 + _CHANCE + share / np.sqrt(len(flat.level)) for share in _BY_COUNT]
    found = [value - 1 for value, most in zip((spread, low), chance, strict=True) if value > most]
    return _OFF * max(found, default=0.0)


def _gain_of(flat: Blocks, channel: int, line: _Line) -> float:
    """Gain of one channel, with the other terms from the common fit."""
    chosen = flat.only(flat.channel == channel)
    if len(chosen.level) < LEAST:
        return float("nan")
    a, _, q = line.values
    weight = 1 / line(chosen.level) ** 2
    rest = chosen.high - a - q * chosen.level**2
    return float((weight * rest * chosen.level).sum() / (weight * chosen.level**2).sum())
