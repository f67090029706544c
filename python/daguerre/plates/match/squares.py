"""Cuts blocks of squares of four adjacent photosites of one colour, for X-Trans and Quad-Bayer.

The difference a - b - c + d of a square measures the noise over two photosites, where pictures
have least detail; the mean is independent of it. Means of 4 x 4 squares select flat blocks.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import RawNumbers

from .blocks import Blocks, cosines, inside, joined

#: Squares along a side of a block: 16 differences and 9 low coefficients, as in other blocks.
SIDE = 4


def blocks_of_squares(raw: RawNumbers, most: int) -> Blocks:
    """Cuts about ``most`` blocks from all over a mosaic."""
    places = list(_places(raw.cells))
    (rows, columns), (height, width) = raw.cells.shape, raw.mosaic.shape
    count = (height // (SIDE * rows)) * (width // (SIDE * columns)) * len(places)
    every = max(-(-count // most), 1)
    return joined([_of_place(raw, y, x, every) for y, x in places])


def _places(cells: NDArray[np.uint8]) -> Iterator[tuple[int, int]]:
    """Yields upper left photosites of squares of one colour within the cell."""
    rows, columns = cells.shape
    for y in range(rows - 1):
        for x in range(columns - 1):
            if len(np.unique(cells[y : y + 2, x : x + 2])) == 1:
                yield y, x


def _of_place(raw: RawNumbers, y: int, x: int, every: int) -> Blocks:
    (rows, columns), channel = raw.cells.shape, int(raw.cells[y, x])
    height = (raw.mosaic.shape[0] - y) // rows // SIDE
    width = (raw.mosaic.shape[1] - x) // columns // SIDE
    corners = np.stack(
        [
            raw.mosaic[y + i :: rows, x + j :: columns][: height * SIDE, : width * SIDE]
            for i in (0, 1)
            for j in (0, 1)
        ],
        axis=2,
    )
    blocks = corners.reshape(height, SIDE, width, SIDE, 4).swapaxes(1, 2)
    blocks = blocks[(y + x) % every :: every].reshape(-1, SIDE, SIDE, 4)
    light = blocks[inside(blocks, raw.white)].astype(np.float32) - np.float32(raw.black[channel])
    a, b, c, d = np.moveaxis(light, 3, 0)
    basis, means = cosines(SIDE)[1:], light.mean(axis=3)
    low = np.einsum("ki,nij,lj->nkl", basis, means, basis, optimize=True)
    first = [means.sum(axis=axis) @ basis[0] / np.sqrt(np.float32(SIDE)) for axis in (1, 2)]
    return Blocks(
        light.mean(axis=(1, 2, 3), dtype=np.float64),
        4 * np.square(low, dtype=np.float64).mean(axis=(1, 2)),
        np.square((a - b - c + d) / 2, dtype=np.float64).mean(axis=(1, 2)),
        4 * np.square(first, dtype=np.float64).sum(axis=0),
        np.full(len(light), channel),
    )
