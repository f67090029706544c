"""A grid of slanted squares, blurred by a Gaussian: light of plates whose sharpness is known."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.special import erf

FloatArray = NDArray[np.float64]
_FINER, _SIDE = 3, 100.0


def squares(
    shape: tuple[int, int], sigma: float, *, contrast: float = 4.0, turn: float = 6.0
) -> FloatArray:
    """Light of pixels that are even squares, shape (H, W); its white is 1.

    Args:
        shape: Rows and columns.
        sigma: Standard deviation of the blur, px.
        contrast: White over black.
        turn: Slant of the edges, degrees.
    """
    height, width = shape
    y, x = (np.mgrid[: height * _FINER, : width * _FINER] + 0.5) / _FINER
    angle, side = np.radians(turn), _SIDE
    along = x * np.cos(angle) + y * np.sin(angle)
    across = -x * np.sin(angle) + y * np.cos(angle)

    def edges(t: FloatArray) -> FloatArray:
        distance = np.abs((t / side) % 2 - 1) * side - side / 2
        return np.asarray(0.5 * (1 + erf(distance / np.sqrt(2) / max(sigma, 1e-6))))

    fine = edges(along) * edges(across)
    share = fine.reshape(height, _FINER, width, _FINER).mean(axis=(1, 3))
    return np.asarray((1 + (contrast - 1) * share) / contrast)
