"""KTX 2.0 pictures in UASTC, mosaics alone: every block of 4 x 4 pixels has one colour.

That is mode 8 of UASTC's nineteen, so this is all the encoder there has to be.
Source: KTX File Format Specification 2.0, chapter 3; Khronos Data Format Specification 1.3,
chapter "UASTC LDR 4x4", modes and mode 8.
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray

_HEAD = 80 + 24  # header and index, one level
# Texel block of 4 x 4 (each less one), 16 bytes in plane 0.
_BLOCK = bytes([3, 3, 0, 0, 16, *7 * [0]])
_UASTC, _BT709, _SRGB, _RGBA = 166, 1, 2, 3


def mosaic(stones: NDArray[np.floating]) -> bytes:
    """A KTX2 file of 4 x 4 pixels per stone; sRGB colours in [0, 1], shape (H, W, 3)."""
    height, width = stones.shape[:2]
    colors = (np.clip(stones.reshape(-1, 3), 0, 1) * 255 + 0.5).astype(int).tolist()
    blocks = b"".join(_block(*color) for color in colors)
    sample = struct.pack("<HBBIII", 0, 127, _RGBA, 0, 0, 0xFFFFFFFF)
    basic = struct.pack("<IHH4B", 0, 2, 40, _UASTC, _BT709, _SRGB, 0) + _BLOCK + sample
    descriptor = struct.pack("<I", 4 + len(basic)) + basic
    start = -(-(_HEAD + len(descriptor)) // 16) * 16  # a level lies on its block size
    head = b"\xabKTX 20\xbb\r\n\x1a\n"
    head += struct.pack("<9I", 0, 1, 4 * width, 4 * height, 0, 0, 1, 1, 0)
    head += struct.pack("<4I2Q", _HEAD, len(descriptor), 0, 0, 0, 0)
    head += struct.pack("<3Q", start, len(blocks), len(blocks))
    return (head + descriptor).ljust(start, b"\0") + blocks


def _block(red: int, green: int, blue: int) -> bytes:
    """One colour, and what a transcoder to ETC1 takes for it: its five bits, the smallest step."""
    bits = at = 0
    fields = [(23, 5), (red, 8), (green, 8), (blue, 8), (255, 8), (1, 1), (0, 3), (1, 2)]
    fields += [((c * 31 + 127) // 255, 5) for c in (red, green, blue)]
    for value, width in fields:
        bits |= value << at
        at += width
    return bits.to_bytes(16, "little")
