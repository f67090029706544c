"""Diffraction on pixels: the point spread of waves, with the discs, rings and stars of an iris.

Light that converges on a film point is a fan of plane waves with direction cosines a. At d from the
point the amplitude is the Fourier sum of P(a) exp(i k (W(a) + a d)), with P^2 the light along a and
W its optical path (wavefronts.py). The squared amplitude is integrated over each pixel.
Sources: Born and Wolf, Principles of Optics, 7th ed., sections 8.3 to 8.5; Goodman, Introduction to
Fourier Optics, 3rd ed., chapters 4 and 5.

Patterns have d in wavelengths. Without aberrations the pattern is the same at all wavelengths, so
one transform serves them all, and only the size of a pixel in it differs. By Parseval's theorem the
sum of the squares is the light of the pupil. So a kernel's sum is the share of the light within its
window, for every shape of the iris.

Axes are the picture's: x to the right, y up, for the iris too, as seen along the view.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from functools import cache
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre._core import pixel_integrals
from daguerre.argument_checks import guarded
from daguerre.checks import line, number, whole
from daguerre.convolution.fft import fast_sizes, fft, rfft, thread_count
from daguerre.errors import UsageError

from .iris import Floats, Iris

#: Period of the transform over the width of the kernel; light beyond the period wraps around.
PAD = 1.5
SAMPLES = 3.0  # samples across the finest fringe, wavelength / span; at least 2 are needed
LINES = 128  # lines transformed at a time
PUPIL = 512  # least number of points across a pupil
MOST_FRINGES = 3000.0  # largest width of a pattern, in fringes; beyond it is dark
TAPS = 6  # samples on each side of a pixel's edge that are interpolated
REACH = 700.0  # half width of a kernel, in fringes at 550 nm: wavelength x f-number


class Pupil(Protocol):
    """Light that converges on one film point."""

    @property
    def low(self) -> tuple[float, float]:
        """Smallest direction cosines along x and y."""

    @property
    def high(self) -> tuple[float, float]:
        """Largest direction cosines along x and y."""

    @property
    def perfect(self) -> bool:
        """Whether there are no aberrations: amplitudes are real, and equal at all wavelengths."""

    def amplitude(self, x: Floats, y: Floats, wavelength_nm: float) -> NDArray[Any]:
        """Amplitudes (B, A) on a raster of cosines x (A,) and y (B,); complex if not perfect."""


def _line(values: Floats, name: str) -> Floats:
    """Checks direction cosines in a row; two or more, as their distance is the pitch."""
    found = line(values, f"amplitude: {name}")
    if len(found) < 2:
        raise UsageError(f"amplitude: {name}: wanted two or more directions, got {len(found)}")
    return np.asarray(found, np.float32)


@guarded
@dataclass(frozen=True)
class PlainPupil:
    """The pupil of an ideal lens: only an iris that fills the cone of its f-number.

    Attributes:
        f_number: Working f-number N at the film; the sine of the cone's half angle is 1 / (2 N).
        iris: Shape of the iris.
    """

    f_number: float
    iris: Iris = field(default_factory=Iris)

    @property
    def high(self) -> tuple[float, float]:
        """Largest direction cosines along x and y."""
        outer = self.iris.outer_radius / (2 * self.f_number)
        return outer, outer

    @property
    def low(self) -> tuple[float, float]:
        """Smallest direction cosines along x and y."""
        return -self.high[0], -self.high[1]

    @property
    def perfect(self) -> bool:
        """Whether there are no aberrations: always, for an ideal lens."""
        return True

    def amplitude(self, x: Floats, y: Floats, wavelength_nm: float) -> Floats:
        """Amplitudes (B, A) on a raster of cosines x (A,) and y (B,); real."""
        x, y = _line(x, "x"), _line(y, "y")
        unit = np.float32(2 * self.f_number)
        pitch = float(unit * (x[1] - x[0]))
        return self.iris.amplitude(x[None, :] * unit, y[:, None] * unit, pitch)


class _Weights(NamedTuple):
    """Weights of samples in the integrals over N pixels along an axis.

    Attributes:
        first: First sample of each integral, shape (N,).
        values: Weights from that sample on, shape (N, K).
    """

    first: NDArray[np.int32]
    values: Floats


@dataclass(frozen=True)
class Pattern:
    """Samples of the light around a film point, with distances in wavelengths.

    Attributes:
        light: Samples, columns along x, rows from the top. A perfect wave has the same light at
            (x, y) and (-x, -y), and only samples from x = -TAPS on: shape (2 reach + 1, reach + 1 +
            TAPS).
        spacing: Distance of samples, wavelengths.
        total: Sum of the samples of a whole period: the total power.
    """

    light: Floats
    spacing: float
    total: float

    @property
    def halved(self) -> bool:
        """Whether ``light`` has only the right half."""
        return bool(self.light.shape[0] != self.light.shape[1])

    def on_pixels(self, wavelength_nm: float, pitch_mm: float, size: int) -> Floats:
        """Shares of the light in pixels, rows from the top, shape (size, size); size is odd.

        A perfect wave gives only the right half, from the middle column on: (size, size // 2 + 1).
        """
        pixel = pitch_mm / (1e-6 * wavelength_nm * self.spacing)
        reach = len(self.light) // 2
        edges = (np.arange(size + 1, dtype=np.float64) - 0.5 * size) * pixel
        down = _weights(edges + reach, self.total)
        if not self.halved:
            return self._integrals(down, _weights(edges + reach, 1.0))
        # The middle column is its own right half, plus that half turned about the point.
        right = np.concatenate([[0.0], edges[size // 2 + 1 :]]) + TAPS
        half = self._integrals(down, _weights(right, 1.0))
        half[:, 0] += half[::-1, 0]
        return half

    def _integrals(self, down: _Weights, across: _Weights) -> Floats:
        found = pixel_integrals(self.light, down.first, down.values, across.first, across.values)
        return np.asarray(found)


def both_halves(right: Floats) -> Floats:
    """Completes right halves of perfect waves to kernels, shape (..., size, size)."""
    return np.concatenate([right[..., ::-1, :0:-1], right], axis=-1)


def light_of(right: Floats) -> float:
    """Sum of a whole kernel, from its right half."""
    return float(2 * right.sum(dtype=np.float64) - right[:, 0].sum(dtype=np.float64))


def pattern_of(
    pupil: Pupil, wavelength_nm: float, pitch_mm: float, size: int, *, threads: int = 1
) -> Pattern | None:
    """Computes the pattern of a pupil, for a window at this wavelength and at longer wavelengths.

    Args:
        pupil: Pupil of one film point.
        wavelength_nm: Wavelength, nm. For a perfect wave it only sets the width.
        pitch_mm: Pixel pitch, mm.
        size: Pixels across.
        threads: Number of threads; the result does not depend on it.

    Returns:
        The pattern, or None if the pupil is dark.
    """
    number(wavelength_nm, "diffraction: wavelength_nm", 1, 1e6)
    number(pitch_mm, "diffraction: pitch_mm", above=0, high=1000)
    whole(size, "diffraction: size", 1, 1 << 14)
    spans = [b - a for a, b in zip(pupil.low, pupil.high, strict=True)]
    pixel = pitch_mm / (1e-6 * wavelength_nm)
    window = min(size * pixel, MOST_FRINGES / max(spans))
    step, length = _raster(max(spans), window, pixel)
    axes = []
    for low, high in zip(pupil.low, pupil.high, strict=True):
        count = math.ceil((high - low) / step) + 3
        middle = 0.5 * (low + high)
        axes.append(((np.arange(count) - 0.5 * (count - 1)) * step + middle).astype(np.float32))
    spacing = 1 / (length * step)
    reach = min(math.ceil(0.5 * window / spacing) + TAPS + 1, (length - 1) // 2)
    blocks = [axes[1][k : k + LINES] for k in range(0, len(axes[1]), LINES)]
    with ThreadPoolExecutor(threads) as pool:
        made = pool.map(lambda y: pupil.amplitude(axes[0], y, wavelength_nm), blocks)
        lines, light = zip(*pool.map(lambda w: _along(w, length, reach), made), strict=True)
        total = math.fsum(light)
        return Pattern(_intensity(lines, length, reach, pool), spacing, total) if total else None


@guarded
def far_field(pupil: Pupil, wavelength_nm: float, pitch_mm: float, size: int) -> Floats:
    """Computes the point spread of one wavelength on pixels.

    Args:
        pupil: Pupil of one film point.
        wavelength_nm: Wavelength, nm.
        pitch_mm: Pixel pitch, mm.
        size: Pixels across, odd: the point is in the middle pixel.

    Returns:
        Share of the light in each pixel, rows from the top, shape (size, size).
    """
    found = next(far_fields(pupil, [wavelength_nm], pitch_mm, size, threads=1))
    return both_halves(found) if pupil.perfect else found


def far_fields(
    pupil: Pupil,
    wavelengths_nm: Sequence[float],
    pitch_mm: float,
    size: int,
    *,
    threads: int = 0,
) -> Iterator[Floats]:
    """Yields the ``far_field`` of each wavelength, computed on several threads (0: all cores).

    Perfect waves give only right halves; see ``Pattern.on_pixels``.
    """
    if size % 2 == 0:
        raise ValueError(f"size: wanted an odd number, got {size}")
    if size == 1:
        yield from (np.ones((1, 1), np.float32) for _ in wavelengths_nm)  # half is all
        return
    count = thread_count(threads)
    shared = None
    if pupil.perfect:
        shared = pattern_of(pupil, min(wavelengths_nm), pitch_mm, size, threads=count)

    def one(nm: float) -> Floats:
        pattern = shared if pupil.perfect else pattern_of(pupil, nm, pitch_mm, size)
        dark = np.zeros((size, size // 2 + 1 if pupil.perfect else size), np.float32)
        return dark if pattern is None else pattern.on_pixels(nm, pitch_mm, size)

    with ThreadPoolExecutor(count) as pool:
        for first in range(0, len(wavelengths_nm), count):
            yield from pool.map(one, wavelengths_nm[first : first + count])


def window_of(pupil: Pupil, pitch_mm: float, most: int) -> int:
    """Pixels across a kernel that misses about 1e-4 of the light, odd; about ``most`` or less."""
    span = max(b - a for a, b in zip(pupil.low, pupil.high, strict=True))
    reach = int(REACH * 0.55e-3 / (span * pitch_mm))
    return min(2 * reach + 1, (most - 1) | 1)


def _raster(span: float, window: float, pixel: float) -> tuple[float, int]:
    """Step of the direction cosines, and length of the transform; window and pixel in wavelengths.

    Samples are no coarser than pixels, because interpolation between samples is less exact.
    """
    across = max(PAD * window * span, PUPIL)  # samples of the pupil
    least = across * max(SAMPLES, 1 / (span * pixel)) + 8
    length = next(n for n in fast_sizes(1 << 17) if n >= least)
    return span / across, length


def _along(waves: NDArray[Any], length: int, reach: int) -> tuple[NDArray[Any], float]:
    """Transforms rows, orthonormal; returns also their light. Real waves: columns 0 .. reach."""
    light = float((np.abs(waves).astype(np.float64) ** 2).sum())
    if not np.iscomplexobj(waves):
        return rfft(waves, length)[:, : reach + 1].copy(), light
    # exp(+i k a d) has the opposite sign of the transform, so columns are reversed.
    along = fft(waves, length, 1)
    return np.concatenate([along[:, reach::-1], along[:, : -reach - 1 : -1]], axis=1), light


def _intensity(
    lines: Sequence[NDArray[Any]], length: int, reach: int, pool: ThreadPoolExecutor
) -> Floats:
    """|Fourier sum|^2 at samples -reach .. reach of x (columns) and of y (rows, from the top).

    Real waves have only ``reach + 1`` columns; the result is then the half that ``Pattern`` keeps.
    """
    halved = lines[0].shape[1] == reach + 1
    out = np.empty((2 * reach + 1, lines[0].shape[1] + TAPS * halved), np.float32)
    made = out[:, TAPS * halved :]

    def columns(first: int) -> None:
        part = slice(first, first + LINES)
        both = fft(np.concatenate([block[:, part] for block in lines]), length, 0)
        light = both.real**2 + both.imag**2
        if halved:  # exp(-i) along rows gives (-x, y), which equals (x, -y)
            light[1:] = light[:0:-1].copy()
        # Row 0 is y = +reach: by exp(+i), it is at -reach of the transform.
        made[:reach, part] = light[-reach:]
        made[reach:, part] = light[: reach + 1]

    list(pool.map(columns, range(0, made.shape[1], LINES)))
    if halved:
        out[:, :TAPS] = made[::-1, TAPS:0:-1]
    return out


def _weights(edges: NDArray[np.float64], total: float) -> _Weights:
    """Weights of samples in the integrals between edges (counted in samples), over a total.

    A windowed sinc interpolates between samples; at three samples per fringe it misses about 1e-3
    of the finest fringes. Over all pixels the weights of a sample sum to 1, wherever their edges
    are: no light is lost or added.
    """
    low, high = edges[:-1], edges[1:]
    first = np.floor(low).astype(np.int32) - TAPS + 1
    taps = int(np.ceil((high - low).max())) + 2 * TAPS
    at = first[:, None] + np.arange(taps)
    weights = (_risen(high[:, None] - at) - _risen(low[:, None] - at)) / total
    return _Weights(first, np.ascontiguousarray(weights, np.float32))


def _risen(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Integral of the interpolating kernel up to x, in samples: 0 at -TAPS, 1 at TAPS."""
    at, table = _kernel_table()
    return np.interp(x, at, table)


@cache
def _kernel_table() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    fine = 512
    at = (np.arange(2 * TAPS * fine + 1)) / fine - TAPS
    middle = 0.5 * (at[1:] + at[:-1])
    # Kaiser's window, 65 dB: his formulas for a passband of 1/3 and a stopband from 2/3 on.
    window = np.i0(6.2 * np.sqrt(np.maximum(0, 1 - (middle / TAPS) ** 2))) / np.i0(6.2)
    risen = np.concatenate([[0], np.cumsum(np.sinc(middle) * window)])
    return at, risen / risen[-1]
