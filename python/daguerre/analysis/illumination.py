"""Illumination over the field, and the shape of the pupil seen from each film point."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.checks import line, rows, whole
from daguerre.files.value import BriefRecord
from daguerre.lenses.lens import DESIGN_WAVELENGTH_NM

from .bench import Bench, FloatArray
from .chief import chief_rays
from .light_search import Light, light_at, passes
from .plotted import Plotted

GRID = 96
COARSE = 20  # rays across a pupil for its transmittance by wavelength
CORNERS = 48  # corners of its outline
CHANGE = 0.1  # largest relative change of the outline's radii with wavelength
DARK = 0.02  # share of the axis's light at which figures end


@dataclass(frozen=True, repr=False)
class Illumination(BriefRecord, Plotted):
    """Light on the film over the field.

    Attributes:
        height_mm: Image heights, mm, shape (N,).
        irradiance: Irradiance on the film over the radiance of the scene, E / L, shape (N,).
        cos4_object: cos^4 of the angle in front of the lens, shape (N,).
        cos4_film: cos^4 of the angle at the film toward the centre of the paraxial exit pupil
            (Kolb, Mitchell and Hanrahan 1995), shape (N,).
    """

    height_mm: FloatArray
    irradiance: FloatArray
    cos4_object: FloatArray
    cos4_film: FloatArray

    @property
    def relative(self) -> FloatArray:
        """Irradiance relative to the axis, shape (N,); NaN if the axis is dark."""
        axis = self.irradiance[0]
        return np.asarray(self.irradiance / axis if axis else np.full_like(self.irradiance, np.nan))


@guarded
def relative_illumination(
    bench: Bench,
    heights_mm: ArrayLike,
    wavelength_nm: float = DESIGN_WAVELENGTH_NM,
    *,
    grid: int = GRID,
) -> Illumination:
    """Computes E / L over the field: the pupil's area in direction cosines times transmittance.

    This is exact for any pupil: dE = L T cos(t) dw, and cos(t) dw is area in direction cosines.

    Args:
        bench: The lens.
        heights_mm: Image heights along y, mm, shape (N,), the first on the axis.
        wavelength_nm: Wavelength, nm.
        grid: Rays across the pupil.
    """
    heights = line(heights_mm, "relative_illumination: heights_mm")
    chief = chief_rays(bench, heights, wavelength_nm)
    values = [_irradiance(bench, _along_y(h), wavelength_nm, grid) for h in heights]
    reach = bench.film_z - bench.order.exit_pupil.z
    return Illumination(
        heights,
        np.array(values),
        np.cos(chief.angles) ** 4,
        (reach**2 / (reach**2 + heights**2)) ** 2,
    )


@guarded
def spectral_illumination(
    bench: Bench, film_mm: ArrayLike, wavelengths_nm: ArrayLike, *, grid: int = GRID
) -> FloatArray:
    """Computes E / L of film points by wavelength, with vignetting and coatings.

    A fine grid is traced only at the design wavelength. Other wavelengths scale its result by the
    area of the pupil's outline and the mean transmittance: both are smooth over wavelength, whereas
    single rays of a grid enter and leave at the edge.

    Args:
        bench: The lens; it need not be axially symmetric.
        film_mm: Film points, shape (N, 2), mm.
        wavelengths_nm: Wavelengths, shape (L,), nm.
        grid: Rays across the pupil.

    Returns:
        Shape (N, L); 0 where it is dark.
    """
    wavelengths = line(wavelengths_nm, "spectral_illumination: wavelengths_nm")
    points = rows(film_mm, "spectral_illumination: film_mm", 2)
    return np.array([_by_wavelength(bench, point, wavelengths, grid) for point in points])


def _by_wavelength(bench: Bench, film: FloatArray, nm: FloatArray, grid: int) -> FloatArray:
    found = light_at(bench, film, DESIGN_WAVELENGTH_NM)
    if found is None:
        return np.zeros(len(nm))
    light = _through(bench, film, DESIGN_WAVELENGTH_NM, found, grid)
    some = found.seen[:: max(len(found.seen) // COARSE**2, 1)]

    def transmitted(w: float) -> float:
        return float(passes(bench, film, some, w, clip=False).sum())

    middle, away = found.seen.mean(axis=0), _around(CORNERS)
    far = np.full(CORNERS, found.width)
    edge = _edge(bench, film, middle, away, 0 * far, far, DESIGN_WAVELENGTH_NM, 16)

    def area(w: float) -> float:
        near, wide = (1 - CHANGE) * edge, (1 + CHANGE) * edge
        return _area(_edge(bench, film, middle, away, near, wide, w, 11))

    each = np.array([transmitted(float(w)) * area(float(w)) for w in nm])
    return np.asarray(light * each / (transmitted(DESIGN_WAVELENGTH_NM) * _area(edge)))


def within_light(bench: Bench) -> Bench:
    """Returns the bench with its field limited to where DARK of the axis's light is left."""

    def light(height: float) -> float:
        return _irradiance(bench, _along_y(height), DESIGN_WAVELENGTH_NM, 24)

    low, high = 0.0, bench.field_mm
    dark = DARK * light(0.0)
    if light(high) > dark:
        return bench
    for _ in range(9):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if light(middle) > dark else (low, middle)
    return replace(bench, field_mm=low or bench.field_mm)


