"""Checks PNG files before they are decoded, as libpng writes to stderr.

Source: PNG specification, 3rd edition, chapters 5 and 11.
"""

from __future__ import annotations

import struct
import zlib

from daguerre.checks import DEFLATE_LIMIT
from daguerre.errors import InputError
from daguerre.files.json_item import short

from .size import check_size
from .source import PictureBytes

_SIGNATURE_BYTES = 8
# Bits by colour type (11.2.1).
_DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}


def check(source: PictureBytes, where: str, limit: int) -> None:
    """Checks chunks, checksums and header.

    Raises:
        InputError: The file is truncated, corrupt or too large.
    """
    data = source.all()
    offset, packed, header, start = _SIGNATURE_BYTES, 0, b"", b""
    while True:
        if offset + 12 > len(data):
            raise InputError(f"{where}: truncated PNG: the IEND chunk is missing")
        length, kind = struct.unpack_from(">I4s", data, offset)
        end = offset + 12 + length
        if end > len(data):
            raise InputError(
                f"{where}: truncated PNG: wanted at least {end} bytes, got {len(data)}"
            )
        (stored,) = struct.unpack_from(">I", data, end - 4)
        if kind[:1].isupper() and zlib.crc32(data[offset + 4 : end - 4]) != stored:
            raise InputError(f"{where}: corrupt PNG: wrong checksum of chunk {short(kind)}")
        if kind == b"IHDR":
            header = data[offset + 8 : end - 4]
        if kind == b"IDAT":
            start += data[offset + 8 : offset + 8 + min(length, 2 - len(start))]
            packed += length
        if kind == b"IEND":
            break
        offset = end
    _check_header(header, start, packed, where, limit)


def _check_header(header: bytes, start: bytes, packed: int, where: str, limit: int) -> None:
    """Checks the header, the first bytes of the pixels, and how many bytes they have."""
    if len(header) != 13:
        raise InputError(f"{where}: corrupt PNG: wanted 13 bytes of IHDR, got {len(header)}")
    width, height, depth, color = struct.unpack_from(">IIBB", header)
    if depth not in _DEPTHS.get(color, ()):
        raise InputError(
            f"{where}: corrupt PNG: wanted a known kind of pixels, got colour type {color} "
            f"of {depth} bits"
        )
    channels = _CHANNELS[color]
    check_size(width, height, channels, max(depth // 8, 1), where, limit)
    if len(start) < 2 or start[0] & 15 != 8 or int.from_bytes(start, "big") % 31:  # RFC 1950, 2.2
        raise InputError(f"{where}: corrupt PNG: wanted a deflate stream, got {short(start)}")
    unpacked = height * ((width * depth * channels + 7) // 8)
    if unpacked > packed * DEFLATE_LIMIT + 64:
        raise InputError(
            f"{where}: truncated PNG: {packed} bytes cannot hold {width}x{height} pixels"
        )
