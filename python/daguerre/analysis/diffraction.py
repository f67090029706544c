"""The point spread of waves on a picture's pixels: discs, rings and stars of an iris.

Light that converges on a film point is a fan of plane waves with direction cosines a; at d from the
point the amplitude is the Fourier sum of P(a) exp(i k (W(a) + a d)), P^2 the light along a, W its
path (wavefronts.py). The square is integrated over each pixel.
Sources: Born and Wolf, Principles of Optics, 7th ed., sections 8.3 to 8.5; Goodman, Introduction to
Fourier Optics, 3rd ed., chapters 4 and 5.

A pupil raster whose step is in proportion to the wavelength puts all wavelengths on one film
raster. By Parseval's theorem the sum of the squares is the light of the pupil, so a kernel's sum is
the share of the light that falls into its window, whatever the shape of the iris.

Axes are the picture's: x to the right, y up, both of the iris as seen along the view.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from daguerre.fft import fast_sizes, thread_count

from .iris import Floats, Iris

#: the window that the transform takes as periodic, over the kernel: what leaves it comes in again
PAD = 1.5
MOST_POINTS = 4608  # across a window
COLUMNS = 256  # transformed at a time
PUPIL = 512  # points across a pupil at least
REACH = 700.0  # of a kernel, in fringes of 550 nm: wavelength x f-number


class Pupil(Protocol):
    """What converges on one film point."""

    @property
    def low(self) -> tuple[float, float]:
        """Smallest direction cosines along x and y."""

    @property
    def high(self) -> tuple[float, float]:
        """Largest direction cosines along x and y."""

    def amplitude(self, x: Floats, y: Floats, wavelength_nm: float) -> NDArray[Any]:
        """Amplitudes (B, A) on a raster of cosines x (A,) and y (B,); complex if they bend."""


@dataclass(frozen=True)
class PlainPupil:
    """The pupil of an ideal lens: the iris alone, under the cone of its f-number.

    Attributes:
        f_number: As the film sees it (working f-number); sin of the cone's half angle is 1 / (2 N).
        iris: Its shape.
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

    def amplitude(self, x: Floats, y: Floats, wavelength_nm: float) -> Floats:
        """Amplitudes (B, A): no aberration, so they are real."""
        unit = np.float32(2 * self.f_number)
        pitch = float(unit * (x[1] - x[0]))
        return self.iris.amplitude(x[None, :] * unit, y[:, None] * unit, pitch)


def far_field(
    pupil: Pupil, wavelength_nm: float, pitch_mm: float, size: int, *, oversample: int | None = None
) -> Floats:
    """The point spread of one wavelength on pixels.

    Args:
        pupil: Of one film point.
        wavelength_nm: nm.
        pitch_mm: Of the pixels, mm.
        size: Pixels across, odd: the point is in the middle one.
        oversample: Points across a pixel, even; None: enough for the finest fringes.

    Returns:
        Share of the light in each pixel, rows from the top, shape (size, size).
    """
    if size % 2 == 0:
        raise ValueError(f"size: wanted an odd number, got {size}")
    if size == 1:
        return np.ones((1, 1), np.float32)
    spans = [b - a for a, b in zip(pupil.low, pupil.high, strict=True)]
    points = oversample or oversampling(max(spans), wavelength_nm, pitch_mm, size)
    reach = points * size // 2
    step, length = _raster(max(spans), wavelength_nm, pitch_mm / points, 2 * reach + 1)
    axes = []
    for low, high in zip(pupil.low, pupil.high, strict=True):
        count = math.ceil((high - low) / step) + 3
        middle = 0.5 * (low + high)
        axes.append(((np.arange(count) - 0.5 * (count - 1)) * step + middle).astype(np.float32))
    waves = pupil.amplitude(axes[0], axes[1], wavelength_nm)
    total = float((np.abs(waves).astype(np.float64) ** 2).sum()) * float(length) ** 2
    if total == 0:
        return np.zeros((size, size), np.float32)
    fine = _intensity(waves, length, reach)
    fine *= np.float32(1 / total)
    return _binned(_binned(fine, points).T, points).T


