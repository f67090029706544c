"""Sampled spectra, for quantities measured by wavelength."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from daguerre.checks import short, to_numbers
from daguerre.errors import InputError

#: Largest number of samples.
MOST_SAMPLES = 4096


@dataclass(frozen=True)
class Spectrum:
    """A value by wavelength: linear between samples, constant beyond the ends.

    Attributes:
        wavelengths_nm: Wavelengths of the samples, nm, rising; 1 to 4096 of them.
        values: Values there, of at least 0.

    Raises:
        InputError: The samples are invalid.
    """

    wavelengths_nm: tuple[float, ...]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        nm, values = _row(self.wavelengths_nm, "wavelengths_nm"), _row(self.values, "values")
        if not 1 <= len(nm) <= MOST_SAMPLES:
            raise InputError(
                f"spectrum: wavelengths_nm: wanted 1 to {MOST_SAMPLES} numbers, got {len(nm)}"
            )
        if len(values) != len(nm):
            raise InputError(f"spectrum: values: wanted {len(nm)} numbers, got {len(values)}")
        if not (nm[0] > 0 and (np.diff(nm) > 0).all()):
            raise InputError("spectrum: wavelengths_nm: must increase and be above 0")
        if values.min() < 0:
            raise InputError(f"spectrum: values: wanted at least 0, got {values.min():g}")
        object.__setattr__(self, "wavelengths_nm", tuple(nm.tolist()))
        object.__setattr__(self, "values", tuple(values.tolist()))

    def at(self, wavelengths_nm: ArrayLike) -> NDArray[np.float64]:
        """Values at wavelengths in nm, of any shape."""
        nm = to_numbers(wavelengths_nm, "spectrum", "wavelengths_nm", "numbers").astype(float)
        return np.asarray(np.interp(nm, self.wavelengths_nm, self.values))

    def __repr__(self) -> str:
        """Shows only the range, as a measured spectrum has many samples."""
        ends = f"{self.wavelengths_nm[0]:g}..{self.wavelengths_nm[-1]:g} nm"
        return f"Spectrum({len(self.values)} samples, {ends})"


def _row(given: ArrayLike, what: str) -> NDArray[np.float64]:
    """Checks finite numbers, shape (N,)."""
    row = to_numbers(given, "spectrum", what, "a row of numbers").astype(np.float64)
    if row.ndim != 1 or not np.isfinite(row).all():
        raise InputError(f"spectrum: {what}: wanted a row of finite numbers, got {short(given)}")
    return row
