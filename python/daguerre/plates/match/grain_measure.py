"""Measures the noise of developed pictures in flat parts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.plates.photograph import Photograph, encoded

from .flat_blocks import FlatBlocks, flat_blocks, rounding
from .grain import FOLDED, HALF, SIDE, Grain, whole_spectrum
from .likely import likely

FloatArray = NDArray[np.float64]
#: Largest number of levels, and least number of blocks for each.
_LEVELS, _EACH = 10, 6
#: Largest number of blocks for spectra.
_MOST = 1500


def grain_of(
    photograph: Photograph, electrons: float | None = None, notes: list[str] | None = None
) -> Grain | None:
    """Measures the noise of a developed picture; None: it has no flat parts.

    Args:
        photograph: Developed picture.
        electrons: Electrons of a white pixel, to tell noise from texture; None: no such check.
        notes: List that gets a note if parts were left out.
    """
    notes = [] if notes is None else notes
    found = flat_blocks(photograph)
    if found is None:
        notes.append("noise: not measured, as no part of the picture is flat")
        return None
    if electrons is not None and photograph.kind == "display":
        found = _likely(photograph, found, electrons, notes)
    return None if found is None else _grain(photograph, found)


def _likely(
    photograph: Photograph, found: FlatBlocks, electrons: float, notes: list[str]
) -> FlatBlocks | None:
    """Selects flat blocks that are not texture; adds a note on the others."""
    kept, fault = likely(photograph, found, electrons)
    if fault is not None:
        count = 0 if kept is None else len(kept.corner)
        notes.append(
            f"noise: {'' if count else 'not measured, as '}"
            f"{len(found.corner) - count} of {len(found.corner)} parts that look flat are "
            f"texture{' and were left out' if count else ''}: their variation is alike in all "
            f"colours, and {fault.times:.1f} times the noise expected at this ISO"
        )
    return kept


def _grain(photograph: Photograph, found: FlatBlocks) -> Grain:
    """Measures the noise of flat blocks."""
    linear = photograph.kind == "linear"
    curves = [_curve(found.level[:, c], found.variance[:, c], photograph) for c in range(3)]
    count = min(len(levels) for levels, _ in curves)
    levels = np.array([levels[:count] for levels, _ in curves])
    deviations = np.array([deviation[:count] for _, deviation in curves])
    plain = Grain(linear, levels, deviations, np.zeros((HALF, HALF, 3, 3)))
    return replace(plain, spectra=_spectra(photograph, found, plain))


def _curve(
    level: FloatArray, variance: FloatArray, photograph: Photograph
) -> tuple[FloatArray, FloatArray]:
    """Levels and deviations: means over bins of blocks."""
    order = np.argsort(level)
    parts = np.array_split(order, max(min(_LEVELS, len(order) // _EACH), 1))
    levels = np.array([level[part].mean() for part in parts])
    each = np.array([variance[part].mean() for part in parts])
    return levels, np.sqrt(np.maximum(each - rounding(photograph), 0))


def _spectra(photograph: Photograph, found: FlatBlocks, plain: Grain) -> FloatArray:
    """Mean cross power of blocks by absolute frequency, (HALF, HALF, 3, 3).

    Planes were subtracted, so the lowest frequencies are filled in from their neighbours.
    """
    chosen = np.linspace(0, len(found.corner) - 1, min(len(found.corner), _MOST)).astype(int)
    window = np.outer(*2 * [np.hanning(SIDE + 1)[:SIDE]])[:, :, None]
    power = np.zeros((SIDE, SIDE, 3, 3))
    for block in _standard(photograph, found, plain, chosen):
        waves = np.fft.fft2(block * window, axes=(0, 1))
        power += (waves[:, :, :, None] * waves[:, :, None].conj()).real
    return unit_power(folded(power))


def folded(power: FloatArray) -> FloatArray:
    """Averages both signs of the frequencies, from (SIDE, SIDE, ...) to (HALF, HALF, ...)."""
    total = np.zeros((HALF, HALF, *power.shape[2:]))
    count = np.zeros((HALF, HALF))
    np.add.at(total, np.ix_(FOLDED, FOLDED), power)
    np.add.at(count, np.ix_(FOLDED, FOLDED), 1)
    mean = total / count[:, :, None, None]
    mean[:2, :2] = mean[[2, 0, 2, 1, 2], [0, 2, 1, 2, 2]].mean(axis=0)
    return np.asarray(mean)


def unit_power(quadrant: FloatArray) -> FloatArray:
    """Scales cross power so that each channel has mean power 1; white if there is no noise."""
    mean = whole_spectrum(quadrant).mean(axis=(0, 1))
    own = np.sqrt(np.maximum(np.diag(mean), 0))
    if not (own > 0).all():
        return np.broadcast_to(np.eye(3), quadrant.shape).copy()
    return np.asarray(quadrant / np.outer(own, own))


def _standard(
    photograph: Photograph, found: FlatBlocks, plain: Grain, chosen: NDArray[np.intp]
) -> Iterator[FloatArray]:
    """Yields blocks without their gradient, in standard deviations, shape (SIDE, SIDE, 3)."""
    assert photograph.pixels is not None
    for i in chosen:
        y, x = found.corner[i]
        block = encoded(photograph.pixels[y : y + SIDE, x : x + SIDE]).astype(np.float64)
        noise = without_plane(block)
        level = found.level[i].astype(np.float32)
        one = [float(plain.deviation(c, level[c : c + 1])[0]) for c in range(3)]
        yield noise / np.maximum(one, 1e-9)


def without_plane(block: FloatArray) -> FloatArray:
    """Subtracts the fitted plane from a block, shape (h, w, C)."""
    height, width = block.shape[:2]
    y = (np.arange(height) - (height - 1) / 2)[:, None, None]
    x = (np.arange(width) - (width - 1) / 2)[None, :, None]
    rest = block - block.mean(axis=(0, 1))
    down = (rest * y).sum(axis=(0, 1)) / (np.square(y).sum() * width)
    across = (rest * x).sum(axis=(0, 1)) / (np.square(x).sum() * height)
    return np.asarray(rest - down * y - across * x)
