"""Distortion of a real lens from chief rays, at its focus and zoom, for one wavelength."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Chebyshev

from daguerre.analysis.bench import Bench
from daguerre.analysis.chief import chief_rays
from daguerre.cached import cached_property
from daguerre.errors import InputError
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .model import WIDEST, FloatArray, Radial
from .monotone import SAMPLES, Monotone

HEIGHTS = 48
NEAR, NEAR_HEIGHTS = 0.1, 10  # share of the reach, and heights, for the scale near the axis
DEGREE = 20
TRIM = 1e-10  # terms that are a smaller share of the angle are dropped


@dataclass(frozen=True)
class LensDistortion(Radial):
    """Distortion of an axially symmetric lens, for a plane at its focus distance.

    The ideal picture is a pinhole's in the middle of the paraxial entrance pupil. It has the scale
    of the lens near the axis at the design wavelength, not at this model's. So models of several
    wavelengths differ by the lens's lateral colour.

    Attributes:
        bench: Lens on the bench.
        reach_mm: Largest image height that is needed, mm.
        wavelength_nm: Wavelength, nm.
    """

    bench: Bench
    reach_mm: float
    wavelength_nm: float = DESIGN_WAVELENGTH_NM

    @classmethod
    def of_colours(
        cls, bench: Bench, reach_mm: float, wavelengths_nm: Sequence[float]
    ) -> list[LensDistortion]:
        """Returns models of one lens for several wavelengths, with a common scale."""
        made = [cls(bench, reach_mm, nm) for nm in wavelengths_nm]
        for model in made[1:]:
            model.__dict__["focal_length_mm"] = made[0].focal_length_mm
        return made

    def __post_init__(self) -> None:
        if not self.bench.lens.prescription.is_axially_symmetric:
            raise InputError(
                f"{self.bench.lens.name}: distortion: wanted an axially symmetric lens; use "
                "LensMap for this one"
            )

    @cached_property
    def focal_length_mm(self) -> float:
        """Focal length: image height over the tangent of the angle, near the axis, mm."""
        near = NEAR * self.reach_mm
        angle, _ = _angles(self.bench, near, DESIGN_WAVELENGTH_NM, NEAR_HEIGHTS)
        return 1 / float(angle(0.0))

    @cached_property
    def _to_ideal(self) -> Monotone:
        ratio, reach = _angles(self.bench, self.reach_mm, self.wavelength_nm)
        focal = self.focal_length_mm

        def ideal(radius: FloatArray) -> FloatArray:
            height = radius * focal
            return tangent(height * ratio(height * height))

        return Monotone(ideal, np.linspace(0, reach / focal, SAMPLES))

    def _bent(self, radius: FloatArray) -> FloatArray:
        return self._to_ideal.inverse(radius)

    def _straight(self, radius: FloatArray) -> FloatArray:
        return self._to_ideal(radius)


def tangent(angle: FloatArray) -> FloatArray:
    """Radius at distance 1 for an angle off the axis; NaN for 90 degrees and more."""
    return np.where(angle < WIDEST, np.tan(np.minimum(angle, 1.5706)), np.nan)


def _angles(
    bench: Bench, reach_mm: float, nm: float, rays: int = HEIGHTS
) -> tuple[Chebyshev, float]:
    """Angle over image height as a function of its square, and its largest valid height, mm."""
    heights = reach_mm * np.sin(0.5 * np.pi * (np.arange(rays) + 0.5) / rays)
    chief = chief_rays(bench, heights, nm)
    slope = chief.directions[:, 1] / chief.directions[:, 2]
    angles = chief.angles
    if math.isfinite(bench.focus_mm):
        plane = bench.order.entrance_pupil.z - bench.focus_mm
        seen = chief.points[:, 1] + slope * (plane - chief.points[:, 2])
        angles = np.arctan2(np.abs(seen), bench.focus_mm)
    good = np.isfinite(angles) & (chief.directions[:, 2] > 0.02)
    count = len(good) if good.all() else int(np.argmin(good))
    if count < 8:
        raise InputError(
            f"{bench.lens.name}: distortion: wanted chief rays at 8 or more image heights from the "
            f"axis, got {count}"
        )
    end = heights[count - 1] if count < len(good) else reach_mm
    x, y = heights[:count] ** 2, angles[:count] / heights[:count]
    fit = Chebyshev.fit(x, y, min(DEGREE, count // 2), domain=[0, end**2])
    return fit.trim(TRIM * y[0]), float(end)
