"""Hashes of integers and of the bits of numbers to fractions.

Source: B. Jenkins 2006, "lookup3" (public domain); M. Jarzynski and M. Olano 2020, "Hash functions
for GPU rendering", JCGT 9(3) (PCG); how numbers and cells become keys: Cycles, ``util/hash.h``
(Apache-2.0).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Words = NDArray[np.uint32]
Array = NDArray[np.float32]
#: Parameter of a pattern: one number, or an array (N,).
Numbers = Array | np.float32 | float
_SEED = 0xDEADBEEF + 13
#: Steps of the two mixers: a word, the two that change it, and by how many bits they turn.
_FINAL = ((2, 1, 14), (0, 2, 11), (1, 0, 25), (2, 1, 16), (0, 2, 4), (1, 0, 14), (2, 1, 24))
_MIX = ((0, 2, 4, 1), (1, 0, 6, 2), (2, 1, 8, 0), (0, 2, 16, 1), (1, 0, 19, 2), (2, 1, 4, 0))
_TO_FRACTION = np.float32(1 / 0xFFFFFFFF)
_MULTIPLIER, _INCREMENT = np.uint32(1664525), np.uint32(1013904223)
_POSITIVE = np.uint32(0x7FFFFFFF)
_HALF = np.float32(1 / 0x7FFFFFFF)


def lookup3(*keys: Words) -> Words:
    """Hash of one to four words, arrays of one shape."""
    seed = np.uint32((_SEED + 4 * len(keys)) & 0xFFFFFFFF)
    words = [key + seed for key in keys[:3]]
    words += [np.full(keys[0].shape, seed) for _ in range(3 - len(words))]
    turned = np.empty(keys[0].shape, np.uint32)
    spare = np.empty(keys[0].shape, np.uint32)
    if len(keys) == 4:
        _mix(words, turned, spare)
        words[0] += keys[3]
    for changed, by, bits in _FINAL:
        words[changed] ^= words[by]
        words[changed] -= _rotated(words[by], bits, turned, spare)
    return words[2]


def _mix(words: list[Words], turned: Words, spare: Words) -> None:
    for changed, by, bits, third in _MIX:
        words[changed] -= words[by]
        words[changed] ^= _rotated(words[by], bits, turned, spare)
        words[by] += words[third]


def _rotated(word: Words, bits: int, turned: Words, spare: Words) -> Words:
    np.left_shift(word, np.uint32(bits), out=turned)
    np.right_shift(word, np.uint32(32 - bits), out=spare)
    turned |= spare
    return turned


def fraction(word: Words) -> Array:
    """Word as a fraction 0 .. 1."""
    return word.astype(np.float32) * _TO_FRACTION


def bits(value: ArrayLike) -> Words:
    """Bits of numbers of single precision."""
    return np.ascontiguousarray(value, np.float32).view(np.uint32)


def of_numbers(*values: Array) -> Array:
    """Fraction of one to four numbers, arrays of one shape."""
    return fraction(lookup3(*(bits(value) for value in values)))


def color_of_numbers(values: Sequence[Array]) -> list[Array]:
    """Three fractions of one to four numbers."""
    if len(values) == 4:
        x, y, z, w = values
        return [of_numbers(x, y, z, w), of_numbers(z, x, w, y), of_numbers(w, z, y, x)]
    shape = values[0].shape
    extra = [np.full(shape, i, np.float32) for i in (1, 2)]
    return [of_numbers(*values), *(of_numbers(*values, one) for one in extra)]


def of_cell(cell: Sequence[Words], size: int) -> list[Array]:
    """Fractions of a cell of a grid with two to four axes: its PCG hash of ``size`` words."""
    words = [axis * _MULTIPLIER + _INCREMENT for axis in cell]
    if size > len(words):
        words.append(np.full(words[0].shape, _INCREMENT))
    stir = {2: _stir_two, 3: _stir_three, 4: _stir_four}[len(words)]
    stir(words)
    for word in words:
        word ^= (word.view(np.int32) >> np.int32(16)).view(np.uint32)
    stir(words)
    return [(word & _POSITIVE).astype(np.float32) * _HALF for word in words[:size]]


def _stir_two(words: list[Words]) -> None:
    x, y = words
    x += y * _MULTIPLIER
    y += x * _MULTIPLIER


def _stir_three(words: list[Words]) -> None:
    x, y, z = words
    x += y * z
    y += z * x
    z += x * y


def _stir_four(words: list[Words]) -> None:
    x, y, z, w = words
    x += y * w
    y += z * x
    z += x * y
    w += y * z
