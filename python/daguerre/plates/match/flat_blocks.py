"""Finds flat blocks of developed pictures, by structure that is coarser than their noise.

Noise of developed pictures is not white, so its low frequencies do not follow from its high
frequencies. Blocks are selected by means of 8 x 8 px, which have little noise left, and measured by
their variance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files.value import BriefRecord
from daguerre.plates.photograph import Photograph, encoded

from .grain import SIDE
from .texture import roughness

FloatArray = NDArray[np.float64]
#: Approximate number of blocks to examine, and least number of flat blocks.
_MOST, LEAST = 9000, 12
_BINS, _FLATTEST = 16, 0.2
#: Variances above this multiple of a low quantile are texture: variances of noise differ little.
_TEXTURE, _USUAL = 1.6, 0.1
#: Largest variance of means of 8 x 8 px over that of pixels: white noise has 1/64, grain of 4 px
#: 1/4, edges nearly 1.
_COARSE = 0.35
#: A bin with this multiple of its neighbours' variance is texture: noise changes slowly with level.
_PEAK = 4.0
#: Display-encoded deviation above the noise of any camera, as text and patterns have.
_LOUDEST = 0.12
#: Variance that counts as 0.
_NOTHING = 1e-14
#: Largest median roughness of a level's blocks: noise has 0.6, remaining texture nearly 1.
_SMOOTH = 0.72
_CELL = 8
#: Largest share of pixels of a channel at either end of the range.
_CLIPPED = 0.15


@dataclass(frozen=True, repr=False)
class FlatBlocks(BriefRecord):
    """Flat blocks.

    Attributes:
        corner: Upper left pixel, y and x, shape (N, 2).
        level: Mean of each channel, shape (N, 3).
        variance: Variance about the plane through the block, shape (N, 3).
    """

    corner: NDArray[np.intp]
    level: FloatArray
    variance: FloatArray

    def only(self, chosen: NDArray[np.intp]) -> FlatBlocks:
        """Selects blocks by index."""
        return FlatBlocks(self.corner[chosen], self.level[chosen], self.variance[chosen])


def flat_blocks(photograph: Photograph) -> FlatBlocks | None:
    """Finds the flat blocks of a developed picture; None: there are too few."""
    blocks, structure = _blocks(photograph)
    variance = blocks.variance.mean(axis=1)
    small = structure <= _COARSE * np.maximum(variance, _NOTHING)
    if photograph.kind == "display":
        small &= variance < _LOUDEST**2
    grainy = np.flatnonzero(small)
    rough = np.ones(len(variance), np.float32)
    rough[grainy] = roughness(photograph, blocks.corner[grainy], rounding(photograph))
    grainy = grainy[rough[grainy] < 1]
    order = grainy[np.argsort(blocks.level[grainy].mean(axis=1))]
    if len(order) < LEAST:
        return None
    found = []
    for part in np.array_split(order, max(min(_BINS, len(order) // LEAST), 1)):
        count = max(int(_FLATTEST * len(part)), min(LEAST, len(part)))
        flattest = part[np.argsort(structure[part])[:count]]
        flattest = flattest[alike(variance[flattest])]
        if np.median(rough[flattest]) < _SMOOTH:
            found.append(flattest)
    if not found:
        return None
    kept = np.concatenate(_without_peaks(found, variance))
    return blocks.only(kept) if len(kept) >= LEAST else None


def rounding(photograph: Photograph) -> float:
    """Variance of rounding to integers, which a new file adds again."""
    pixels = photograph.pixels
    assert pixels is not None
    if not np.issubdtype(pixels.dtype, np.integer):
        return 0.0
    return float(1 / 12 / np.iinfo(pixels.dtype).max ** 2)


def alike(variance: FloatArray) -> NDArray[np.bool_]:
    """Mask of variances near the lowest, which are of noise rather than texture."""
    usual = np.quantile(variance, _USUAL)
    return np.asarray(variance <= _TEXTURE * max(float(usual), _NOTHING))


def _without_peaks(bins: list[NDArray[np.intp]], variance: FloatArray) -> list[NDArray[np.intp]]:
    """Bins of levels without those far above their neighbours, which have only texture."""
    each = np.array([variance[part].mean() for part in bins])
    beside = np.minimum(np.r_[each[1:2], each[:-1]], np.r_[each[1:], each[-2:-1]])
    if len(each) < 3:
        return bins
    limit = _PEAK * np.maximum(beside, _NOTHING)
    return [part for part, own, most in zip(bins, each, limit, strict=True) if own <= most]


def _blocks(photograph: Photograph) -> tuple[FlatBlocks, FloatArray]:
    """Unclipped blocks all over the picture, and the variance of their coarse structure."""
    pixels = photograph.pixels
    assert pixels is not None
    rows, columns = (side // SIDE for side in pixels.shape[:2])
    every = max(rows * columns // _MOST, 1)
    corners, levels, variances, structures = [], [], [], []
    for i in range(0, rows, every):
        strip = pixels[i * SIDE : (i + 1) * SIDE, : columns * SIDE]
        blocks = strip.reshape(SIDE, columns, SIDE, 3).swapaxes(0, 1)
        inside = _inside(blocks)
        light = encoded(blocks[inside])
        mean, variance, structure = _moments(light)
        corners.append(
            np.stack([np.full(inside.sum(), i * SIDE), np.flatnonzero(inside) * SIDE], 1)
        )
        levels.append(mean)
        variances.append(variance)
        structures.append(structure)
    if not corners:
        return FlatBlocks(np.zeros((0, 2), np.intp), np.zeros((0, 3)), np.zeros((0, 3))), np.zeros(
            0
        )
    made = FlatBlocks(*(np.concatenate(part) for part in (corners, levels, variances)))
    return made, np.concatenate(structures)


def _inside(blocks: NDArray[Any]) -> NDArray[np.bool_]:
    """Mask of blocks with few pixels at either end of the range."""
    if not np.issubdtype(blocks.dtype, np.integer):
        return np.asarray(blocks.max(axis=(1, 2, 3)) > 0)
    ends = (blocks == 0) | (blocks == np.iinfo(blocks.dtype).max)
    return np.asarray(ends.mean(axis=(1, 2)).max(axis=1) < _CLIPPED)


def _moments(light: NDArray[np.float32]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean and variance of blocks, (N, 3) each, and the largest structure of a channel, (N,)."""
    count = len(light)
    mean = light.mean(axis=(1, 2), dtype=np.float64)
    rest = light - mean[:, None, None].astype(np.float32)
    ramp = (np.arange(SIDE) - (SIDE - 1) / 2).astype(np.float32)
    unit = float(np.square(ramp).sum() * SIDE)
    down = np.einsum("nyxc,y->nc", rest, ramp) / unit
    across = np.einsum("nyxc,x->nc", rest, ramp) / unit
    slopes = np.square(down) + np.square(across)
    total = np.einsum("nyxc,nyxc->nc", rest, rest).astype(np.float64)
    variance = np.maximum(total - unit * slopes, 0) / (SIDE**2 - 3)
    cells = SIDE // _CELL
    coarse = rest.reshape(count, cells, _CELL, cells, _CELL, 3).mean(axis=(2, 4))
    step = (np.arange(cells) - (cells - 1) / 2) * _CELL
    coarse -= (down[:, None] * step[:, None]).astype(np.float32)[:, :, None]
    coarse -= (across[:, None] * step[:, None]).astype(np.float32)[:, None]
    return mean, variance, np.square(coarse, dtype=np.float64).mean(axis=(1, 2)).max(axis=1)
