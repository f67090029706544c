"""White balance: finds the white that becomes neutral."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import illuminants
from daguerre.errors import UsageError

from .channels import XY, Channels

FloatArray = NDArray[np.float64]
_BLOCK = 8  # px, of means that "auto" looks at: edges have colours that demosaicing made


def white_of(source: Channels, wanted: object) -> XY:
    """Returns the chromaticity of the white.

    Args:
        source: Channels of the picture.
        wanted: None or "as-shot"; "auto"; K; (x, y); also as text, "5600", "0.34,0.35".

    Raises:
        UsageError: ``wanted`` is none of these.
    """
    if wanted is None or (isinstance(wanted, str) and wanted == "as-shot"):
        return source.as_shot
    if isinstance(wanted, str) and wanted == "auto":
        return _average(source)
    return illuminants.white_xy(numbers_of(wanted), "develop: wb")


def numbers_of(wanted: object) -> Any:
    """Parses K or (x, y) from text; returns other values unchanged."""
    if not isinstance(wanted, str):
        return wanted
    try:
        values = [float(part) for part in wanted.lower().removesuffix("k").split(",")]
    except ValueError:
        values = []
    if len(values) not in (1, 2):
        raise UsageError(
            f"develop: wb: wanted as-shot, auto, a temperature in K such as 5600, or x,y such as "
            f"0.3457,0.3585; got {wanted!r}"
        )
    return values[0] if len(values) == 1 else tuple(values)


def _block_means(pixels: NDArray[Any]) -> FloatArray:
    """Mean colours of blocks, or of pixels in a small picture, shape (N, 3)."""
    height, width = pixels.shape[:2]
    size = _BLOCK if min(height, width) >= _BLOCK else 1
    rows, columns = height // size, width // size
    blocks = pixels[: rows * size, : columns * size].reshape(rows, size, columns, size, 3)
    means = blocks.mean(axis=(1, 3), dtype=np.float32)
    return np.asarray(means.reshape(-1, 3), np.float64)


def _average(source: Channels) -> XY:
    """Colour of the brighter unsaturated part, which is usually white or grey.

    Common choices are the mean of the picture (grey world) and the mean of its brightest tenth
    (white patch). A power mean is between them (Finlayson and Trezzi 2004, Shades of gray, power
    6).
    """
    means = _block_means(source.pixels)
    good = np.isfinite(means).all(axis=1) & (means < 0.95 * source.full).all(axis=1)
    values = np.maximum(means[good] / source.unit, 0)
    if not values.size or values.max() <= 0:
        return source.as_shot
    top = values.max()
    mean = top * np.mean((values / top) ** 6, axis=0) ** (1 / 6)
    white = source.as_shot
    for _ in range(4):  # iterate: the matrix depends on the white that is sought
        xyz = source.xyz_from(white) @ mean
        x, y = xyz[:2] / xyz.sum()
        if not (0.15 < x < 0.65 and 0.15 < y < 0.65 and math.isfinite(x + y)):
            return source.as_shot
        white = (float(x), float(y))
    return white
