"""The point spread function: the image of a point source."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from daguerre.argument_checks import guarded
from daguerre.checks import number, whole
from daguerre.files.array_value import ArrayValue
from daguerre.files.value import BriefRecord

from .bench import FloatArray
from .pencils import Pencil
from .plotted import Plotted
from .spots import Spot, spot
from .wavefronts import Wavefront, wavefront

#: Wavelengths (nm) of white light, and their weights for the eye (CIE 1924 V).
WHITE_NM = (470.0, 510.0, 555.0, 610.0, 650.0)
WHITE_WEIGHTS = (0.091, 0.503, 1.0, 0.503, 0.107)
MAX_GRID = 288  # most directions across that are traced
MOST_POINTS = 320  # most points across the PSF of waves, before they are summed to pixels


@guarded
@dataclass(frozen=True, repr=False)
class Psf(BriefRecord, ArrayValue, Plotted, array="image"):
    """Light of an object point in a window on the film.

    Attributes:
        image: Share of the light in each pixel, rows along the tangential axis (upward from row
            0), columns along the sagittal axis; shape (n, n). The sum is the share in the window.
        half_mm: Half of the window's width, mm.
        center: Centre of the window, sagittal and tangential, mm from the chief ray's film point.
        diffraction: Whether diffraction is included.
    """

    image: FloatArray
    half_mm: float
    center: FloatArray
    diffraction: bool

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel, mm."""
        return 2 * self.half_mm / len(self.image)

    @property
    def line_widths(self) -> tuple[float, float]:
        """Widths (light / peak) of the line spread functions, sagittal and tangential, mm."""
        sums = (self.image.sum(axis=0), self.image.sum(axis=1))
        sagittal, tangential = (float(s.sum() / s.max()) * self.pixel_mm for s in sums)
        return sagittal, tangential

    @property
    def axis_mm(self) -> FloatArray:
        """Pixel centres relative to the window's centre, mm, shape (n,)."""
        n = len(self.image)
        return np.asarray((np.arange(n) + 0.5) * self.pixel_mm - self.half_mm)


@guarded
def geometric_psf(
    light: Pencil,
    wavelengths_nm: Sequence[float] = WHITE_NM,
    weights: Sequence[float] = WHITE_WEIGHTS,
    *,
    half_mm: float | None = None,
    pixels: int = 64,
    grid: int = 88,
    dz: float = 0.0,
) -> Psf:
    """Computes the PSF of rays: correct if the blur is much larger than diffraction.

    Args:
        light: From ``pencil``.
        wavelengths_nm: Wavelengths, nm, shape (L,).
        weights: Weights of the wavelengths, shape (L,).
        half_mm: Half of the window's width, mm; None: enough for all rays.
        pixels: Width of the PSF, px.
        grid: Rays across, for each wavelength.
        dz: Shift of the film away from the lens, mm.
    """
    rays = spot(light, wavelengths_nm, weights, grid=grid, jitter=True).moved(dz)
    return binned(rays, half_mm, pixels)


def binned(rays: Spot, half_mm: float | None, pixels: int) -> Psf:
    """Sums the rays of a spot in square pixels around its centroid."""
    whole(pixels, "point spread: pixels", 1, 8192)
    center = rays.centroid
    off = rays.points - center
    half = half_mm or 1.1 * float(np.abs(off).max(initial=1e-4))
    edges = np.linspace(-half, half, pixels + 1)
    image, _, _ = np.histogram2d(off[:, 1], off[:, 0], bins=(edges, edges), weights=rays.weights)
    return Psf(image, half, center, diffraction=False)


@guarded
def diffraction_psf(
    light: Pencil,
    wavelengths_nm: Sequence[float] = WHITE_NM,
    weights: Sequence[float] = WHITE_WEIGHTS,
    *,
    half_mm: float | None = None,
    pixels: int = 64,
    dz: float = 0.0,
    max_grid: int = MAX_GRID,
) -> Psf | None:
    """Computes the PSF of waves: |sum of exp(i k (W + a x + b y))|^2 over directions of light.

    Args:
        light: From ``pencil``.
        wavelengths_nm: Wavelengths, nm, shape (L,); their waves do not interfere.
        weights: Weights of the wavelengths, shape (L,).
        half_mm: Half of the window's width, mm; None: the spot and three Airy radii.
        pixels: Width of the PSF, px.
        dz: Shift of the film away from the lens, mm.
        max_grid: Most directions across that are traced.

    Returns:
        The PSF, or None if no light arrives, or if the fringes of a large blur need more than
        ``max_grid`` directions across; then use ``geometric_psf``.
    """
    rays = spot(light, wavelengths_nm, weights, grid=32).moved(dz)
    if not len(rays.weights):
        return None
    spread = float(np.abs(rays.points - rays.centroid).max())
    airy = 1.22e-6 * max(wavelengths_nm) * light.bench.f_stop
    half = half_mm or 1.1 * spread + 3 * airy
    waves = waves_of(light, wavelengths_nm, half + spread, rays.centroid, max_grid)
    if not waves:
        return None
    share = [weights[wavelengths_nm.index(wave.wavelength_nm)] / sum(weights) for wave in waves]
    return psf_of(waves, share, half, pixels, rays.centroid, dz)


