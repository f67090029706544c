"""Noise of developed pictures: its standard deviation by level, and its spectrum.

After demosaicing, noise reduction, curves and compression, noise no longer follows photon
statistics. It is modelled as normal. The standard deviation of each channel depends only on the
channel's level. Spectra and cross spectra of the channels are the same at every level; luminance
and colour differ in grain size.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import BriefRecord

FloatArray = NDArray[np.float64]
#: Side of the blocks for spectra, px; frequencies are multiples of 1 / SIDE.
SIDE = 32
HALF = SIDE // 2 + 1
#: Frequencies of an FFT without their signs.
FOLDED = np.minimum(np.arange(SIDE), SIDE - np.arange(SIDE))


@dataclass(frozen=True, eq=False, repr=False)
class Grain(BriefRecord):
    """Noise of a developed picture.

    Attributes:
        linear: Whether levels are linear light; else display-encoded values, 0 to 1.
        levels: Levels of each channel, ascending, shape (3, L).
        deviations: Standard deviation of the noise at these levels, same units, shape (3, L).
        spectra: Cross power of the channels' noise, scaled to variance 1, at frequencies of 0 to
            1/2 along y and x, shape (17, 17, 3, 3). Symmetric; the mean power of a channel is 1.
    """

    linear: bool
    levels: FloatArray
    deviations: FloatArray
    spectra: FloatArray

    def deviation(self, channel: int, level: NDArray[np.float32]) -> NDArray[np.float32]:
        """Returns the standard deviation of a channel's noise, linear between known levels.

        Beyond them it is constant; for linear light it grows with the square root, as shot noise.
        """
        at, known = self.levels[channel], self.deviations[channel]
        found = np.interp(level, at, known).astype(np.float32)
        if self.linear and at[-1] > 0:
            found *= np.sqrt(np.maximum(level / np.float32(at[-1]), 1)).astype(np.float32)
        return np.asarray(found, np.float32)

    @property
    def size(self) -> float:
        """Grain size of green, px; 1 if pixels are independent.

        It is the square root of the sum of the autocorrelation; for a picture of uniform squares
        that is their side.
        """
        return float(np.sqrt(self.spectra[:3, :3, 1, 1].mean()))


def whole_spectrum(quadrant: FloatArray) -> FloatArray:
    """Expands power (HALF, HALF, ...) to all frequencies in FFT order, (SIDE, SIDE, ...)."""
    return np.asarray(quadrant[np.ix_(FOLDED, FOLDED)])
