"""Cuts parts of a photograph as one plane of light, to find and measure edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import Photograph, RawNumbers

Floats = NDArray[np.float32]
#: Half the side of a measured region, px.
HALF = 28


def overview(photograph: Photograph) -> tuple[Floats, int]:
    """Reduces the picture to one plane; returns it and the side of its pixels, px."""
    if photograph.raw is not None:
        # Each square of 3 x 3 of X-Trans has the same number of each channel.
        side = {1: 2, 6: 3}.get(len(photograph.raw.cells), len(photograph.raw.cells))
        return _cell_means(photograph.raw, side), side
    assert photograph.pixels is not None
    green = photograph.pixels[:, :, 1]
    height, width = (side // 2 * 2 for side in green.shape)
    four = [green[i:height:2, j:width:2].astype(np.float32) for i in (0, 1) for j in (0, 1)]
    return np.asarray((four[0] + four[1] + four[2] + four[3]) / 4, np.float32), 2


def _cell_means(raw: RawNumbers, side: int) -> Floats:
    """Means of squares of ``side`` photosites, each with the same share of channels."""
    height, width = (length // side * side for length in raw.mosaic.shape)
    total = np.zeros((height // side, width // side), np.float32)
    for i in range(side):
        for j in range(side):
            total += raw.mosaic[i:height:side, j:width:side]
    total /= side**2
    return total


def centred(photograph: Photograph, y: int, x: int) -> Floats | None:
    """Light around an edge near a place, shape (2 HALF, 2 HALF); None: not usable.

    An edge off the centre would lose its tails on one side.
    """
    part = region(photograph, y, x)
    if part is None:
        return None
    move = _middle(part) - HALF
    y, x = (int(at + step) for at, step in zip((y, x), np.rint(move), strict=True))
    return part if (np.abs(move) < 2).all() else region(photograph, y, x)


def _middle(part: Floats) -> NDArray[np.float64]:
    """Centre of the strongest gradients, y and x."""
    cells = part.reshape(HALF, 2, HALF, 2).mean(axis=(1, 3))
    down, across = np.gradient(cells)
    energy = np.square(down) + np.square(across)
    energy[energy < 0.2 * energy.max()] = 0
    at = np.arange(HALF) * 2 + 1
    total = max(float(energy.sum()), 1e-30)
    return np.array([(energy.sum(axis=1 - k) * at).sum() / total for k in (0, 1)])


def region(photograph: Photograph, y: int, x: int) -> Floats | None:
    """Light around a place, shape (2 HALF, 2 HALF); None: too near the border, or clipped."""
    width, height = photograph.size
    if not (HALF <= y <= height - HALF and HALF <= x <= width - HALF):
        return None
    rows, columns = slice(y - HALF, y + HALF), slice(x - HALF, x + HALF)
    if photograph.raw is None:
        return _developed(photograph, rows, columns)
    return _raw(photograph.raw, rows, columns)


def _developed(photograph: Photograph, rows: slice, columns: slice) -> Floats | None:
    assert photograph.pixels is not None
    part = photograph.pixels[rows, columns]
    if np.issubdtype(part.dtype, np.integer):
        ends = (part[..., 1] == 0) | (part[..., 1] == np.iinfo(part.dtype).max)
        if ends.mean() > 0.01:
            return None
    return photograph.linear(rows, columns)[..., 1]


def _raw(raw: RawNumbers, rows: slice, columns: slice) -> Floats | None:
    """Scales each channel of the mosaic to 0 .. 1 from the dark to the light side of the edge.

    So all photosites sample one grey edge without interpolation.
    """
    part = raw.mosaic[rows, columns]
    if (part >= raw.white).mean() > 0.001 or (part == 0).mean() > 0.01:
        return None
    height, width = raw.cells.shape
    at = np.ix_(
        np.arange(rows.start, rows.stop) % height, np.arange(columns.start, columns.stop) % width
    )
    channel = raw.cells[at]
    light = np.zeros(part.shape, np.float32)
    first, second = _sides(part.astype(np.float32), channel)
    for c in range(len(raw.channels)):
        mask = channel == c
        low, high = part[first & mask], part[second & mask]
        if not low.size or not high.size or high.mean() == low.mean():
            return None
        light[mask] = (part[mask] - low.mean()) / (high.mean() - low.mean())
    return light


def _sides(part: Floats, channel: NDArray[np.uint8]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Masks of the dark and light sides: outer quarters, across the axis nearest to the edge."""
    quarter = len(part) // 4
    main = np.bincount(channel.ravel()).argmax()
    mask = channel == main

    def difference(axis: int) -> float:
        turned, seen = (part, mask) if axis else (part.T, mask.T)
        first, last = turned[:, :quarter], turned[:, -quarter:]
        return float(last[seen[:, -quarter:]].mean() - first[seen[:, :quarter]].mean())

    steps = [difference(axis) for axis in (0, 1)]
    axis = int(np.argmax(np.abs(steps)))
    outer = np.zeros(part.shape, np.bool_)
    other = np.zeros(part.shape, np.bool_)
    if axis:
        outer[:, :quarter], other[:, -quarter:] = True, True
    else:
        outer[:quarter], other[-quarter:] = True, True
    return (outer, other) if steps[axis] > 0 else (other, outer)
