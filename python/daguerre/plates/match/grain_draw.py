"""Draws the noise of developed pictures."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre._core import grain_pattern
from daguerre.convolution.convolve import convolve

from .grain import SIDE, Grain, whole_spectrum

Floats = NDArray[np.float32]
#: Reach of the kernels to each side, px.
REACH = SIDE // 2 - 1
#: Grain size within one pixel, which gives white noise.
_WHITE = 0.05


def with_grain(pixels: Floats, grain: Grain, seed: int, corner: tuple[int, int] = (0, 0)) -> Floats:
    """Adds a plate's noise to a clean picture.

    A pixel's noise depends on its position, its level and the seed, so crops match the whole.

    Args:
        pixels: Red, green and blue in the units of the measured noise, shape (H, W, 3).
        grain: The noise.
        seed: Seed of the noise.
        corner: Position of the first pixel in the whole picture, x and y.

    Returns:
        float32, shape (H, W, 3); display-encoded values are not clipped to 0 .. 1.
    """
    noise = _noise(grain, (pixels.shape[0], pixels.shape[1]), seed, corner)
    for c in range(3):
        noise[:, :, c] *= grain.deviation(c, pixels[:, :, c])
    noise += pixels
    return noise


def _noise(grain: Grain, shape: tuple[int, int], seed: int, corner: tuple[int, int]) -> Floats:
    """Normal noise of variance 1 with the given spectra, shape (H, W, 3)."""
    (height, width), (x, y) = shape, corner
    x, y, width, height = x - REACH, y - REACH, width + 2 * REACH, height + 2 * REACH
    patterns = [grain_pattern(x, y, width, height, _WHITE, seed, k) for k in range(3)]
    white = np.stack(patterns, axis=2)
    made = convolve(white, kernels(grain))
    return np.ascontiguousarray(made[REACH:-REACH, REACH:-REACH])


def kernels(grain: Grain) -> Floats:
    """Kernels that give white noise the spectra: real, even, shape (31, 31, 3, 3).

    They are the matrix square root of the cross power at each frequency.
    """
    shares, axes = np.linalg.eigh(whole_spectrum(grain.spectra))
    root = np.einsum("yxik,yxk,yxjk->yxij", axes, np.sqrt(np.maximum(shares, 0)), axes)
    spread = np.roll(np.fft.ifft2(root, axes=(0, 1)).real, (SIDE // 2, SIDE // 2), (0, 1))[1:, 1:]
    own = np.sqrt(np.square(spread).sum(axis=(0, 1, 3)))
    return np.asarray(spread / np.maximum(own, 1e-9)[:, None], np.float32)
