"""Fourier transforms of large pictures in float32, on several threads.

NumPy's own transforms (pocketfft): since NumPy 2 they keep float32 and let other threads run.
SciPy's are up to 2 times as fast, for a package of 140 MB that nothing else here needs.
"""

from __future__ import annotations

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
_fft: Any = np.fft  # its types know of no float32


def thread_count(threads: int) -> int:
    """Threads to use; 0: one for each core that this process may use."""
    return threads or len(os.sched_getaffinity(0))


def in_parallel(threads: int, count: int, work: Callable[[slice], Any]) -> None:
    """Runs work on slices that cover range(count), one for each thread."""
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
    """Lengths up to most without prime factors above 5: quick to transform."""
    sizes = {1}
    for prime in (2, 3, 5):
        for size in sorted(sizes):
            while (size := size * prime) <= most:
                sizes.add(size)
    return tuple(sorted(sizes))


class Fft2:
    """Transforms of one size, of arrays that are zero beyond their own.

    Args:
        shape: Rows and columns that the transform takes as periodic.
        threads: To work on.
    """

    def __init__(self, shape: tuple[int, int], threads: int) -> None:
        self.shape, self.threads = shape, threads
        self.spectrum_shape = (shape[0], shape[1] // 2 + 1)

    def forward(self, values: Real) -> Complex:
        """Spectrum of values (h, w) with h, w at most ``shape``, padded with zeros."""
        rows, columns = self.shape
        out = np.zeros(self.spectrum_shape, np.complex64)

        def along_rows(part: slice) -> None:
            _fft.rfft(values[part], columns, axis=1, out=out[: len(values)][part])

        def along_columns(part: slice) -> None:
            _fft.fft(out[:, part], rows, axis=0, out=out[:, part])

        in_parallel(self.threads, len(values), along_rows)
        in_parallel(self.threads, self.spectrum_shape[1], along_columns)
        return out

    def inverse(self, spectrum: Complex, size: tuple[int, int]) -> Real:
        """The first rows and columns (h, w) of what has this spectrum, which is overwritten."""
        rows, columns = self.shape
        out = np.empty((size[0], columns), np.float32)

        def along_columns(part: slice) -> None:
            _fft.ifft(spectrum[:, part], rows, axis=0, out=spectrum[:, part])

        def along_rows(part: slice) -> None:
            _fft.irfft(spectrum[: size[0]][part], columns, axis=1, out=out[part])

        in_parallel(self.threads, self.spectrum_shape[1], along_columns)
        in_parallel(self.threads, size[0], along_rows)
        return out[:, : size[1]]
