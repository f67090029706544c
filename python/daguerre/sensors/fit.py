"""Fits the matrices between XYZ and a sensor's channels.

XYZ does not determine a sensor's channels, so a matrix between them is a least-squares fit over
reflectances. Two kinds are used, as Daguerre's cameras see both: a grid of the reflectances that
renders make from RGB (Mallett and Yuksel 2019), and smooth, natural reflectances: sigmoids of
parabolas over wavelength (Jakob and Hanika 2019). White is kept exactly.
"""

from __future__ import annotations

from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.color import illuminants
from daguerre.color.adaptation import adaptation
from daguerre.color.spectra import rgb_from_xyz

from .response import Response

FloatArray = NDArray[np.float64]


@cache
def reflectances() -> FloatArray:
    """Reflectances of the fit at ``illuminants.NM``, shape (N, L)."""
    return np.concatenate([_upsampled(), _smooth()])


def _upsampled() -> FloatArray:
    steps = np.linspace(0.05, 0.95, 4)
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    return np.asarray(grid @ illuminants.rgb_reflectances().T)


def _smooth() -> FloatArray:
    """Sigmoids of parabolas: slopes, bumps and dips of several heights and positions."""
    x = (illuminants.NM - 560) / 100
    rows = []
    for bend in (-2.0, -0.7, 0.0, 0.7, 2.0):
        for slope in (-4.0, -2.0, -0.8, 0.8, 2.0, 4.0):
            for level in (-1.5, 0.0, 1.5):
                t = bend * x**2 + slope * x + level
                rows.append(0.5 + t / (2 * np.sqrt(1 + t**2)))
    return np.array(rows)


def _fitted(curves: FloatArray, light: FloatArray) -> FloatArray:
    """Fits the matrix (C, 3) from XYZ to sums with curves (C, L); exact for the light itself."""
    seen = reflectances() * light
    xyz, sums = seen @ illuminants.observer(), seen @ curves.T
    white, white_sums = illuminants.observer().T @ light, curves @ light
    normal = xyz.T @ xyz
    # Constrained least squares, by a Lagrange multiplier (Boyd and Vandenberghe 2018, 16.2).
    system = np.block([[normal, white[:, None]], [white[None], np.zeros((1, 1))]])
    right = np.vstack([xyz.T @ sums, white_sums[None]])
    return np.asarray(np.linalg.solve(system, right)[:3].T)


class Seeing(Protocol):
    """Interface of a sensor or a film stock: sensitivity by wavelength."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels."""

    @property
    def hash(self) -> str:
        """Hash of all values on which a frame's channels depend."""

    def sensitivity(self, nm: ArrayLike) -> FloatArray:
        """Returns the sensitivity, scaled so that D65 of Y = 1 is 1 in each channel, (C, L)."""


def channels_from_xyz(sensor: Seeing) -> FloatArray:
    """Matrix from XYZ (D65 white has Y = 1) to frame channels (D65 white is 1 in each), (C, 3)."""
    curves = sensor.sensitivity(illuminants.NM) * illuminants.STEP
    return _fitted(curves, illuminants.d65())


def _raw_curves(sensor: Response) -> FloatArray:
    """Raw response with crosstalk; summed with D65 of Y = 1, the strongest channel is 1."""
    curves = sensor.mixing @ (sensor.efficiency(illuminants.NM) * illuminants.NM)
    return np.asarray(curves / (curves @ illuminants.d65()).max())


def colour_matrix(sensor: Response, xy: tuple[float, float]) -> FloatArray:
    """Matrix from XYZ to raw values for a white, shape (C, 3)."""
    curves = _raw_curves(sensor)
    day = _fitted(curves, illuminants.d65())
    if xy == illuminants.D65_XY:
        return day
    lamp = _fitted(curves, illuminants.planck(illuminants.A_KELVIN))
    low, high = 1 / illuminants.D65_KELVIN, 1 / illuminants.A_KELVIN
    part = np.clip((1 / illuminants.kelvin_of(xy) - low) / (high - low), 0, 1)
    return np.asarray((1 - part) * day + part * lamp)


def rgb_from_channels(sensor: Response, xy: tuple[float, float]) -> FloatArray:
    """Matrix from frame channels to linear Rec.709, balanced for a white, shape (3, C)."""
    if len(sensor.channels) == 1:
        return np.ones((3, 1))
    raw_from_channels = sensor.mixing @ np.diag(sensor.electrons_per_lux_s())
    raw_from_channels /= sensor.white_electrons().max()
    xyz_from_raw = np.linalg.inv(colour_matrix(sensor, xy))
    adapted = adaptation(xy, illuminants.D65_XY)
    return np.asarray(rgb_from_xyz() @ adapted @ xyz_from_raw @ raw_from_channels)
