"""The sRGB transfer function and its inverse (IEC 61966-2-1).

Results have the precision of the argument, single or double.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

POWER, OFFSET, SLOPE = 2.4, 0.055, 12.92
#: End of the linear part, as an encoded value and as linear light.
ENCODED_KNEE, LINEAR_KNEE = 0.04045, 0.0031308


def to_linear(encoded: NDArray[Any]) -> NDArray[Any]:
    """Decodes sRGB values to linear light, any shape, 0 .. 1."""
    high = ((np.maximum(encoded, 0) + OFFSET) / (1 + OFFSET)) ** POWER
    return np.where(encoded <= ENCODED_KNEE, encoded / SLOPE, high)


def from_linear(linear: NDArray[Any]) -> NDArray[Any]:
    """Encodes linear light to sRGB values, any shape, 0 .. 1."""
    high = (1 + OFFSET) * np.maximum(linear, 1e-8) ** (1 / POWER) - OFFSET
    return np.where(linear <= LINEAR_KNEE, SLOPE * linear, high)
