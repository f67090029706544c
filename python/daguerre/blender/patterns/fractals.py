"""Sums and products of octaves of gradient noise.

Source: F. K. Musgrave in Ebert et al. 2003, "Texturing and Modeling", chapter 16; how Blender
treats parts of an octave: Cycles, ``kernel/svm/fractal_noise.h`` (Apache-2.0).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, floor
from typing import Any, NamedTuple

import numpy as np

from .gradient_noise import Array, Point, signed_noise
from .hashes import Numbers

#: Weight under which octaves of a hybrid add nothing.
_LEAST_WEIGHT = np.float32(0.001)
ONE = np.float32(1)


class Octave(NamedTuple):
    """Octave of a pattern.

    Attributes:
        share: Share that counts.
        size: Factor on its size.
        frequency: Factor on its frequency.
    """

    share: np.float32
    size: Any
    frequency: Any


class NoiseOctave(NamedTuple):
    """Octave of gradient noise.

    Attributes:
        share: Share that counts.
        size: Factor on its size.
        noise: Noise, shape (N,).
    """

    share: np.float32
    size: Any
    noise: Array


@dataclass(frozen=True)
class Octaves:
    """Parameters of a fractal.

    Attributes:
        detail: Number of octaves after the first, 0 .. 15; a part counts in part.
        roughness: Factor between octaves on their size; a number or array (N,).
        lacunarity: Factor between octaves on their frequency; a number or array.
        offset: Level of terrains; a number or array.
        gain: Factor between octaves of terrains on their weight; a number or array.
        normalize: Whether a sum is brought to 0 .. 1.
    """

    detail: float = 2.0
    roughness: Numbers = 0.5
    lacunarity: Numbers = 2.0
    offset: Numbers = 0.0
    gain: Numbers = 1.0
    normalize: bool = True

    def noises(self, point: Point) -> Iterator[NoiseOctave]:
        """Noise of each octave."""
        for share, size, frequency in octaves_of(self.detail, self.roughness, self.lacunarity):
            noise = signed_noise([axis * frequency for axis in point])
            yield NoiseOctave(share, size, noise)


def octaves_of(detail: float, roughness: Numbers, lacunarity: Numbers) -> Iterator[Octave]:
    """Octaves; the share of the last may be a part."""
    size: Numbers = ONE
    scale: Numbers = ONE
    for i in range(ceil(detail) + 1):
        share = ONE if i <= floor(detail) else np.float32(detail - floor(detail))
        yield Octave(share, size, scale)
        size = size * roughness
        scale = scale * lacunarity


def fbm(point: Point, octaves: Octaves) -> Array:
    """Sum of octaves (fractal Brownian motion)."""
    total: Numbers = np.float32(0)
    sizes: Numbers = np.float32(0)
    for share, size, noise in octaves.noises(point):
        more, most = total + noise * size, sizes + size
        if share < 1:
            before, after = _level(total, sizes, octaves), _level(more, most, octaves)
            return np.asarray(before + share * (after - before))
        total, sizes = more, most
    return np.asarray(_level(total, sizes, octaves))


def _level(total: Numbers, sizes: Numbers, octaves: Octaves) -> Numbers:
    if not octaves.normalize:
        return total
    return np.float32(0.5) * total / sizes + np.float32(0.5)


def multifractal(point: Point, octaves: Octaves) -> Array:
    """Product of octaves."""
    value: Numbers = ONE
    for share, size, noise in octaves.noises(point):
        value = value * (share * size * noise + ONE)
    return np.asarray(value)


def hetero_terrain(point: Point, octaves: Octaves) -> Array:
    """Terrain that is rougher where it is higher."""
    value: Numbers = np.float32(0)
    for i, (share, size, noise) in enumerate(octaves.noises(point)):
        raised = noise + octaves.offset
        step = raised * size * value if i else raised
        value = value + share * step
    return np.asarray(value)


def hybrid_multifractal(point: Point, octaves: Octaves) -> Array:
    """Hybrid multifractal terrain: each octave is weighted by the sum of the coarser octaves."""
    value: Numbers = np.zeros_like(point[0])
    weight: Numbers = np.ones_like(point[0])
    for share, size, noise in octaves.noises(point):
        alive = weight > _LEAST_WEIGHT
        weight = np.minimum(weight, ONE)
        signal = (noise + octaves.offset) * size
        value = np.where(alive, value + share * weight * signal, value)
        weight = np.where(alive, weight * octaves.gain * signal, np.float32(0))
    return np.asarray(value)


def ridged_multifractal(point: Point, octaves: Octaves) -> Array:
    """Terrain with ridges; a part of an octave does not count."""
    value: Numbers = np.float32(0)
    signal: Numbers = np.float32(0)
    for i, (share, size, noise) in enumerate(octaves.noises(point)):
        if share < 1:
            break
        weight = np.clip(signal * octaves.gain, 0, 1) if i else ONE
        signal = (octaves.offset - np.abs(noise)) ** 2 * weight
        value = value + signal * size
    return np.asarray(value)


#: Fractals by Blender's name of the type.
FRACTALS = {
    "FBM": fbm,
    "MULTIFRACTAL": multifractal,
    "HETERO_TERRAIN": hetero_terrain,
    "HYBRID_MULTIFRACTAL": hybrid_multifractal,
    "RIDGED_MULTIFRACTAL": ridged_multifractal,
}
