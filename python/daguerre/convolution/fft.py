"""Fourier transforms of large pictures in float32, on several threads.

NumPy's own transforms (pocketfft) keep float32 and let other threads run since NumPy 2. All are
orthonormal, with a factor of 1 / sqrt(n) each way: with a factor of 1, NumPy computes in double,
which takes three times as long (seen in 2.4). NumPy 1.26 computes in double always and cannot write
into a given array; the result is then rounded.
"""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float32]
Complex = NDArray[np.complex64]
LINES = 64  # rows of a spectrum multiplied at a time, so that they stay in the cache
_WRITES = "out" in inspect.signature(np.fft.fft).parameters  # NumPy 2


def fft(values: NDArray[Any], count: int, axis: int, out: Complex | None = None) -> Complex:
    """Transforms values along an axis, zero-padded to ``count``; orthonormal."""
    return _transformed(np.fft.fft, values, count, axis, out)


def rfft(values: Real, count: int, out: Complex | None = None) -> Complex:
    """Transforms real rows, zero-padded to ``count``; returns the first half of the spectrum."""
    return _transformed(np.fft.rfft, values, count, 1, out)


def _transformed(
    transform: Any, values: NDArray[Any], count: int, axis: int, out: NDArray[Any] | None
) -> NDArray[Any]:
    """Calls one of NumPy's transforms, orthonormal; the result is ``out`` if that is given."""
    if _WRITES:
        return np.asarray(transform(values, count, axis=axis, norm="ortho", out=out))
    made = transform(values, count, axis=axis, norm="ortho")
    if out is None:
        return np.asarray(made, np.result_type(values, np.complex64))
    out[...] = made
    return out


def thread_count(threads: int) -> int:
    """Returns the number of threads; for 0, the number of cores that this process may use."""
    return threads or len(os.sched_getaffinity(0))


def in_parallel(threads: int, count: int, work: Callable[[slice], Any]) -> None:
    """Runs ``work`` on slices that cover range(count), a slice for each thread."""
    edges = np.linspace(0, count, threads + 1).astype(int)
    parts = [slice(int(a), int(b)) for a, b in pairwise(edges) if b > a]
    if len(parts) < 2:
        for part in parts:
            work(part)
        return
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, parts))


@cache
def fast_sizes(most: int) -> tuple[int, ...]:
    """Returns lengths up to ``most`` without prime factors above 5, which transform fast."""
    sizes = {1}
    for prime in (2, 3, 5):
        for size in sorted(sizes):
            while (size := size * prime) <= most:
                sizes.add(size)
    return tuple(sorted(sizes))


class Fft2:
    """Two-dimensional transforms of one size; smaller arrays are zero-padded.

    Args:
        shape: Rows and columns of the transform, which is periodic.
        threads: Number of threads.
    """

    def __init__(self, shape: tuple[int, int], threads: int) -> None:
        self.shape, self.threads = shape, threads
        self.spectrum_shape = (shape[0], shape[1] // 2 + 1)

    def forward(self, values: Real, made: Complex) -> Complex:
        """Writes the spectrum of values (h, w), zero-padded to ``shape``, into ``made``."""
        columns = self.shape[1]
        made[len(values) :] = 0

        def along_rows(part: slice) -> None:
            rfft(values[part], columns, made[: len(values)][part])

        in_parallel(self.threads, len(values), along_rows)
        self._along_columns(made)
        return made

    def _along_columns(self, made: Complex) -> None:
        def along(part: slice) -> None:
            fft(made[:, part], self.shape[0], 0, made[:, part])

        in_parallel(self.threads, self.spectrum_shape[1], along)

    def of_kernel(self, kernel: Real) -> Complex | Real:
        """Returns the factor on spectra that convolves by a kernel centred at (h // 2, w // 2).

        The factor is real if the kernel is point-symmetric: equal at (x, y) and (-x, -y).
        """
        rows, columns = self.shape
        spectrum = np.zeros(self.spectrum_shape, np.complex64)
        scaled = kernel * np.float32(math.sqrt(rows * columns))
        for at, piece in around(-(kernel.shape[0] // 2), kernel.shape[0], rows):
            lines = scaled[at : at + piece.stop - piece.start]
            rfft(wrapped(lines, columns), columns, spectrum[piece])
        self._along_columns(spectrum)
        even = kernel.shape[0] % 2 == kernel.shape[1] % 2 == 1
        if even and np.allclose(kernel, kernel[::-1, ::-1], rtol=1e-5, atol=0):
            return np.ascontiguousarray(spectrum.real)
        return spectrum

    def add_product(
        self, total: Complex, spectrum: Complex, kernel: Complex | Real, *, new: bool
    ) -> None:
        """Adds ``spectrum * kernel`` to ``total``; overwrites ``total`` if ``new``."""

        def lines(part: slice) -> None:
            for first in range(part.start, part.stop, LINES):
                some = slice(first, min(first + LINES, part.stop))
                if new:
                    np.multiply(spectrum[some], kernel[some], out=total[some])
                else:
                    total[some] += spectrum[some] * kernel[some]

        in_parallel(self.threads, self.shape[0], lines)

    def inverse(self, spectrum: Complex, rows: slice, space: Real) -> Real:
        """Inverts a spectrum, which is overwritten; returns rows, with indices that wrap around.

        The result is a view of ``space``, which has the transform's shape.
        """
        count = rows.stop - rows.start
        out = space[:count]

        def along_columns(part: slice) -> None:
            some = spectrum[:, part]
            _transformed(np.fft.ifft, some, self.shape[0], 0, some)

        in_parallel(self.threads, self.spectrum_shape[1], along_columns)
        for at, piece in around(rows.start, count, self.shape[0]):
            self._inverse_rows(spectrum[piece], out[at : at + piece.stop - piece.start])
        return out

    def _inverse_rows(self, spectrum: Complex, out: Real) -> None:
        def along_rows(part: slice) -> None:
            _transformed(np.fft.irfft, spectrum[part], self.shape[1], 1, out[part])

        in_parallel(self.threads, len(out), along_rows)


def around(start: int, count: int, period: int) -> list[tuple[int, slice]]:
    """Cuts a range of a periodic axis: start of each piece in the range, its slice of the axis."""
    pieces, at = [], 0
    while at < count:
        first = (start + at) % period
        length = min(count - at, period - first)
        pieces.append((at, slice(first, first + length)))
        at += length
    return pieces


def wrapped(lines: Real, period: int) -> Real:
    """Returns lines on a periodic axis, zero-padded, with their centres at 0."""
    count = lines.shape[1]
    out = np.zeros((len(lines), period), np.float32)
    for at, piece in around(-(count // 2), count, period):
        out[:, piece] = lines[:, at : at + piece.stop - piece.start]
    return out
