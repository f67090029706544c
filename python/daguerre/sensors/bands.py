"""Wavelength bands of a frame, and the weights that convert them to a sensor's channels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import whole
from daguerre.color.spectra import (
    FINE,
    FIRST_NM,
    LAST_NM,
    band_weights,
    fine_wavelengths,
    unit_d65,
)
from daguerre.errors import InputError

if TYPE_CHECKING:
    from .fit import Seeing


FloatArray = NDArray[np.float64]


LEAST_BANDS, MOST_BANDS = 3, 64


MOST_CHANNELS = 4


def check_bands(value: object, where: str = "bands") -> int:
    """Checks a number of bands; 0: none."""
    if value is None or (isinstance(value, int) and value == 0):
        return 0
    return whole(value, where, LEAST_BANDS, MOST_BANDS, f"{LEAST_BANDS} .. {MOST_BANDS}")


def responses(sensor: Seeing) -> FloatArray:
    """Response of each channel at 380, 381 .. 780 nm, per nm, shape (C, 401).

    Raises:
        InputError: There are more channels than a film can hold, or one has no sensitivity.
    """
    nm = np.arange(FIRST_NM, LAST_NM + 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        rows = sensor.sensitivity(nm)
    if len(rows) > MOST_CHANNELS:
        raise InputError(f"sensor: channels: wanted at most {MOST_CHANNELS}, got {len(rows)}")
    fine = fine_wavelengths(1)[0]
    white = unit_d65(fine) * ((LAST_NM - FIRST_NM) / FINE)
    totals = np.array([np.interp(fine, nm, row) @ white for row in rows])
    if not (totals > 0).all():
        raise InputError(
            f"sensor: channel {np.flatnonzero(~(totals > 0))[0]}: no sensitivity "
            f"between {FIRST_NM:g} and {LAST_NM:g} nm"
        )
    return np.ascontiguousarray(rows / totals[:, None])


def weights_of_bands(sensor: Seeing, bands: int) -> FloatArray:
    """Channel values for unit mean radiance in each band, shape (bands, C)."""
    nm = np.arange(FIRST_NM, LAST_NM + 1)
    rows = responses(sensor)
    return band_weights(bands, lambda at: np.stack([np.interp(at, nm, r) for r in rows], axis=1))
