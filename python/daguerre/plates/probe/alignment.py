"""Checks that photographs of one view are aligned and that their exposures fit their brightness.

Bitmaps of pixels above the median are alike at any exposure (Ward, Fast, Robust Image Registration
for Compositing High Dynamic Range Photographs from Handheld Exposures, J. Graphics Tools 8, 2003).
The peak of their correlation gives the shift.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError

from .latlong import FloatArray
from .shots import Shot

_SIZE = 1024
#: Shares of saturation between which a pixel is used.
_LOW, _HIGH = 0.04, 0.95


def check_aligned(shots: list[Shot], stops: tuple[float, ...]) -> None:
    """Checks that photographs are not shifted, and that exposures fit their brightness.

    Raises:
        InputError: A pair does not fit; the message has both files, and the shift in px.
    """
    order = sorted(range(len(shots)), key=lambda i: stops[i])
    for dark, light in itertools.pairwise(order):
        _check_pair(shots[dark], shots[light], stops[light] - stops[dark])


def _check_pair(dark: Shot, light: Shot, stops: float) -> None:
    step = math.ceil(max(dark.size) / _SIZE)
    a, b = (_green(shot)[::step, ::step] for shot in (dark, light))
    told = (a > _LOW) & (b > _LOW) & (a < _HIGH) & (b < _HIGH)
    if told.mean() < 0.02:
        return
    ratio = float(np.median(b[told] / a[told]))
    if stops > 0.5 and ratio < 0.95:
        raise InputError(
            f"{light.path}: exposure: wanted a picture brighter than {dark.path} by {stops:.1f} EV "
            "of exposure, got a darker one; check --ev or EXIF"
        )
    shift = _shift(_bitmap(a, told), _bitmap(b, told)) * step
    if np.abs(shift).max() > max(2, 0.002 * max(dark.size)):
        raise InputError(
            f"{light.path}: wanted the same view as {dark.path}, got one shifted by "
            f"{shift[0]:.0f}, {shift[1]:.0f} px; align the photographs first"
        )


def _green(shot: Shot) -> NDArray[np.float32]:
    full = shot.full[1]
    if not math.isfinite(full):
        full = float(shot.numbers[..., 1].max()) or 1.0
    return np.asarray(shot.numbers[..., 1] / np.float32(full))


def _bitmap(picture: NDArray[np.float32], told: NDArray[np.bool_]) -> FloatArray:
    """+1 above the median, -1 below, 0 where the pixel is not used."""
    return np.where(told, np.where(picture > np.median(picture[told]), 1.0, -1.0), 0.0)


def _shift(a: FloatArray, b: FloatArray) -> NDArray[np.int64]:
    """Shift of b against a, px in x and y; 0 where the correlation has no clear peak."""
    one, other = np.fft.rfft2(a), np.fft.rfft2(b)
    found = np.fft.irfft2(np.conj(one) * other, s=a.shape)
    row, column = np.unravel_index(int(found.argmax()), found.shape)
    if found[row, column] < 1.02 * found[0, 0]:
        return np.zeros(2, np.int64)
    rows, columns = a.shape
    return np.array([(column + columns // 2) % columns - columns // 2,
                     (row + rows // 2) % rows - rows // 2])  # fmt: skip
