"""Spot diagrams: where the rays of one object point meet the film."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.errors import UsageError
from daguerre.files.value import BriefRecord

from .bench import FDC_NM, FDC_WEIGHTS, FloatArray
from .pencils import Pencil
from .plotted import Plotted

GRID = 48


@guarded
@dataclass(frozen=True, repr=False)
class Spot(BriefRecord, Plotted):
    """Rays of one object point on the film, at one or more wavelengths.

    Attributes:
        points: Sagittal and tangential, mm from the chief ray of 587.56 nm, shape (N, 2).
        weights: Share of the light, shape (N,), sum 1.
        wavelength_nm: Wavelength of each ray, nm, shape (N,).
        slopes: dx/dz and dy/dz on the same axes, shape (N, 2).
    """

    points: FloatArray
    weights: FloatArray
    wavelength_nm: FloatArray
    slopes: FloatArray

    @property
    def centroid(self) -> FloatArray:
        """Mean of the rays, mm, shape (2,)."""
        return np.asarray(self.weights @ self.points)

    @property
    def rms(self) -> float:
        """Root of the mean square distance from the centroid, mm."""
        off = self.points - self.centroid
        return math.sqrt(float(self.weights @ (off**2).sum(axis=1)))

    def moved(self, dz: float) -> Spot:
        """Returns the spot on a film that is ``dz`` (mm) further from the lens."""
        return Spot(self.points + dz * self.slopes, self.weights, self.wavelength_nm, self.slopes)

    def encircled_energy(self, radii_mm: FloatArray) -> FloatArray:
        """Share of the light within radii (mm) around the centroid, shape of ``radii_mm``."""
        off = self.points - self.centroid
        distance = np.hypot(off[:, 0], off[:, 1])
        order = np.argsort(distance)
        total = np.concatenate([[0.0], np.cumsum(self.weights[order])])
        return np.asarray(total[np.searchsorted(distance[order], radii_mm, side="right")])

    def energy_radius(self, share: float) -> float:
        """Radius (mm) around the centroid that contains a share of the light."""
        off = self.points - self.centroid
        distance = np.hypot(off[:, 0], off[:, 1])
        order = np.argsort(distance)
        reached = np.cumsum(self.weights[order])
        last = min(int(np.searchsorted(reached, share * reached[-1])), len(order) - 1)
        return float(distance[order][last])


@guarded
def spot(
    light: Pencil,
    wavelengths_nm: Sequence[float] = FDC_NM,
    weights: Sequence[float] = FDC_WEIGHTS,
    *,
    grid: int = GRID,
    jitter: bool = False,
) -> Spot:
    """Traces the spot of one object point, by a grid of equal cells in front of the lens.

    Args:
        light: From ``pencil``.
        wavelengths_nm: Wavelengths, nm, shape (L,).
        weights: Weights of the wavelengths, shape (L,).
        grid: Rays across.
        jitter: Whether to move each ray within its cell, against patterns; always by the same.

    Raises:
        UsageError: The numbers of weights and of wavelengths differ.
    """
    if len(weights) != len(wavelengths_nm):
        raise UsageError(
            f"spot: weights: wanted {len(wavelengths_nm)}, one for each wavelength, "
            f"got {len(weights)}"
        )
    at = light.grid(grid)
    if jitter:
        cell = (light.high - light.low) / grid
        at = at + cell * (np.random.default_rng(1).random(at.shape) - 0.5)
    flux = light.flux(at)
    parts = []
    for nm, weight in zip(wavelengths_nm, weights, strict=True):
        rays = light.trace(at, nm)
        on = rays.passed
        d = light.on_film(light.film + rays.directions[on, :2] / rays.directions[on, 2:])
        points = light.on_film(rays.at(light.bench.film_z)[on])
        share = weight * (flux * rays.transmittance)[on]
        parts.append((points, share, np.full(int(on.sum()), nm), d))
    points, share, nms, slopes = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Spot(points, share / share.sum() if len(share) else share, nms, slopes)


@guarded
def best_film_z(spots: Sequence[Spot], film_z: float) -> float:
    """Finds the film position (mm) with the smallest mean square size of several spots.

    Args:
        spots: Spots of the field points on the film at ``film_z``.
        film_z: Position of the film, mm.

    Raises:
        UsageError: No spot has rays with different slopes.
    """
    top = bottom = 0.0
    for item in spots:
        at = item.points - item.centroid
        slope = item.slopes - item.weights @ item.slopes
        top += float(item.weights @ (at * slope).sum(axis=1))
        bottom += float(item.weights @ (slope**2).sum(axis=1))
    if not bottom:
        raise UsageError("best_film_z: spots: wanted rays with different slopes, got none")
    return film_z - top / bottom
