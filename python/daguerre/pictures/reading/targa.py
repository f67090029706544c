"""Checks TGA files before they are decoded.

Source: Truevision TGA file format specification, version 2.0, chapter 3.
"""

from __future__ import annotations

import struct

from daguerre.errors import InputError

from .size import check_size
from .source import PictureBytes

_HEAD = 18
_PALETTE, _PACKED = (1, 9), (9, 10, 11)
#: Most pixels in a packet of a compressed file.
_PACKET = 128


def check(source: PictureBytes, where: str, limit: int) -> None:
    """Checks the palette, the size, and that the file can hold the pixels.

    Raises:
        InputError: The head is wrong, or the picture is too large or too short.
    """
    head = source.at(0, _HEAD)
    note, mapped, kind, first, colors, color_bits = struct.unpack_from("<BBBHHB", head)
    width, height, bits = struct.unpack_from("<HHB", head, 12)
    each = (bits + 7) // 8
    palette = colors * ((color_bits + 7) // 8) if mapped else 0
    check_size(width, height, 4, 1, where, limit)
    if kind in _PALETTE and not (
        mapped and bits == 8 and color_bits in (15, 16, 24, 32) and colors > 0 and first == 0
    ):
        raise InputError(
            f"{where}: cannot be decoded: wanted a palette of 15 to 32 bits from 0, got "
            f"{colors} colours of {color_bits} bits from {first}, and {bits} bits of a pixel"
        )
    packed = source.size - _HEAD - note - palette
    least = width * height * each
    if kind in _PACKED:
        least = -(-width * height // _PACKET) * (1 + each)
    if packed < least:
        raise InputError(
            f"{where}: cannot be decoded: {source.size} bytes cannot hold {width}x{height} pixels"
        )