def waves_of(
    light: Pencil,
    wavelengths_nm: Sequence[float],
    reach_mm: float,
    about: FloatArray,
    max_grid: int = MAX_GRID,
) -> list[Wavefront]:
    """Wavefronts fine enough for a reach (mm) about an image point; none if over ``max_grid``."""
    grids = [grid_for(light, nm, reach_mm) for nm in wavelengths_nm]
    if max(grids) > max_grid:
        return []
    found = (
        wavefront(light, nm, grid=grid, about=about)
        for nm, grid in zip(wavelengths_nm, grids, strict=True)
    )
    return [wave for wave in found if wave is not None]


def psf_of(
    waves: Sequence[Wavefront],
    shares: Sequence[float],
    half_mm: float,
    pixels: int,
    center: FloatArray,
    dz: float = 0.0,
) -> Psf:
    """Computes the PSF of several wavelengths around one point, from their shares of the light."""
    # Points are close enough for the finest fringes, then summed to pixels.
    sine = min(0.5 * wave.step * len(wave.amplitude) for wave in waves)
    finest = 0.2e-6 * min(wave.wavelength_nm for wave in waves) / sine
    each = max(1, min(int(np.ceil(2 * half_mm / pixels / finest)), MOST_POINTS // pixels))
    count = pixels * each
    x = (np.arange(count) + 0.5) / count * 2 * half_mm - half_mm
    fine = np.zeros((count, count))
    for wave, share in zip(waves, shares, strict=True):
        fine += share * _intensity(wave.defocused(dz), x)
    image = fine.reshape(pixels, each, pixels, each).sum(axis=(1, 3))
    return Psf(image, half_mm, center, diffraction=True)


@guarded
def strehl_ratio(wave: Wavefront) -> float:
    """Peak of the PSF relative to a perfect wave through the same pupil.

    The peak is the brightest point within about an Airy radius of the wave's image point.
    """
    reach = 0.6e-6 * wave.wavelength_nm / (0.5 * wave.step * len(wave.amplitude))
    x = np.linspace(-reach, reach, 21)
    pixel = x[1] - x[0]
    perfect = wave.amplitude.sum() ** 2 * _normalization(wave) * pixel**2
    return float(_intensity(wave, x).max() / perfect)


def grid_for(light: Pencil, nm: float, reach_mm: float) -> int:
    """Directions across for which neighbours differ by less than half a wave at a reach, mm."""
    number(reach_mm, "point spread: half_mm and dz: reach on the film, mm", 0, 1000)
    sine = 0.5 / light.bench.f_stop
    wanted = 2 * (2 * sine) * reach_mm / (1e-6 * nm) * 1.3
    return max(72, 24 * int(np.ceil(wanted / 24)))


def _normalization(wave: Wavefront) -> float:
    # Parseval: the intensity's integral over the film is the light of the pupil.
    return float((wave.step / (1e-6 * wave.wavelength_nm)) ** 2 / (wave.amplitude**2).sum())


def _intensity(wave: Wavefront, x: FloatArray) -> FloatArray:
    """Share of the light in each pixel of a square raster x by x (mm); rows are tangential."""
    k = 2e6 * np.pi / wave.wavelength_nm
    across = np.exp(1j * k * np.outer(wave.cosines[0, :, 0], x))
    along = np.exp(1j * k * np.outer(wave.cosines[:, 0, 1], x))
    field = along.T @ wave.pupil_function @ across
    pixel = x[1] - x[0]
    return np.asarray(np.abs(field) ** 2 * _normalization(wave) * pixel**2)


@guarded
def point_spread(light: Pencil, *, max_grid: int = MAX_GRID, **options: object) -> Psf:
    """Computes the PSF of waves, or of rays if the blur needs more than ``max_grid`` directions.

    Options are as for ``diffraction_psf``.
    """
    waves = diffraction_psf(light, max_grid=max_grid, **options)  # type: ignore[arg-type]
    return waves if waves is not None else geometric_psf(light, **options)  # type: ignore[arg-type]
