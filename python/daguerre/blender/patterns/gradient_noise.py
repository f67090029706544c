"""Gradient noise on a grid with one to four axes.

Source: K. Perlin 2002, "Improving noise"; gradients and scales: Open Shading Language (BSD-3).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from .hashes import Words, lookup3

Array = NDArray[np.float32]
Point = Sequence[Array]
#: Factors that bring noise to -1 .. 1, by number of axes.
_SCALES = (0.25, 0.6616, 0.982, 0.8344)
#: Distance after which noise repeats.
_PERIOD = np.float32(100000)


def signed_noise(point: Point) -> Array:
    """Noise within -1 .. 1.

    Args:
        point: Coordinates, one array (N,) of single precision for each axis.
    """
    point = [wrapped(axis) for axis in point]
    floors = [np.floor(axis) for axis in point]
    cells = [floor.astype(np.int32).view(np.uint32) for floor in floors]
    inside = [axis - floor for axis, floor in zip(point, floors, strict=True)]
    ends = [(cell, cell + np.uint32(1)) for cell in cells]
    offsets = [(one, one - np.float32(1)) for one in inside]
    values = []
    for corner in product((0, 1), repeat=len(point)):  # the first axis changes fastest
        chosen = corner[::-1]
        word = lookup3(*(ends[i][far] for i, far in enumerate(chosen)))
        values.append(_slope(word, [offsets[i][far] for i, far in enumerate(chosen)]))
    for one in inside:
        share = _fade(one)
        values = [_mixed(a, b, share) for a, b in zip(values[::2], values[1::2], strict=True)]
    values[0] *= np.float32(_SCALES[len(point) - 1])
    return values[0]


def wrapped(axis: Array) -> Array:
    """Coordinate that repeats far from the origin, where single precision ends."""
    if not axis.size or np.abs(axis).max() < _PERIOD:
        return axis
    with np.errstate(invalid="ignore"):
        found = np.fmod(axis, _PERIOD)
    return np.where(np.isfinite(found), found, np.float32(0))


def _fade(t: Array) -> Array:
    """Smooth step with two flat derivatives at both ends."""
    found = t * np.float32(6)
    for add in (-15, 10):
        found += np.float32(add)
        found *= t
    found *= t
    found *= t
    return found


def _mixed(a: Array, b: Array, share: Array) -> Array:
    b -= a
    b *= share
    b += a
    return b


def _slope(word: Words, offset: Sequence[Array]) -> Array:
    """Product of the gradient that a hash chooses and the offset from its corner."""
    if len(offset) == 1:
        size = (word & np.uint32(7)).astype(np.float32) + np.float32(1)
        return _signed(size * offset[0], word, 3)
    if len(offset) == 2:
        x, y = offset
        low = (word & np.uint32(4)) == 0
        total = _signed(np.where(low, x, y), word, 0)
        total += _signed(np.where(low, y, x) * np.float32(2), word, 1)
        return total
    if len(offset) == 3:
        x, y, z = offset
        kind = word & np.uint32(15)
        total = _signed(np.where(kind < 8, x, y), word, 0)
        other = np.where((kind & np.uint32(13)) == 12, x, z)
        total += _signed(np.where(kind < 4, y, other), word, 1)
        return total
    x, y, z, w = offset
    kind = word & np.uint32(31)
    total = _signed(np.where(kind < 24, x, y), word, 0)
    total += _signed(np.where(kind < 16, y, z), word, 1)
    total += _signed(np.where(kind < 8, z, w), word, 2)
    return total


def _signed(value: Array, word: Words, bit: int) -> Array:
    """Value, negative where a bit of a word is set; changes the array."""
    sign = word >> np.uint32(bit)
    sign <<= np.uint32(31)
    flipped = value.view(np.uint32)
    flipped ^= sign
    return value
