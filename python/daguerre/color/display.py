"""Display curves of a frame: sRGB, a soft shoulder, and colors brought into the gamut."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import srgb
from .spaces import LUMINANCE_709

_LUMINANCE = LUMINANCE_709.astype(np.float32)


def _srgb(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """Encodes with the sRGB curve, clipped to [0, 1]."""
    return srgb.from_linear(np.clip(linear, 0, 1))


def _shoulder(linear: NDArray[np.float32], knee: float = 0.8) -> NDArray[np.float32]:
    """Applies a soft shoulder: identity up to the knee k, then 1 - (1 - k)^2 / (x + 1 - 2 k).

    Separate channels would shift hues, so the largest one sets the scale of its pixel. Colours move
    toward white with light above 1, half way at 17.
    """
    red, green, blue = _channels(linear)
    peak = np.maximum(np.maximum(red, green), blue)
    above = np.maximum(peak, knee)
    rolled = 1 - (1 - knee) ** 2 / (above + 1 - 2 * knee)
    over = np.maximum(peak - 1, 0)
    white = over / (over + 16)
    return np.asarray(rolled * (linear / above * (1 - white) + white * (peak > 0)), np.float32)


def into_gamut(linear: NDArray[np.float32]) -> NDArray[np.float32]:
    """Mixes negative colours with the grey of their luminance until they are in the gamut."""
    red, green, blue = _channels(linear)
    low = np.minimum(np.minimum(red, green), blue)
    if (low >= 0).all():
        return linear
    grey = np.maximum(linear @ _LUMINANCE, 0)[..., None]
    share = np.where(low < 0, grey / np.maximum(grey - low, 1e-30), 1)
    return np.asarray(np.maximum(grey + share * (linear - grey), 0), np.float32)


def _channels(linear: NDArray[np.float32]) -> list[NDArray[np.float32]]:
    """Splits (H, W, 3) into three (H, W, 1): NumPy reduces a short last axis ten times slower."""
    return np.split(linear, 3, axis=2)
