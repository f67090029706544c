"""Cuts blocks of photosites at one position of the mosaic's cell, for Bayer and mono mosaics."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import RawNumbers

from .blocks import Blocks, cosines, inside, joined

#: Side of a block, in photosites at one position of the cell.
SIDE = 8
_LOW, _HIGH = slice(1, 4), slice(4, 8)


def blocks_of_planes(raw: RawNumbers, most: int) -> Blocks:
    """Cuts about ``most`` blocks from all over a mosaic."""
    rows, columns = raw.cells.shape
    height, width = raw.mosaic.shape
    count = (height // (SIDE * rows)) * (width // (SIDE * columns)) * rows * columns
    every = max(math.ceil(count / most), 1)
    return joined([_of_plane(raw, y, x, every) for y in range(rows) for x in range(columns)])


def _of_plane(raw: RawNumbers, y: int, x: int, every: int) -> Blocks:
    """Blocks of photosites at (y, x) of the cell, from each ``every``-th row of blocks."""
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


def _transformed(blocks: NDArray[np.float32], channel: int) -> Blocks:
    basis = cosines(SIDE)
    low = np.einsum("ki,nij,lj->nkl", basis[_LOW], blocks, basis[_LOW], optimize=True)
    high = np.einsum("ki,nij,lj->nkl", basis[_HIGH], blocks, basis[_HIGH], optimize=True)
    first = [blocks.sum(axis=axis) @ basis[1] / np.sqrt(np.float32(SIDE)) for axis in (1, 2)]
    return Blocks(
        blocks.mean(axis=(1, 2), dtype=np.float64),
        np.square(low, dtype=np.float64).mean(axis=(1, 2)),
        np.square(high, dtype=np.float64).mean(axis=(1, 2)),
        np.square(first, dtype=np.float64).sum(axis=0),
        np.full(len(blocks), channel),
    )
