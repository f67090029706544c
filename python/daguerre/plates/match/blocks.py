"""Blocks of equal photosites, selected by low frequencies and measured by high frequencies.

White noise has the same variance in every coefficient of a discrete cosine transform, independent
of each other, while pictures have little power in the high coefficients. So the low coefficients
select flat blocks, and the high coefficients measure the noise, without bias from the selection
(Ponomarenko et al. 2007, An automatic approach to lossy compression of AVIRIS images; Colom and
Buades 2013, Analysis and extension of the Ponomarenko et al. method, IPOL 3).
Coefficients along only one axis are left out: light that is a function of the row plus a function
of the column has only those.

Where photosites of one colour are far apart (X-Trans, Quad-Bayer), texture between them would look
like noise. There, squares of four adjacent photosites are used; see ``squares``.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import BriefRecord

FloatArray = NDArray[np.float64]
#: Number of coefficients that measure noise.
HIGH_COUNT = 16


@dataclass(frozen=True, repr=False)
class Blocks(BriefRecord):
    """Blocks of photosites of one channel each.

    Attributes:
        level: Mean, DN above black, shape (N,).
        low: Mean square of the low coefficients, DN^2, shape (N,).
        high: Mean square of the high coefficients, DN^2; the noise variance in flat blocks.
        slope: Sum of the squares of the first coefficient along each axis, DN^2.
        channel: Index of the channel, shape (N,).
    """

    level: FloatArray
    low: FloatArray
    high: FloatArray
    slope: FloatArray
    channel: NDArray[np.intp]

    def only(self, chosen: NDArray[np.bool_]) -> Blocks:
        """Selects blocks by a mask."""
        return Blocks(*(getattr(self, part.name)[chosen] for part in fields(self)))


def joined(parts: list[Blocks]) -> Blocks:
    """Joins blocks of several pictures."""
    names = [part.name for part in fields(Blocks)]
    return Blocks(*(np.concatenate([getattr(one, name) for one in parts]) for name in names))


def inside(blocks: NDArray[np.uint16], white: int) -> NDArray[np.bool_]:
    """Mask, shape (N,), of blocks, shape (N, ...), without values at either end of the range."""
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
