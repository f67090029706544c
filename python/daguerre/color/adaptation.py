"""Chromatic adaptation by Bradford's matrix.

Source: Lindbloom, "Chromatic Adaptation",
http://www.brucelindbloom.com/index.html?Eqn_ChromAdapt.html; ICC.1:2022, annex E.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import illuminants

FloatArray = NDArray[np.float64]


#: Matrix from XYZ to cone responses.
BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)


def adaptation(from_xy: tuple[float, float], to_xy: tuple[float, float]) -> FloatArray:
    """Matrix that adapts XYZ from one white to another (Bradford), shape (3, 3)."""
    return adaptation_of_xyz(illuminants.xyz_of_xy(from_xy), illuminants.xyz_of_xy(to_xy))


def adaptation_of_xyz(white: FloatArray, to: FloatArray) -> FloatArray:
    """Matrix that adapts XYZ between whites given by their XYZ, shape (3,) each."""
    gains = (BRADFORD @ to) / (BRADFORD @ white)
    return np.asarray(np.linalg.inv(BRADFORD) @ np.diag(gains) @ BRADFORD)
