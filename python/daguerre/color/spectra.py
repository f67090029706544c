"""Spectra and colours: conversion between wavelengths, bands of a film, and RGB.

An RGB emitter, here and everywhere in Daguerre, is a mixture of three spectra: D65 times the basis
of Mallett and Yuksel 2019 (``core/spectrum``).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

import daguerre._core as _core
from daguerre.checks import whole

FloatArray = NDArray[np.float64]
FIRST_NM, LAST_NM = 380.0, 780.0
#: Number of wavelengths of fine sums; two per interval of the tables would suffice.
FINE = 1600


def rgb_from_xyz() -> FloatArray:
    """Matrix from CIE XYZ to linear Rec.709, shape (3, 3); D65 is (1, 1, 1)."""
    return np.array([_core.rgb_from_xyz(unit) for unit in np.eye(3).tolist()]).T


def luminance_of_rgb() -> FloatArray:
    """Luminance of linear Rec.709 from Daguerre's tables, shape (3,)."""
    return np.asarray(np.linalg.inv(rgb_from_xyz())[1])


def xyz_of(rgb: NDArray[np.float32]) -> NDArray[np.float32]:
    """Converts linear Rec.709 to CIE XYZ, shape (..., 3)."""
    return np.asarray(rgb @ np.linalg.inv(rgb_from_xyz()).T.astype(np.float32))


def _tables(nm: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """XYZ (L, 3) of unit radiance per nm at wavelengths, and radiances (L, 3) of RGB emitters."""
    rows = np.asarray(_core.colour_tables(np.asarray(nm, np.float64).tolist()))
    fine = np.asarray(_core.colour_tables(fine_wavelengths(1)[0].tolist()))
    step = (LAST_NM - FIRST_NM) / FINE
    luma = fine[:, 1].sum() * step
    white = (fine[:, 1] * fine[:, 3]).sum() * step / luma
    return rows[:, :3] / luma, rows[:, 3:4] / white * rows[:, 4:]


def fine_wavelengths(bands: int) -> FloatArray:
    """Wavelengths of fine sums by band, nm, shape (bands, n)."""
    whole(bands, "bands", 1, 1024)
    each = -(-FINE // bands)
    at = (np.arange(bands * each) + 0.5) / (bands * each)
    return (FIRST_NM + (LAST_NM - FIRST_NM) * at).reshape(bands, each)


@cache
def rgb_mixes(count: int) -> tuple[FloatArray, FloatArray]:
    """Returns the contribution of each wavelength to the RGB of RGB emitters.

    Args:
        count: Number of wavelengths, in equal steps from 400 to 700 nm.

    Returns:
        Wavelengths (L,), nm; and matrices from emitters (last axis) to their RGB at each
        wavelength, shape (L, 3, 3). They sum to the unit matrix, so colours are kept if all
        wavelengths are treated alike.
    """
    nm = 400 + 300 * (np.arange(count) + 0.5) / count
    seen, emitted = _tables(nm)
    mixes = np.einsum("jk,lk,li->lji", rgb_from_xyz(), seen, emitted)
    return nm, mixes @ np.linalg.inv(mixes.sum(axis=0))


@cache
def band_colors(bands: int) -> FloatArray:
    """XYZ of unit mean radiance in each band of a film, shape (bands, 3)."""
    return band_weights(bands, lambda nm: _tables(nm)[0])


def band_weights(bands: int, seen_at: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Observer's response to unit mean radiance in each band of a film, (bands, K).

    The weights are exact for D65 within each band. Then they are changed by the least amount that
    makes the spectra of RGB emitters, and so white, exact. So bands give the observer's own result
    for all mixtures of these spectra.

    Args:
        bands: Number of bands of equal width over all wavelengths.
        seen_at: Function that returns the observer's curves at wavelengths (L,), nm, shape (L, K),
            per unit radiance and nm.
    """
    nm = fine_wavelengths(bands)
    seen = seen_at(nm.ravel()).reshape(*nm.shape, -1)
    emitted = _tables(nm.ravel())[1].reshape(*nm.shape, 3)
    white = emitted.sum(axis=2)
    width = (LAST_NM - FIRST_NM) / bands
    weights = width * np.einsum("bnk,bn->bk", seen, white) / white.sum(axis=1)[:, None]
    means = emitted.mean(axis=1)  # means of the three spectra, by band
    exact = np.einsum("bnk,bni->ik", seen, emitted) * (width / nm.shape[1])
    freedom = weights.sum(axis=1)[:, None]  # changes go where the observer is most sensitive
    change = np.linalg.lstsq(means.T @ (freedom * means), exact - means.T @ weights, rcond=None)[0]
    return np.asarray(weights + freedom * (means @ change))


def unit_d65(nm: FloatArray) -> FloatArray:
    """D65 with luminance 1 at wavelengths, in the film's unit of radiance, shape (L,)."""
    return np.asarray(_tables(nm)[1].sum(axis=1))


def band_wavelengths(bands: int, each: int) -> FloatArray:
    """Representative wavelengths of bands, nm, shape (bands, each)."""
    at = (np.arange(bands * each) + 0.5) / (bands * each)
    return (FIRST_NM + (LAST_NM - FIRST_NM) * at).reshape(bands, each)


def rgb_of_emission(values_at: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Linear Rec.709 of emission by wavelength, shape (3,); 1 at all wavelengths has luminance 1.

    Args:
        values_at: Function that returns emission at wavelengths (L,), nm.
    """
    nm = fine_wavelengths(1)[0]
    step = (LAST_NM - FIRST_NM) / len(nm)
    return np.asarray(rgb_from_xyz() @ (values_at(nm) @ _tables(nm)[0]) * step)


def rgb_of_reflectance(values_at: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Linear Rec.709 of a reflectance by wavelength in light of D65, shape (3,).

    Args:
        values_at: Function that returns reflectances at wavelengths (L,), nm.
    """
    return rgb_of_emission(lambda nm: values_at(nm) * unit_d65(nm))