def window_of(pupil: Pupil, pitch_mm: float, most: int) -> int:
    """Pixels across a kernel beyond which some 1e-4 of the light falls, odd; at most so many."""
    span = max(b - a for a, b in zip(pupil.low, pupil.high, strict=True))
    reach = int(REACH * 0.55e-3 / (span * pitch_mm))
    return min(2 * reach + 1, (most - 1) | 1)


def oversampling(span: float, wavelength_nm: float, pitch_mm: float, size: int) -> int:
    """Points across a pixel, even: two for each of the finest fringes, lambda / span apart."""
    wanted = 2 * math.ceil(1e6 * pitch_mm * span / wavelength_nm)
    return max(2, min(wanted, MOST_POINTS // size // 2 * 2))


def _raster(span: float, nm: float, spacing_mm: float, window: int) -> tuple[float, int]:
    """Step of the direction cosines, and length of the transform, for points so far apart."""
    # All of the pupil must fit, or waves of its edges would fall on others; and have some shape.
    across = 1e6 * span * spacing_mm / nm
    least = max(PAD * window, 1.02 * across + 4, PUPIL / across)
    length = next(n for n in fast_sizes(1 << 17) if n >= least)
    return 1e-6 * nm / (length * spacing_mm), length


def _intensity(waves: NDArray[Any], length: int, reach: int) -> Floats:
    """|Fourier sum|^2 at points -reach .. reach of x (columns) and of y (rows, from the top)."""
    bent = np.iscomplexobj(waves)
    if bent:
        # exp(+i k a d): the transform's sign is the other one, so points count backward.
        along = np.fft.fft(waves, length, axis=1)
        along = np.concatenate([along[:, reach::-1], along[:, : -reach - 1 : -1]], axis=1)
    else:
        along = np.fft.rfft(waves, length, axis=1)[:, : reach + 1]
    out = np.empty((2 * reach + 1, along.shape[1]), np.float32)
    for first in range(0, along.shape[1], COLUMNS):
        part = slice(first, first + COLUMNS)
        both = np.fft.fft(along[:, part], length, axis=0)
        light = both.real**2 + both.imag**2
        # y up is row 0: of exp(+i), so y = +reach stands at the transform's -reach.
        out[:reach, part] = light[-reach:] if reach else 0
        out[reach:, part] = light[: reach + 1]
    if bent:
        return out
    # A real pupil has a symmetric spread: (x, y) as (-x, -y).
    mirrored = out[::-1, :0:-1]
    return np.concatenate([mirrored, out], axis=1)[::-1]


def _binned(fine: Floats, points: int) -> Floats:
    """Integrals over rows of pixels; points lie on their edges.

    Weights alternate as in Simpson's rule, but with 4 / pi in the place of 4 / 3: exact for waves
    of four points, and closer where there are two. The sum over all pixels is that of all
    points: the spectrum of the light ends at lambda / span, so every second point has half of it.
    """
    edges = fine[::points]
    odd, even = (fine[k:-1:2].reshape(-1, points // 2, fine.shape[1]).sum(axis=1) for k in (1, 0))
    rest = 2 - 4 / math.pi
    rows = 4 / math.pi * odd + rest * even + 0.5 * rest * (edges[1:] - edges[:-1])
    return np.asarray(rows, np.float32)


def far_fields(
    pupil: Pupil,
    wavelengths_nm: Sequence[float],
    pitch_mm: float,
    size: int,
    *,
    threads: int = 0,
) -> Iterator[Floats]:
    """``far_field`` of one wavelength after the other, as many at a time as there are threads."""
    count = thread_count(threads)
    with ThreadPoolExecutor(count) as pool:
        for first in range(0, len(wavelengths_nm), count):
            group = wavelengths_nm[first : first + count]
            yield from pool.map(lambda nm: far_field(pupil, nm, pitch_mm, size), group)
