"""A number by wavelength, as a table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.doors import guarded
from daguerre.errors import InputError
from daguerre.files.value import Value

FloatArray = NDArray[np.float64]


@guarded
@dataclass(frozen=True, eq=False)
class Curve(Value):
    """A transmittance by wavelength, linear in between, and beyond its ends as there.

    Attributes:
        wavelengths: nm, rising, shape (L,).
        values: 0 to 1, shape (L,).
    """

    wavelengths: FloatArray
    values: FloatArray

    def at(self, nm: FloatArray) -> FloatArray:
        """At other wavelengths, nm."""
        return np.interp(np.asarray(nm, np.float64), self.wavelengths, self.values)


def table(where: str, wavelengths: Any, values: Any, most: float = 1.0) -> FloatArray:
    """Numbers of 0 to ``most``, one for each wavelength along the last axis.

    Raises:
        InputError: They are not that; the message says which.
    """
    try:
        numbers = np.array(values, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{where}: wanted numbers of equal count for each channel") from None
    count = len(wavelengths)
    if numbers.ndim == 0 or numbers.shape[-1] != count:
        got = numbers.shape[-1] if numbers.ndim else "one number"
        raise InputError(f"{where}: wanted {count} numbers, one for each wavelength, got {got}")
    bad = np.argwhere(~((numbers >= 0) & (numbers <= most)))
    if len(bad):
        at = tuple(bad[0])
        raise InputError(
            f"{where}: wanted 0 to {most:g}, got {numbers[at]:g} at {wavelengths[at[-1]]:g} nm"
        )
    numbers.flags.writeable = False
    return numbers


def rising(where: str, wavelengths: Any) -> FloatArray:
    """At least two wavelengths, nm, each above the one before.

    Raises:
        InputError: They are not that.
    """
    try:
        nm = np.array(wavelengths, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{where}: wanted a list of wavelengths, nm") from None
    if nm.ndim != 1 or nm.size < 2 or not np.isfinite(nm).all() or (np.diff(nm) <= 0).any():
        raise InputError(f"{where}: wanted at least two wavelengths in nm that rise")
    nm.flags.writeable = False
    return nm
