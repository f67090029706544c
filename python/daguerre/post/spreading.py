"""Spreads light, in bands of rows, by kernels or as a veil over the whole picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.convolution.convolve import Spread, convolve
from daguerre.convolution.rows import Rows

from .effect import Step
from .kernels import Floats
from .picture import Band, Canvas, Image, RowSource, bands

SCAN = 256  # rows


class Spreading(Step):
    """Spreads the colours of a picture; alpha is not changed.

    Args:
        canvas: Facts about the picture.
        spread: Convolution of its colours.
        stays: Share of the light that is added unspread; one number, or one by colour.
    """

    def __init__(
        self, canvas: Canvas, spread: Spread, stays: float | NDArray[np.float32] = 0.0
    ) -> None:
        self._colors = len(canvas.colors) - canvas.alpha
        self._spread, self._stays = spread, np.asarray(stays, np.float32)
        self.block, self.reach = spread.block, spread.reach

    def apply(self, band: Band, rows: Rows) -> Band:
        """Spreads the light of all rows that reach these."""
        light, here = band.image[:, :, : self._colors], band.cut(rows)
        made = self._spread.rows(light, band.rows.begin, rows)
        if self._stays.any():
            made += here.image[:, :, : self._colors] * self._stays
        return here.with_image(np.concatenate([made, here.image[:, :, self._colors :]], axis=2))


class Veil(Step):
    """Spreads a share of the light over the whole picture, by a kernel for a reduced picture.

    Args:
        canvas: Facts about the picture.
        kernel: Kernel for the reduced picture.
        factor: Reduction factor.
        share: Share of the light to spread.
    """

    def __init__(self, canvas: Canvas, kernel: Floats, factor: int, share: float) -> None:
        self._colors = len(canvas.colors) - canvas.alpha
        self._kernel, self._factor, self._share = kernel, factor, np.float32(share)

    def prepare(self, source: RowSource) -> None:
        """Computes the veil from a reduced picture of all rows."""
        height = max(SCAN // self._factor, 1) * self._factor
        found = [
            reduced(band.image[:, :, : self._colors], self._factor)
            for band in bands(source, height)
        ]
        self._veil = convolve(np.concatenate(found), self._kernel)

    def apply(self, band: Band, rows: Rows) -> Band:
        """Blends the veil in; NaN pixels are not changed."""
        light = band.image[:, :, : self._colors]
        veil = enlarged(self._veil, self._factor, rows, light.shape[1])
        finite = np.isfinite(light)
        known = np.where(finite, light, np.float32(0))
        made = np.where(finite, known + self._share * (veil - known), light)
        return band.with_image(np.concatenate([made, band.image[:, :, self._colors :]], axis=2))


def reduced(light: Image, factor: int) -> Image:
    """Means over squares of pixels; beyond its edges the picture is black."""
    finite = np.where(np.isfinite(light), light, np.float32(0))
    pad = [(0, -n % factor) for n in light.shape[:2]]
    padded = np.pad(finite, [*pad, (0, 0)])
    rows, columns = (n // factor for n in padded.shape[:2])
    means = padded.reshape(rows, factor, columns, factor, -1).mean(axis=(1, 3))
    return np.asarray(means, np.float32)


def enlarged(small: Image, factor: int, rows: Rows, width: int) -> Image:
    """Rows of the full picture, linear between the centres of squares."""
    for axis, wanted in enumerate((np.arange(*rows), np.arange(width))):
        at = (wanted + 0.5) / factor - 0.5
        low = np.clip(np.floor(at).astype(int), 0, small.shape[axis] - 1)
        high = np.minimum(low + 1, small.shape[axis] - 1)
        t = np.clip(at - low, 0, 1).astype(np.float32)
        t = t.reshape([-1, 1, 1] if axis == 0 else [1, -1, 1])
        small = small.take(low, axis) * (1 - t) + small.take(high, axis) * t
    return np.asarray(small, np.float32)
