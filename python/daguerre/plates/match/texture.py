"""Detects texture too fine for the selection of flat blocks: fabric, floors, leaves, bricks.

Noise has a smooth spectrum and is uniform over a block. Regular texture has lines in its spectrum.
Leaves, bricks and text are rough in one corner and smooth in another. Blocks with either sign are
not flat, even if their coarse structure is weak.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import Photograph, encoded

from .blocks import cosines
from .grain import FOLDED, SIDE

Floats = NDArray[np.float32]
#: Ratio of the power of 3 x 3 frequencies to the 72 around them that 1 % of noise blocks exceed.
_LINE = 6.5
#: Share of the mean power added to the power around a line: zeros of JPEG must not make lines.
_FLOOR = np.float32(0.02)
#: Largest relative deviation of the variances of a block's 16 cells; sensor noise has 0.2 to 0.4.
#: JPEG makes cells unequal, so the limit grows with the share of zero cosines above _ZEROS.
_UNEVEN, _UNEVEN_ZEROS, _ZEROS = 0.45, 2.2, 0.55
#: Cosines below this many standard deviations of rounding count as zero.
_ZERO = 2.4
_CELL, _SMOOTH = 8, 5
#: Least variance over the variance of rounding: below it, blocks have too few distinct values.
_FEW = 4.0
_AT_ONCE = 512
#: Frequencies to judge, without coarse structure and the mosaic's pattern of two pixels.
_JUDGED = (
    (FOLDED[:, None] < SIDE // 2 - 1)
    & (FOLDED < SIDE // 2 - 1)
    & (np.hypot(FOLDED[:, None], FOLDED) > 3)
)


def roughness(
    photograph: Photograph, corner: NDArray[np.intp], rounding: float
) -> NDArray[np.float32]:
    """Measures the texture of blocks.

    Args:
        photograph: A developed picture.
        corner: Upper left pixels of blocks, y and x, shape (N, 2).
        rounding: Variance of rounding to whole numbers.

    Returns:
        float32, shape (N,): about 0.6 for noise (1 block in 50 exceeds 1); 0 for blocks with
        hardly any value but the mean.
    """
    found = [np.zeros(0, np.float32)]
    for light in _greys(photograph, corner):
        variance = np.square(light).mean(axis=(1, 2))
        zeros = np.maximum(_zeros(light, np.sqrt(rounding)) - _ZEROS, 0)
        uneven = _unevenness(light) / (_UNEVEN + _UNEVEN_ZEROS * zeros)
        rough = np.maximum(uneven, _line(light) / _LINE)
        found.append(np.where(variance > _FEW * rounding, rough, 0).astype(np.float32))
    return np.concatenate(found)


def _greys(photograph: Photograph, corner: NDArray[np.intp]) -> Iterator[Floats]:
    """Yields means of channels without their planes, some hundred blocks at once, (n, 32, 32)."""
    pixels = photograph.pixels
    assert pixels is not None
    for at in range(0, len(corner), _AT_ONCE):
        blocks = [pixels[y : y + SIDE, x : x + SIDE] for y, x in corner[at : at + _AT_ONCE]]
        yield _without_planes(encoded(np.stack(blocks)).mean(axis=3))


def _without_planes(light: Floats) -> Floats:
    ramp = (np.arange(SIDE) - (SIDE - 1) / 2).astype(np.float32)
    unit = np.float32(np.square(ramp).sum() * SIDE)
    rest = light - light.mean(axis=(1, 2), keepdims=True)
    down = (rest.sum(axis=2) @ ramp / unit)[:, None, None] * ramp[:, None]
    across = (rest.sum(axis=1) @ ramp / unit)[:, None, None] * ramp
    return np.asarray(rest - down - across, np.float32)


def _line(light: Floats) -> Floats:
    """Power of the strongest line of a block's spectrum over its surroundings, shape (n,)."""
    window = np.hanning(SIDE + 1)[:SIDE].astype(np.float32)
    waves = np.fft.fft2(light * window[:, None] * window)
    power = np.asarray(np.square(waves.real) + np.square(waves.imag), np.float32)
    inner, outer = _averaged(power, _ring(3)), _averaged(power, _ring(9))
    around = (81 * outer - 9 * inner) / 72
    floor = _FLOOR * power.mean(axis=(1, 2)) + np.finfo(np.float32).tiny
    ratio = (inner / (around + floor[:, None, None]))[:, _JUDGED]
    return np.asarray(ratio.max(axis=1), np.float32)


def _zeros(light: Floats, rounding: float) -> Floats:
    """Share of JPEG's cosines of 8 x 8 px that are about zero, shape (n,)."""
    cells = SIDE // _CELL
    basis = np.kron(np.eye(cells, dtype=np.float32), cosines(_CELL))
    return np.asarray((np.abs(basis @ light @ basis.T) < _ZERO * rounding).mean(axis=(1, 2)))


def _unevenness(light: Floats) -> Floats:
    """Relative deviation of the cells' variances of detail finer than 5 px, shape (n,)."""
    fine = light - _averaged(light, _row(_SMOOTH))
    cells = SIDE // _CELL
    squares = np.square(fine).reshape(-1, cells, _CELL, cells, _CELL).mean(axis=(2, 4))
    squares = squares.reshape(-1, cells * cells)
    mean = np.maximum(squares.mean(axis=1), np.finfo(np.float32).tiny)
    return np.asarray(squares.std(axis=1, ddof=1) / mean, np.float32)


def _averaged(blocks: Floats, mean: Floats) -> Floats:
    """Averages along rows and columns by the same matrix."""
    return np.asarray(mean @ blocks @ mean.T, np.float32)


def _ring(width: int) -> Floats:
    """Matrix of means over ``width`` neighbours; the ends wrap around."""
    apart = np.abs(np.subtract.outer(np.arange(SIDE), np.arange(SIDE)))
    near = np.minimum(apart, SIDE - apart) <= width // 2
    return np.asarray(near / np.float32(width), np.float32)


def _row(width: int) -> Floats:
    """Matrix of means over ``width`` neighbours; the end values continue."""
    at = np.clip(np.add.outer(np.arange(SIDE), np.arange(width) - width // 2), 0, SIDE - 1)
    found = np.zeros((SIDE, SIDE), np.float32)
    np.add.at(found, (np.arange(SIDE)[:, None], at), np.float32(1 / width))
    return found
