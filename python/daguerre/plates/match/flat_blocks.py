"""Flat blocks of developed pictures, chosen by what is coarser than their noise.

Noise of developed pictures is not white, so its own low frequencies cannot be told from its high
ones. Blocks are judged by means of 8 x 8 px, in which little noise is left, and measured by all
that is finer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import Photograph, encoded

from .grain import SIDE
from .texture import roughness

FloatArray = NDArray[np.float64]
#: Blocks that are looked at, and those that must be flat.
_MOST, LEAST = 9000, 12
_BINS, _FLATTEST = 16, 0.2
#: Noise of flat blocks differs little; what has more than this times the low ones is texture.
_TEXTURE, _USUAL = 1.6, 0.1
#: Variance of means of 8 x 8 px over that of pixels: white noise has 1/64, grain of 4 px a quarter,
#: edges nearly 1.
_COARSE = 0.35
#: Noise changes slowly with level: a bin whose variance is so many times the next one's is texture.
_PEAK = 4.0
#: Deviation of numbers for screens that no camera's noise has; text and patterns do.
_LOUDEST = 0.12
#: Variance below which there is none.
_NOTHING = 1e-14
#: Median roughness of a level's blocks; of noise 0.6. Those that texture leaves are nearer to 1.
_SMOOTH = 0.72
_CELL = 8
#: Share of pixels at either end of the numbers that a channel of a block may have.
_CLIPPED = 0.15


@dataclass(frozen=True)
class FlatBlocks:
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
        """Those of some numbers."""
        return FlatBlocks(self.corner[chosen], self.level[chosen], self.variance[chosen])


def flat_blocks(photograph: Photograph) -> FlatBlocks | None:
    """The flat blocks of a developed picture; None: there are too few."""
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
    """Variance of rounding to whole numbers, which a file made of the noise adds again."""
    pixels = photograph.pixels
    assert pixels is not None
    if not np.issubdtype(pixels.dtype, np.integer):
        return 0.0
    return float(1 / 12 / np.iinfo(pixels.dtype).max ** 2)


def alike(variance: FloatArray) -> NDArray[np.bool_]:
    """Which variances are those of noise: near the lower ones, which texture does not have."""
    usual = np.quantile(variance, _USUAL)
    return np.asarray(variance <= _TEXTURE * max(float(usual), _NOTHING))


def _without_peaks(bins: list[NDArray[np.intp]], variance: FloatArray) -> list[NDArray[np.intp]]:
    """Bins of levels without those whose noise is far above the next ones': texture alone."""
    each = np.array([variance[part].mean() for part in bins])
    beside = np.minimum(np.r_[each[1:2], each[:-1]], np.r_[each[1:], each[-2:-1]])
    if len(each) < 3:
        return bins
    limit = _PEAK * np.maximum(beside, _NOTHING)
    return [part for part, own, most in zip(bins, each, limit, strict=True) if own <= most]


def _blocks(photograph: Photograph) -> tuple[FlatBlocks, FloatArray]:
    """Blocks all over the picture that are not clipped, and how much structure they have."""
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
    """Which blocks have hardly a pixel at either end of the numbers."""
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
