"""Sums and products of octaves of gradient noise.

Source: F. K. Musgrave in Ebert et al. 2003, "Texturing and Modeling", chapter 16; how Blender
treats parts of an octave: Cycles, ``kernel/svm/fractal_noise.h`` (Apache-2.0).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import floor
from typing import Any

import numpy as np

from .gradient_noise import Array, Point, signed_noise

#: Weight under which octaves of a hybrid add nothing.
_LEAST_WEIGHT = np.float32(0.001)


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
    roughness: Any = 0.5
    lacunarity: Any = 2.0
    offset: Any = 0.0
    gain: Any = 1.0
    normalize: bool = True

    @property
    def rest(self) -> np.float32:
        """Part of the last octave."""
        return np.float32(self.detail - floor(self.detail))

    def noises(self, point: Point) -> Iterator[Array]:
        """Noise of all whole octaves, then that of the last part, if there is one."""
        scale: Any = np.float32(1)
        for _ in range(floor(self.detail) + 1 + (self.rest > 0)):
            yield signed_noise([axis * scale for axis in point])
            scale = scale * self.lacunarity

    def is_part(self, index: int) -> bool:
        """Whether an octave counts in part."""
        return index > floor(self.detail)


def fbm(point: Point, octaves: Octaves) -> Array:
    """Sum of octaves (fractal Brownian motion)."""
    total: Any = np.float32(0)
    size: Any = np.float32(1)
    sizes: Any = np.float32(0)
    for i, noise in enumerate(octaves.noises(point)):
        if octaves.is_part(i):
            more = total + noise * size
            before, after = _level(total, sizes, octaves), _level(more, sizes + size, octaves)
            return np.asarray(before + octaves.rest * (after - before))
        total = total + noise * size
        sizes = sizes + size
        size = size * octaves.roughness
    return np.asarray(_level(total, sizes, octaves))


def _level(total: Any, sizes: Any, octaves: Octaves) -> Any:
    if not octaves.normalize:
        return total
    return np.float32(0.5) * total / sizes + np.float32(0.5)


def multifractal(point: Point, octaves: Octaves) -> Array:
    """Product of octaves."""
    value: Any = np.float32(1)
    size: Any = np.float32(1)
    for i, noise in enumerate(octaves.noises(point)):
        share = octaves.rest if octaves.is_part(i) else np.float32(1)
        value = value * (share * size * noise + np.float32(1))
        size = size * octaves.roughness
    return np.asarray(value)


def hetero_terrain(point: Point, octaves: Octaves) -> Array:
    """Terrain that is rougher where it is higher."""
    value: Any = np.float32(0)
    size: Any = np.float32(1)
    for i, noise in enumerate(octaves.noises(point)):
        raised = noise + octaves.offset
        step = raised * size * value if i else raised
        value = value + (octaves.rest * step if octaves.is_part(i) else step)
        size = size * octaves.roughness
    return np.asarray(value)


def hybrid_multifractal(point: Point, octaves: Octaves) -> Array:
    """Terrain whose octaves weigh what lies below them."""
    value: Any = np.zeros_like(point[0])
    weight: Any = np.ones_like(point[0])
    size: Any = np.float32(1)
    for i, noise in enumerate(octaves.noises(point)):
        alive = weight > _LEAST_WEIGHT
        weight = np.minimum(weight, np.float32(1))
        signal = (noise + octaves.offset) * size
        share = octaves.rest if octaves.is_part(i) else np.float32(1)
        value = np.where(alive, value + share * weight * signal, value)
        weight = np.where(alive, weight * octaves.gain * signal, np.float32(0))
        size = size * octaves.roughness
    return np.asarray(value)


def ridged_multifractal(point: Point, octaves: Octaves) -> Array:
    """Terrain with ridges; a part of an octave does not count."""
    value: Any = np.float32(0)
    signal: Any = np.float32(0)
    size: Any = np.float32(1)
    for i, noise in enumerate(octaves.noises(point)):
        if octaves.is_part(i):
            break
        weight = np.clip(signal * octaves.gain, 0, 1) if i else np.float32(1)
        signal = (octaves.offset - np.abs(noise)) ** 2 * weight
        value = value + signal * size
        size = size * octaves.roughness
    return np.asarray(value)


#: Fractals by Blender's name of the type.
FRACTALS = {
    "FBM": fbm,
    "MULTIFRACTAL": multifractal,
    "HETERO_TERRAIN": hetero_terrain,
    "HYBRID_MULTIFRACTAL": hybrid_multifractal,
    "RIDGED_MULTIFRACTAL": ridged_multifractal,
}
