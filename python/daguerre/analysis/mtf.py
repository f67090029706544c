"""Modulation transfer function: the share of a grating's contrast that the lens keeps."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from daguerre.argument_checks import guarded
from daguerre.checks import line

from .bench import FDC_NM, FDC_WEIGHTS, FloatArray
from .pencils import Pencil
from .psf import grid_for
from .spots import Spot, spot
from .wavefronts import ComplexArray, wavefront


@guarded
def geometric_mtf(rays: Spot, freq_per_mm: ArrayLike) -> FloatArray:
    """Computes the MTF of rays, without diffraction: the modulus of the spot's Fourier transform.

    Args:
        rays: From ``spot``.
        freq_per_mm: Spatial frequencies, cycles per mm, shape (F,).

    Returns:
        Modulation in [0, 1], shape (F, 2): sagittal, tangential.
    """
    f = line(freq_per_mm, "geometric_mtf: freq_per_mm")
    if not len(rays.weights):
        return np.zeros((len(f), 2))
    waves = np.exp(-2j * np.pi * f[:, None, None] * rays.points[None])
    return np.asarray(np.abs(np.einsum("n,fnk->fk", rays.weights, waves)))


@guarded
def diffraction_mtf(
    light: Pencil,
    freq_per_mm: ArrayLike,
    wavelengths_nm: Sequence[float] = FDC_NM,
    weights: Sequence[float] = FDC_WEIGHTS,
    *,
    grid: int | None = None,
    dz: float = 0.0,
) -> FloatArray:
    """Computes the MTF of waves: the pupil's autocorrelation, in a weighted sum of wavelengths.

    Args:
        light: From ``pencil``.
        freq_per_mm: Spatial frequencies, cycles per mm, shape (F,).
        wavelengths_nm: Wavelengths, nm, shape (L,).
        weights: Weights of the wavelengths, shape (L,).
        grid: Directions across; None: as many as the aberrations need.
        dz: Shift of the film away from the lens, mm.

    Returns:
        Modulation in [0, 1], shape (F, 2): sagittal (lines along the radius), tangential.
    """
    f = line(freq_per_mm, "diffraction_mtf: freq_per_mm")
    total = np.zeros((len(f), 2), np.complex128)
    rays = spot(light, wavelengths_nm, weights, grid=24).moved(dz)
    if not len(rays.weights):
        return np.zeros((len(f), 2))
    center = rays.centroid
    spread = float(np.abs(rays.points - center).max())
    light_sum = 0.0
    for nm, weight in zip(wavelengths_nm, weights, strict=True):
        across = grid or min(grid_for(light, nm, spread), 192)
        wave = wavefront(light, nm, grid=across, about=center)
        if wave is None:
            continue
        transfer = _transfer(wave.defocused(dz).pupil_function)
        lag = f * 1e-6 * nm / wave.step  # shift of the pupil, in steps
        for k in range(2):
            total[:, k] += weight * _interpolated(transfer[k], lag)
        light_sum += weight
    return np.asarray(np.abs(total) / max(light_sum, 1e-30))


@guarded
def perfect_mtf(freq_per_mm: ArrayLike, f_number: float, wavelength_nm: float) -> FloatArray:
    """MTF of a lens without aberrations and with a round pupil, shape (F,).

    Source: Goodman, Introduction to Fourier Optics, 3rd ed., section 6.3.
    """
    share = np.minimum(1, np.asarray(freq_per_mm) * 1e-6 * wavelength_nm * f_number)
    return np.asarray(2 / np.pi * (np.arccos(share) - share * np.sqrt(1 - share**2)))


def _transfer(pupil: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Autocorrelations across columns (sagittal) and rows (tangential), at lags of whole steps."""
    n = len(pupil)
    out = []
    for axis in (1, 0):
        spectrum = np.abs(np.fft.fft(pupil, 2 * n, axis=axis)) ** 2
        lags = np.fft.ifft(spectrum.sum(axis=1 - axis))[:n]
        out.append(lags / lags[0])
    return out[0], out[1]


def _interpolated(transfer: ComplexArray, lag: FloatArray) -> ComplexArray:
    at = np.arange(len(transfer))
    real = np.interp(lag, at, transfer.real, right=0.0)
    return np.asarray(real + 1j * np.interp(lag, at, transfer.imag, right=0.0))
