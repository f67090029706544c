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

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import RawNumbers

FloatArray = NDArray[np.float64]
#: Side of a block, in photosites of one place in the mosaic's cell.
SIDE = 8
_LOW, _HIGH = slice(1, 4), slice(4, 8)
#: Coefficients of a block that judge it, and those that measure it.
LOW_COUNT, HIGH_COUNT = 9, 16
#: Blocks that are looked at in one picture; more tell nothing new.
MOST = 400_000


@dataclass(frozen=True)
class Blocks:
    """Blocks of photosites of one channel each.

    Attributes:
        level: Mean, DN above black, shape (N,).
        low: Mean square of the low coefficients, DN^2, shape (N,).
        high: Mean square of the high ones, DN^2: of a flat block the variance of its noise.
        channel: Index of the channel, shape (N,).
    """

    level: FloatArray
    low: FloatArray
    high: FloatArray
    channel: NDArray[np.intp]

    def only(self, chosen: NDArray[np.bool_]) -> Blocks:
        """Those of a mask."""
        return Blocks(self.level[chosen], self.low[chosen], self.high[chosen], self.channel[chosen])


def blocks_of(raw: RawNumbers, share: float = 1.0) -> Blocks:
    """Blocks all over a mosaic; those with a photosite at either end of the numbers are left out.

    Args:
        raw: The mosaic.
        share: Share of ``MOST`` that may come of it.
    """
    if max(raw.cells.shape) > 2:
        from .squares import blocks_of_squares

        return blocks_of_squares(raw, int(MOST * share))
    rows, columns = raw.cells.shape
    height, width = raw.mosaic.shape
    count = (height // (SIDE * rows)) * (width // (SIDE * columns)) * rows * columns
    every = max(math.ceil(count / (MOST * share)), 1)
    return joined([_of_plane(raw, y, x, every) for y in range(rows) for x in range(columns)])


def joined(parts: list[Blocks]) -> Blocks:
    """Blocks of several pictures as one."""
    return Blocks(
        np.concatenate([part.level for part in parts]),
        np.concatenate([part.low for part in parts]),
        np.concatenate([part.high for part in parts]),
        np.concatenate([part.channel for part in parts]),
    )


def _of_plane(raw: RawNumbers, y: int, x: int, every: int) -> Blocks:
    """Blocks of the photosites of one place in the cell: every so many rows of blocks."""
    rows, columns = raw.cells.shape
    plane = raw.mosaic[y::rows, x::columns]
    channel = int(raw.cells[y, x])
    count = plane.shape[1] // SIDE
    starts = range((y + x) % every * SIDE, len(plane) - SIDE + 1, every * SIDE)
    bands = [plane[at : at + SIDE, : count * SIDE] for at in starts]
    stack = np.stack(bands) if bands else np.zeros((0, SIDE, count * SIDE), np.uint16)
    blocks = stack.reshape(len(stack), SIDE, count, SIDE).swapaxes(1, 2).reshape(-1, SIDE, SIDE)
    blocks = blocks[inside(blocks, raw.white)]
    return _transformed(blocks.astype(np.float32) - np.float32(raw.black[channel]), channel)


def inside(blocks: NDArray[np.uint16], white: int) -> NDArray[np.bool_]:
    """Which blocks, shape (N, ...), hold no number of either end, shape (N,)."""
    if not len(blocks):
        return np.zeros(0, np.bool_)
    flat = blocks.reshape(len(blocks), -1)
    return np.asarray((flat.max(axis=1) < white) & (flat.min(axis=1) > 0))


def _transformed(blocks: NDArray[np.float32], channel: int) -> Blocks:
    basis = cosines(SIDE)
    low = np.einsum("ki,nij,lj->nkl", basis[_LOW], blocks, basis[_LOW], optimize=True)
    high = np.einsum("ki,nij,lj->nkl", basis[_HIGH], blocks, basis[_HIGH], optimize=True)
    return Blocks(
        blocks.mean(axis=(1, 2), dtype=np.float64),
        np.square(low, dtype=np.float64).mean(axis=(1, 2)),
        np.square(high, dtype=np.float64).mean(axis=(1, 2)),
        np.full(len(blocks), channel),
    )


def cosines(side: int) -> NDArray[np.float32]:
    """Rows of the orthonormal discrete cosine transform, type 2, shape (side, side)."""
    k, i = np.indices((side, side))
    rows = np.cos(np.pi * (i + 0.5) * k / side) * np.sqrt(2 / side)
    rows[0] /= np.sqrt(2)
    return np.asarray(rows, np.float32)
