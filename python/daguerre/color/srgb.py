"""The sRGB transfer function, both ways (IEC 61966-2-1).

Single and double precision alike: results have the type of what they are made of.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

POWER, OFFSET, SLOPE = 2.4, 0.055, 12.92
#: Where the line ends and the power begins: an encoded number, and the light that it stands for.
ENCODED_KNEE, LINEAR_KNEE = 0.04045, 0.0031308


def to_linear(encoded: NDArray[Any]) -> NDArray[Any]:
    """Linear light of encoded numbers, any shape, 0 .. 1."""
    high = ((np.maximum(encoded, 0) + OFFSET) / (1 + OFFSET)) ** POWER
    return np.where(encoded <= ENCODED_KNEE, encoded / SLOPE, high)


def from_linear(linear: NDArray[Any]) -> NDArray[Any]:
    """Encoded numbers of linear light, any shape, 0 .. 1."""
    high = (1 + OFFSET) * np.maximum(linear, 1e-8) ** (1 / POWER) - OFFSET
    return np.where(linear <= LINEAR_KNEE, SLOPE * linear, high)
