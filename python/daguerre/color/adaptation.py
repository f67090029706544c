"""Chromatic adaptation by Bradford's matrix."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import illuminants

FloatArray = NDArray[np.float64]


#: Cone responses of the Bradford adaptation (as in ICC profiles of version 4, annex E).
BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)


def adaptation(from_xy: tuple[float, float], to_xy: tuple[float, float]) -> FloatArray:
    """XYZ under one white to those that look alike under another (Bradford), shape (3, 3)."""
    before = BRADFORD @ illuminants.xyz_of_xy(from_xy)
    after = BRADFORD @ illuminants.xyz_of_xy(to_xy)
    return np.asarray(np.linalg.inv(BRADFORD) @ np.diag(after / before) @ BRADFORD)
