"""Frame of the film that a profile is for, and its image heights."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.lenses.image_circle import FULL_FRAME

FloatArray = NDArray[np.float64]

PIXELS = 24e6  # for residuals


@dataclass(frozen=True)
class Frame:
    """A frame of the film.

    Attributes:
        long_mm, short_mm: Sides of the frame, mm.
    """

    long_mm: float
    short_mm: float

    @property
    def corner_mm(self) -> float:
        """Half of the diagonal: unit of the radius for vignetting."""
        return 0.5 * math.hypot(self.long_mm, self.short_mm)

    @property
    def unit_mm(self) -> float:
        """Half of the short side: unit of the radius for distortion and lateral colour."""
        return 0.5 * self.short_mm

    @property
    def crop_factor(self) -> float:
        """Diagonal of 36 x 24 mm over this one's."""
        return FULL_FRAME / self.corner_mm

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel of 24 MP."""
        return math.sqrt(self.long_mm * self.short_mm / PIXELS)

    def rings(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Image heights from the axis to the corner, mm, and the share of the frame at each."""
        r = np.linspace(0, self.corner_mm, count + 1)
        with np.errstate(divide="ignore"):
            right, top = (np.minimum(1, 0.5 * side / r) for side in (self.long_mm, self.short_mm))
        area = np.maximum(r * (np.arcsin(top) - np.arccos(right)), 0)
        return r, area / area.sum()
