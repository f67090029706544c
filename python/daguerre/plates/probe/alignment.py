"""Photographs of one view that do not lie on each other, or not in the order of their exposures.

Bitmaps of what is above the median are alike at any exposure (Ward, Fast, Robust Image Registration
for Compositing High Dynamic Range Photographs from Handheld Exposures, J. Graphics Tools 8, 2003);
their shift is where their correlation is highest.
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
#: Shares of saturation between which a pixel tells something.
_LOW, _HIGH = 0.04, 0.95


def check_aligned(shots: list[Shot], stops: tuple[float, ...]) -> None:
    """Refuses photographs that are shifted, or whose exposures contradict their brightness.

    Raises:
        InputError: The message names two files, and the shift in px.
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
            f"{light.path}: exposure: wanted a picture brighter than {dark.path}, which got "
            f"{stops:.1f} EV less; it is darker. Are --ev or EXIF right?"
        )
    shift = _shift(_bitmap(a, told), _bitmap(b, told)) * step
    if np.abs(shift).max() > max(2, 0.002 * max(dark.size)):
        raise InputError(
            f"{light.path}: wanted the view of {dark.path}; it is shifted by "
            f"{shift[0]:.0f}, {shift[1]:.0f} px: align them first"
        )


def _green(shot: Shot) -> NDArray[np.float32]:
    full = shot.full[1]
    if not math.isfinite(full):
        full = float(shot.numbers[..., 1].max()) or 1.0
    return np.asarray(shot.numbers[..., 1] / np.float32(full))


def _bitmap(picture: NDArray[np.float32], told: NDArray[np.bool_]) -> FloatArray:
    """+1 above the median, -1 below, 0 where nothing is told."""
    return np.where(told, np.where(picture > np.median(picture[told]), 1.0, -1.0), 0.0)


def _shift(a: FloatArray, b: FloatArray) -> NDArray[np.int64]:
    """Shift of b against a, px in x and y; none where correlation tells nothing."""
    one, other = np.fft.rfft2(a), np.fft.rfft2(b)
    found = np.fft.irfft2(np.conj(one) * other, s=a.shape)
    row, column = np.unravel_index(int(found.argmax()), found.shape)
    if found[row, column] < 1.02 * found[0, 0]:
        return np.zeros(2, np.int64)
    rows, columns = a.shape
    return np.array([(column + columns // 2) % columns - columns // 2,
                     (row + rows // 2) % rows - rows // 2])  # fmt: skip
