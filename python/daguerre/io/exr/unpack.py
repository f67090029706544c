"""Deflated pixels of OpenEXR as plain ones, by zlib and numpy; nothing else touches their bytes.

A block keeps the even bytes first, then the odd ones, each as its difference to the one before,
plus 128 (OpenEXR Technical Introduction, "ZIP"). Sums of differences are taken eight bytes at a
time: a multiplication by 1 + 2^16 + 2^32 + 2^48 leaves in each of four lanes the sum of the lanes
up to it, and lanes of 16 bits do not overflow into each other.
"""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

_LANES, _SPREAD = np.uint64(0x00FF00FF00FF00FF), np.uint64(0x0001000100010001)
_ODD = np.uint64(0x8000800080008000)  # 128 less, an odd number of times, at every other byte
_BYTE, _LANE = np.uint64(8), np.uint64(16)
_PIECE = 12288  # words at a time: what fits into a core's cache


def inflated(data: bytes, size: int) -> NDArray[np.uint8]:
    """The bytes of a block.

    Args:
        data: Those of the file; plain where deflating would not have paid.
        size: Bytes of the pixels, an even number.

    Raises:
        ValueError: They are damaged, or of another size.
    """
    if len(data) == size:
        return np.frombuffer(data, np.uint8)
    stream = zlib.decompressobj()
    try:
        plain = stream.decompress(data, size + 1)
    except zlib.error as error:
        raise ValueError(f"damaged pixels: {error}") from None
    if len(plain) != size:
        more = "more" if len(plain) > size else f"{len(plain)}"
        raise ValueError(f"wanted {size} bytes of pixels, got {more}")
    words = np.zeros(-(-size // 8), np.uint64)
    found = words.view(np.uint8)[:size]
    found[:] = np.frombuffer(plain, np.uint8)
    _add_up(words)
    half = size // 2
    pairs = found[half:].astype(np.uint16)
    pairs <<= 8
    pairs |= found[:half]
    return pairs.view(np.uint8)


def _add_up(words: NDArray[np.uint64]) -> None:
    """Undoes the differences of bytes, in place; words are little-endian."""
    before = 0
    for start in range(0, len(words), _PIECE):
        piece = words[start : start + _PIECE]
        even = piece & _LANES
        even *= _SPREAD
        odd = piece >> _BYTE
        odd &= _LANES
        odd *= _SPREAD
        sums = np.cumsum((even + odd).view(np.uint8)[6::8], dtype=np.uint8)
        sums += np.uint8(before)
        base = np.empty(len(piece), np.uint64)
        base[0], base[1:] = before, sums[:-1]
        before = int(sums[-1])
        base *= _SPREAD
        even += base
        last = even + odd
        last &= _LANES
        last <<= _BYTE
        odd <<= _LANE
        even += odd
        even &= _LANES
        np.bitwise_or(even, last, out=piece)
        piece ^= _ODD
