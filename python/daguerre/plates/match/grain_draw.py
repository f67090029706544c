"""Draws the noise of developed pictures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre._core import grain_pattern
from daguerre.convolution.convolve import convolve

from .grain import SIDE, Grain, whole_spectrum

Floats = NDArray[np.float32]
#: Pixels to each side over which a field is spread.
REACH = SIDE // 2 - 1
#: Grains so small that each lies on one pixel: white noise.
_WHITE = 0.05


def with_grain(pixels: Floats, grain: Grain, seed: int, corner: tuple[int, int] = (0, 0)) -> Floats:
    """A clean picture with a plate's noise.

    A pixel's noise depends on its place, its level and the seed, so crops have that of the whole.

    Args:
        pixels: Red, green and blue in the numbers that the noise was measured in, shape (H, W, 3).
        grain: The noise.
        seed: Seed of the noise.
        corner: Place of the first pixel in the picture, x and y.

    Returns:
        float32, shape (H, W, 3); numbers for screens are not cut off at 0 and 1.
    """
    noise = _noise(grain, (pixels.shape[0], pixels.shape[1]), seed, corner)
    for c in range(3):
        noise[:, :, c] *= grain.deviation(c, pixels[:, :, c])
    noise += pixels
    return noise


def _noise(grain: Grain, shape: tuple[int, int], seed: int, corner: tuple[int, int]) -> Floats:
    """Normal numbers of variance 1 with the spectra of the noise, shape (H, W, 3)."""
    (height, width), (x, y) = shape, corner
    place = (x - REACH, y - REACH, width + 2 * REACH, height + 2 * REACH)
    white = np.stack([grain_pattern(*place, _WHITE, seed, k) for k in range(3)], axis=2)
    made = convolve(white, kernels(grain))
    return np.ascontiguousarray(made[REACH:-REACH, REACH:-REACH])


def kernels(grain: Grain) -> Floats:
    """Kernels that give white noise the spectra: real, even, shape (31, 31, 3, 3).

    The root of the matrix of each frequency, so that what comes out has that matrix.
    """
    shares, axes = np.linalg.eigh(whole_spectrum(grain.spectra))
    root = np.einsum("yxik,yxk,yxjk->yxij", axes, np.sqrt(np.maximum(shares, 0)), axes)
    spread = np.roll(np.fft.ifft2(root, axes=(0, 1)).real, (SIDE // 2, SIDE // 2), (0, 1))[1:, 1:]
    own = np.sqrt(np.square(spread).sum(axis=(0, 1, 3)))
    return np.asarray(spread / np.maximum(own, 1e-9)[:, None], np.float32)
