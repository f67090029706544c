"""Blocks of equal photosites, judged by low frequencies and measured by high ones.

White noise has the same variance in every coefficient of a discrete cosine transform, independent
of each other, while pictures have little in the high ones. So low coefficients tell which blocks
are flat, and high ones, which had no say in that, how large the noise is: a choice by them does not
bias it (Ponomarenko et al. 2007, An automatic approach to lossy compression of AVIRIS images; Colom
and Buades 2013, Analysis and extension of the Ponomarenko et al. method, IPOL 3). Coefficients
along one axis alone are left out: light that changes along rows plus columns has only those.

Where photosites of one colour stand far apart (X-Trans, Quad-Bayer), texture between them would
look like noise. There squares of four that touch are taken, see ``squares``.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
#: Coefficients of a block that judge it, and those that measure it.
LOW_COUNT, HIGH_COUNT = 9, 16


@dataclass(frozen=True)
class Blocks:
    """Blocks of photosites of one channel each.

    Attributes:
        level: Mean, DN above black, shape (N,).
        low: Mean square of the low coefficients, DN^2, shape (N,).
        high: Mean square of the high ones, DN^2: of a flat block the variance of its noise.
        slope: Sum of the squares of the first coefficient along either axis, DN^2.
        channel: Index of the channel, shape (N,).
    """

    level: FloatArray
    low: FloatArray
    high: FloatArray
    slope: FloatArray
    channel: NDArray[np.intp]

    def only(self, chosen: NDArray[np.bool_]) -> Blocks:
        """Those of a mask."""
        return Blocks(*(getattr(self, part.name)[chosen] for part in fields(self)))


def joined(parts: list[Blocks]) -> Blocks:
    """Blocks of several pictures as one."""
    names = [part.name for part in fields(Blocks)]
    return Blocks(*(np.concatenate([getattr(one, name) for one in parts]) for name in names))


def inside(blocks: NDArray[np.uint16], white: int) -> NDArray[np.bool_]:
    """Which blocks, shape (N, ...), hold no number of either end, shape (N,)."""
    if not len(blocks):
        return np.zeros(0, np.bool_)
    flat = blocks.reshape(len(blocks), -1)
    return np.asarray((flat.max(axis=1) < white) & (flat.min(axis=1) > 0))


def cosines(side: int) -> NDArray[np.float32]:
    """Rows of the orthonormal discrete cosine transform, type 2, shape (side, side)."""
    k, i = np.indices((side, side))
    rows = np.cos(np.pi * (i + 0.5) * k / side) * np.sqrt(2 / side)
    rows[0] /= np.sqrt(2)
    return np.asarray(rows, np.float32)
