"""Colours as people without one kind of cone see them, and how far apart they are."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color.srgb import to_linear

Array = NDArray[np.float64]
#: Matrices of linear sRGB at full severity: Machado, Oliveira and Fernandes, "A physiologically-
#: based model for simulation of color vision deficiency", IEEE TVCG 15(6), 2009, table 1.
SEEN_BY: dict[str, Array] = {
    "all cones": np.eye(3),
    "protanopia": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "deuteranopia": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
    "tritanopia": np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ]
    ),
}
_XYZ = np.array(
    [
        [0.4124564, 0.3575761, 0.1804375],
        [0.2126729, 0.7151522, 0.0721750],
        [0.0193339, 0.1191920, 0.9503041],
    ]
)


def seen(colours: Any, eyes: str) -> Array:
    """Linear sRGB that some eyes see of sRGB colours of 0 to 255, (..., 3)."""
    linear = to_linear(np.asarray(colours, np.float64) / 255)
    return np.clip(linear @ SEEN_BY[eyes].T, 0, 1)


def contrast(a: Array, b: Array) -> Array:
    """Contrast ratio of linear colours, (..., 3), by WCAG 2.2."""
    lights = np.stack([one @ _XYZ[1] for one in np.broadcast_arrays(a, b)])
    return np.asarray((lights.max(axis=0) + 0.05) / (lights.min(axis=0) + 0.05))


def lab(linear: Array) -> Array:
    """CIE 1976 L*a*b* of linear colours, (..., 3)."""
    t = linear @ _XYZ.T / _XYZ.sum(axis=1)
    g = np.where(t > 216 / 24389, np.cbrt(t), (24389 / 27 * t + 16) / 116)
    x, y, z = np.moveaxis(g, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)
