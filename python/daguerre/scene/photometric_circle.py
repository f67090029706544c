"""Photometric tables over the whole circle, from the part of it that a symmetric one gives.

Source: IES LM-63-2019, horizontal angles of type C: 0 alone (the same all around), 0 .. 90 (the
same in each quadrant), 0 .. 180 and 90 .. 270 (the same on both sides of a plane), 0 .. 360.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

FloatArray = NDArray[np.float64]


def whole_circle(
    phi_deg: FloatArray, values: FloatArray, where: str
) -> tuple[FloatArray, FloatArray]:
    """Completes a table by its symmetry.

    Args:
        phi_deg: Horizontal angles, rising, shape (P,), degrees.
        values: Values, shape (T, P).
        where: Place for messages.

    Returns:
        Angles from 0 to 360, shape (Q,), or 0 alone, and values of shape (T, Q).

    Raises:
        InputError: The range of the angles is none of LM-63.
    """
    first, last = float(phi_deg[0]), float(phi_deg[-1])
    if len(phi_deg) == 1:
        return np.zeros(1), values
    if (first, last) == (0, 90):
        phi_deg, values = _mirrored(phi_deg, values)
        last = 180.0
    if (first, last) == (0, 180):
        return _mirrored(phi_deg, values)
    if (first, last) == (90, 270):
        return _from_zero(*_mirrored(phi_deg, values))
    if first == 0 and 180 < last < 360:  # the step that closes the circle is left out
        return np.append(phi_deg, 360.0), np.concatenate([values, values[:, :1]], axis=1)
    if (first, last) != (0, 360):
        raise InputError(
            f"{where}: wanted a range of 0, 0 .. 90, 0 .. 180, 90 .. 270 or 0 .. 360 degrees, "
            f"got {first:g} .. {last:g}"
        )
    return phi_deg, values


def _mirrored(phi: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Continues a table by its mirror image about the last angle."""
    return (
        np.concatenate([phi, 2 * phi[-1] - phi[-2::-1]]),
        np.concatenate([values, values[:, -2::-1]], axis=1),
    )


def _from_zero(phi: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Turns angles of 90 .. 450 to 0 .. 360; a knot is made at 0, where none has to be."""
    at_zero = np.stack([np.interp(360.0, phi, row) for row in values])[:, None]
    after, before = phi > 360, phi < 360
    return (
        np.concatenate([[0.0], phi[after] - 360, phi[1:][before[1:]], [360.0]]),
        np.concatenate([at_zero, values[:, after], values[:, 1:][:, before[1:]], at_zero], axis=1),
    )
