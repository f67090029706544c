"""Colour of a sensor: the matrix that best turns XYZ into its channels.

Channels are sums over the spectrum that XYZ does not have, so a matrix between them is a fit over
some reflectances. Ours are the two kinds that meet Daguerre's cameras: those that renders make of
RGB (Mallett and Yuksel 2019), a grid of them, and smooth ones as nature has: sigmoids of parabolas
over wavelength (Jakob and Hanika 2019). White is kept exactly.
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
    """The surfaces of the fit at ``illuminants.NM``, shape (N, L)."""
    return np.concatenate([_upsampled(), _smooth()])


def _upsampled() -> FloatArray:
    steps = np.linspace(0.05, 0.95, 4)
    grid = np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3)
    return np.asarray(grid @ illuminants.rgb_reflectances().T)


def _smooth() -> FloatArray:
    """Sigmoids of parabolas: slopes, bumps and dips of several heights and places."""
    x = (illuminants.NM - 560) / 100
    rows = []
    for bend in (-2.0, -0.7, 0.0, 0.7, 2.0):
        for slope in (-4.0, -2.0, -0.8, 0.8, 2.0, 4.0):
            for level in (-1.5, 0.0, 1.5):
                t = bend * x**2 + slope * x + level
                rows.append(0.5 + t / (2 * np.sqrt(1 + t**2)))
    return np.array(rows)


def _fitted(curves: FloatArray, light: FloatArray) -> FloatArray:
    """The matrix (C, 3) from XYZ to sums with curves (C, L), exact for the light itself."""
    seen = reflectances() * light
    xyz, sums = seen @ illuminants.observer(), seen @ curves.T
    white, white_sums = illuminants.observer().T @ light, curves @ light
    normal = xyz.T @ xyz
    # Least squares under one condition, by a multiplier (Boyd and Vandenberghe 2018, 16.2).
    system = np.block([[normal, white[:, None]], [white[None], np.zeros((1, 1))]])
    right = np.vstack([xyz.T @ sums, white_sums[None]])
    return np.asarray(np.linalg.solve(system, right)[:3].T)


class Seeing(Protocol):
    """A sensor or a film stock: what sees light by wavelength."""

    @property
    def channels(self) -> tuple[str, ...]:
        """Their names."""

    @property
    def hash(self) -> str:
        """Hash of all that a frame's channels depend on."""

    def sensitivity(self, nm: ArrayLike) -> FloatArray:
        """Sensitivity like that of ``Sensor``: D65 of Y = 1 is 1 in each channel, shape (C, L)."""


def channels_from_xyz(sensor: Seeing) -> FloatArray:
    """Frame channels (D65 white is 1 in each) from XYZ (D65 white has Y = 1), shape (C, 3)."""
    curves = sensor.sensitivity(illuminants.NM) * illuminants.STEP
    return _fitted(curves, illuminants.d65())


def _raw_curves(sensor: Response) -> FloatArray:
    """Raw response with crosstalk; the strongest of D65 of Y = 1 is 1, as sums."""
    curves = sensor.mixing @ (sensor.efficiency(illuminants.NM) * illuminants.NM)
    return np.asarray(curves / (curves @ illuminants.d65()).max())


def colour_matrix(sensor: Response, xy: tuple[float, float]) -> FloatArray:
    """Raw values from XYZ for a white."""
    curves = _raw_curves(sensor)
    day = _fitted(curves, illuminants.d65())
    if xy == illuminants.D65_XY:
        return day
    lamp = _fitted(curves, illuminants.planck(illuminants.A_KELVIN))
    low, high = 1 / illuminants.D65_KELVIN, 1 / illuminants.A_KELVIN
    part = np.clip((1 / illuminants.kelvin_of(xy) - low) / (high - low), 0, 1)
    return np.asarray((1 - part) * day + part * lamp)


def rgb_from_channels(sensor: Response, xy: tuple[float, float]) -> FloatArray:
    """Linear Rec.709 from frame channels, balanced for a white."""
    if len(sensor.channels) == 1:
        return np.ones((3, 1))
    raw_from_channels = sensor.mixing @ np.diag(sensor.electrons_per_lux_s())
    raw_from_channels /= sensor.white_electrons().max()
    xyz_from_raw = np.linalg.inv(colour_matrix(sensor, xy))
    adapted = adaptation(xy, illuminants.D65_XY)
    return np.asarray(rgb_from_xyz() @ adapted @ xyz_from_raw @ raw_from_channels)
