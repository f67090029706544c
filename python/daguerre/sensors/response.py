"""Response of a sensor: conversion of light to electrons."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.cached import cached_property
from daguerre.checks import line
from daguerre.color import illuminants

from .data import SensorData

FloatArray = NDArray[np.float64]


class Response(SensorData):
    """Conversion of light to electrons, from a sensor's values."""

    def efficiency(self, nm: ArrayLike) -> FloatArray:
        """Returns electrons per photon on the photosite's whole area, with all filters, (C, L).

        Args:
            nm: Wavelengths, nm, shape (L,).
        """
        at = line(nm, "efficiency: nm")
        curves = [
            np.interp(at, self.wavelengths, row, left=0, right=0) for row in self.quantum_efficiency
        ]
        out = np.stack(curves) * self.fill_factor
        for curve in (self.infrared_cut, self.cover_glass):
            if curve is not None:
                out = out * curve.at(at)
        return out

    def electrons_per_lux_s(self, white: FloatArray | None = None) -> FloatArray:
        """Returns the electrons per photosite for 1 lux s of a light, by channel, shape (C,).

        Args:
            white: Radiance at ``illuminants.NM``, of any scale; None: D65.
        """
        return self._of_d65.copy() if white is None else self._electrons_of(white)

    @cached_property
    def _of_d65(self) -> FloatArray:
        return self._electrons_of(illuminants.d65())

    def _electrons_of(self, light: FloatArray) -> FloatArray:
        photons = illuminants.photons_per_lux_s(light) * self.photosite_area
        curves = self.efficiency(illuminants.NM)
        return np.array([illuminants.integral(curve * photons) for curve in curves])

    @property
    def mixing(self) -> FloatArray:
        """Matrix of crosstalk in uniform light, from channels to channels, shape (C, C)."""
        unmixed = np.eye(len(self.channels))
        return (1 - self.crosstalk) * unmixed + self.crosstalk * self.pattern.neighbors()

    def white_electrons(self, white: FloatArray | None = None) -> FloatArray:
        """Returns electrons per lux s, with crosstalk; see :meth:`electrons_per_lux_s`."""
        return self.mixing @ self.electrons_per_lux_s(white)
