"""Response of a sensor: electrons that light makes in each photosite."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.cached import cached_property
from daguerre.checks import line
from daguerre.color import illuminants

from .data import SensorData

FloatArray = NDArray[np.float64]


class Response(SensorData):
    """Light to electrons, by the values of a sensor."""

    def efficiency(self, nm: ArrayLike) -> FloatArray:
        """Electrons per photon on the photosite's whole area, with all filters, (C, L).

        Args:
            nm: Wavelengths, shape (L,).
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
        """Electrons that 1 lux s of a light makes in each channel's photosites, shape (C,).

        Args:
            white: Radiance at ``illuminants.NM``, of any scale; None is D65.
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
        """Crosstalk of even light: channels from channels, shape (C, C)."""
        unmixed = np.eye(len(self.channels))
        return (1 - self.crosstalk) * unmixed + self.crosstalk * self.pattern.neighbors()

    def white_electrons(self, white: FloatArray | None = None) -> FloatArray:
        """Electrons per lux s with crosstalk; see :meth:`electrons_per_lux_s`."""
        return self.mixing @ self.electrons_per_lux_s(white)
