"""Noise of developed pictures: how large it is by level, and how it looks.

Demosaicing, noise reduction, curves and compression leave noise that no law of photons describes.
The model is the noise's own: at each place normal numbers, whose standard deviations are functions
of the channels' levels alone, and whose spectra, of each channel and between them (light and
colours have grain of different size), are the same at every level.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
#: Side of the blocks that spectra are taken of, px; frequencies are multiples of 1 / SIDE.
SIDE = 32
HALF = SIDE // 2 + 1
#: Frequencies of an FFT without their signs.
FOLDED = np.minimum(np.arange(SIDE), SIDE - np.arange(SIDE))


@dataclass(frozen=True, eq=False)
class Grain:
    """Noise of a developed picture.

    Attributes:
        linear: Whether levels are linear light; else numbers encoded for screens, 0 to 1.
        levels: Levels of each channel, rising, shape (3, L).
        deviations: Standard deviation of the noise there, in the same numbers, shape (3, L).
        spectra: Cross power of the channels' noise, each of variance 1, at frequencies of 0 to 1/2
            along y and x, shape (17, 17, 3, 3): symmetric; the mean of a channel's own is 1.
    """

    linear: bool
    levels: FloatArray
    deviations: FloatArray
    spectra: FloatArray

    def deviation(self, channel: int, level: NDArray[np.float32]) -> NDArray[np.float32]:
        """Standard deviation of a channel's noise at its levels, linear between those known.

        Beyond them it stays; of linear light it grows with the root, as that of photons.
        """
        at, known = self.levels[channel], self.deviations[channel]
        found = np.interp(level, at, known).astype(np.float32)
        if self.linear and at[-1] > 0:
            found *= np.sqrt(np.maximum(level / np.float32(at[-1]), 1)).astype(np.float32)
        return np.asarray(found, np.float32)

    @property
    def size(self) -> float:
        """Size of the grain of green, px: 1 where pixels know nothing of each other.

        Square root of the sum of the autocorrelation: of a picture of even squares, their side.
        """
        return float(np.sqrt(self.spectra[:3, :3, 1, 1].mean()))


def whole_spectrum(quadrant: FloatArray) -> FloatArray:
    """Power at all frequencies in the order of FFT, (SIDE, SIDE, ...), of (HALF, HALF, ...)."""
    return np.asarray(quadrant[np.ix_(FOLDED, FOLDED)])