@guarded
def pupil_outline(
    bench: Bench,
    height_mm: float,
    wavelength_nm: float = DESIGN_WAVELENGTH_NM,
    *,
    corners: int = 72,
) -> FloatArray:
    """Outline of the pupil seen from a film point: the cat's eye.

    Args:
        bench: The lens.
        height_mm: Image height along y, mm.
        wavelength_nm: Wavelength, nm.
        corners: Corners of the outline.

    Returns:
        Direction cosines of a closed outline, shape (corners + 1, 2); shape (0, 2) if no light
        arrives.
    """
    whole(corners, "pupil_outline: corners", 3, 1 << 14)
    film = _along_y(height_mm)
    found = light_at(bench, film, wavelength_nm)
    if found is None:
        return np.zeros((0, 2))
    middle = found.seen.mean(axis=0)
    away = _around(corners)
    outer = np.full(corners, found.width)
    inner = _edge(bench, film, middle, away, 0 * outer, outer, wavelength_nm, 22)
    edge = middle + inner[:, None] * away
    return np.concatenate([edge, edge[:1]])


def _around(corners: int) -> FloatArray:
    angle = 2 * np.pi * np.arange(corners) / corners
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _edge(
    bench: Bench,
    film: FloatArray,
    middle: FloatArray,
    away: FloatArray,
    inner: FloatArray,
    outer: FloatArray,
    nm: float,
    steps: int,
) -> FloatArray:
    """Distances from the middle of the light to its edge, searched between two bounds, (N,)."""
    for _ in range(steps):
        between = 0.5 * (inner + outer)
        lit = passes(bench, film, middle + between[:, None] * away, nm) > 0
        inner, outer = np.where(lit, between, inner), np.where(lit, outer, between)
    return inner


def _area(radii: FloatArray) -> float:
    """Area of an outline with equal angles, up to a factor."""
    return float((radii**2).sum())


def _along_y(height_mm: float) -> FloatArray:
    return np.array([0.0, height_mm])


def _irradiance(bench: Bench, film: FloatArray, nm: float, grid: int) -> float:
    found = light_at(bench, film, nm)
    return 0.0 if found is None else _through(bench, film, nm, found, grid)


def _through(bench: Bench, film: FloatArray, nm: float, light: Light, grid: int) -> float:
    """Area of the light in direction cosines, times its transmittance."""
    whole(grid, "illumination: grid", 1, 4096)
    cell = (light.high - light.low) / grid
    u = np.arange(grid) + 0.5
    at = np.stack(np.meshgrid(*(light.low[k] + cell[k] * u for k in range(2))), -1)
    return float(passes(bench, film, at.reshape(-1, 2), nm).sum() * cell[0] * cell[1])
