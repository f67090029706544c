"""Tabulated curves by wavelength."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.argument_checks import guarded
from daguerre.errors import InputError
from daguerre.files.value import BriefRecord, Value

FloatArray = NDArray[np.float64]


@guarded
@dataclass(frozen=True, eq=False, repr=False)
class Curve(Value, BriefRecord):
    """A transmittance by wavelength, interpolated linearly, constant beyond its ends.

    Attributes:
        wavelengths: Wavelengths in ascending order, nm, shape (L,).
        values: Transmittance, 0 to 1, shape (L,).
    """

    wavelengths: FloatArray
    values: FloatArray

    def at(self, nm: FloatArray) -> FloatArray:
        """Returns the transmittance at wavelengths, nm."""
        return np.interp(np.asarray(nm, np.float64), self.wavelengths, self.values)


def table(where: str, wavelengths: Any, values: Any, most: float = 1.0) -> FloatArray:
    """Checks a table: numbers of 0 to ``most`` for each wavelength along the last axis.

    Raises:
        InputError: A number is missing or out of range; the message has its wavelength.
    """
    try:
        numbers = np.array(values, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{where}: all channels must have the same number of values") from None
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


def rising(where: str, wavelengths: object) -> FloatArray:
    """Checks that there are at least two wavelengths, nm, in ascending order.

    Raises:
        InputError: There are fewer, or they do not ascend.
    """
    try:
        nm = np.array(wavelengths, np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{where}: wanted a list of wavelengths in nm") from None
    if nm.ndim != 1 or nm.size < 2 or not np.isfinite(nm).all() or (np.diff(nm) <= 0).any():
        raise InputError(f"{where}: wanted at least two wavelengths in nm in ascending order")
    nm.flags.writeable = False
    return nm
