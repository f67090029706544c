"""Noise Texture and White Noise Texture.

Source: Cycles, ``kernel/svm/noisetex.h`` and ``white_noise.h`` (Apache-2.0): seeds of the channels
and of the distortion.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .fractals import Octaves
from .gradient_noise import Array, Point, signed_noise
from .hashes import Numbers, of_numbers

Fractal = Callable[[Point, Octaves], Array]


def noise(
    point: Point, fractal: Fractal, octaves: Octaves, distortion: Numbers, *, colored: bool
) -> list[Array]:
    """Value, or three channels of the colour, of the Noise Texture.

    Args:
        point: Coordinates, one array (N,) of single precision for each of 1 .. 4 axes.
        fractal: How octaves are joined.
        octaves: Its parameters.
        distortion: How far noise moves the point, a number or array.
        colored: Whether the colour is wanted.
    """
    axes = len(point)
    if np.any(distortion):
        moved = [signed_noise(_shifted(point, seed)) * distortion for seed in range(axes)]
        point = [axis + by for axis, by in zip(point, moved, strict=True)]
    channels = [fractal(point, octaves)]
    if colored:
        channels += [fractal(_shifted(point, axes + i), octaves) for i in (0, 1)]
    return channels


def _shifted(point: Point, seed: int) -> list[Array]:
    """Point far away in a direction that a seed chooses."""
    one = np.full(1, seed, np.float32)
    if len(point) == 1:
        return [point[0] + _offset(one)]
    return [axis + _offset(one, np.full(1, i, np.float32)) for i, axis in enumerate(point)]


def _offset(*key: Array) -> np.float32:
    return np.float32(100 + of_numbers(*key)[0] * np.float32(100))
