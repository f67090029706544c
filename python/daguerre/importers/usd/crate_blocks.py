"""Unpacks compressed parts of binary layers: blocks of LZ4, and steps between numbers."""

from __future__ import annotations

import struct

import numpy as np


class DamageError(Exception):
    """A binary layer is damaged; the message says how."""


def extremes(data: memoryview, count: int) -> tuple[int, int]:
    """Smallest and largest of some packed 32-bit numbers: each is a step from the previous number.

    A code of two bits gives each step: the common step, or a number of 1, 2 or 4 bytes.
    """
    codes_end = 4 + (2 * count + 7) // 8
    raw = np.frombuffer(unpacked(data, codes_end + 4 * count), np.uint8)
    bits = raw[4:codes_end, None] >> np.arange(0, 8, 2, dtype=np.uint8) & 3
    codes = bits.reshape(-1)[:count]
    widths = np.array([0, 1, 2, 4])[codes]
    starts = codes_end + np.cumsum(widths) - widths
    if len(codes) < count or codes_end + int(widths.sum()) > len(raw):
        raise DamageError("too few packed numbers")
    steps = np.full(count, int(raw[:4].view("<i4")[0]), np.int64)
    for code, kind in ((1, "<i1"), (2, "<i2"), (3, "<i4")):
        chosen = starts[codes == code]
        size = np.dtype(kind).itemsize
        steps[codes == code] = raw[chosen[:, None] + np.arange(size)].copy().view(kind).reshape(-1)
    values = np.cumsum(steps).astype(np.int32)
    return int(values.min()), int(values.max())


def unpacked(data: memoryview, size: int) -> bytes:
    """Unpacks ``size`` bytes, stored as blocks of LZ4."""
    if not len(data):
        return b""
    blocks, at = data[0], 1
    if not blocks:
        return _lz4(data[1:], size)
    made = bytearray()
    for _ in range(blocks):
        (length,) = struct.unpack_from("<i", data, at)
        if length <= 0:
            raise DamageError("a block has 0 bytes")
        made += _lz4(data[at + 4 : at + 4 + length], size - len(made))
        at += 4 + length
    return bytes(made)


def _lz4(data: memoryview, most: int) -> bytes:
    """Unpacks a block of LZ4 of at most some bytes.

    Source: "LZ4 Block Format Description", lz4.org.
    """
    made, at = bytearray(), 0
    while at < len(data):
        token = data[at]
        length, at = _length(data, at + 1, token >> 4)
        made += data[at : at + length]
        at += length
        if at < len(data):
            (back,) = struct.unpack_from("<H", data, at)
            length, at = _length(data, at + 2, token & 15)
            length += 4
            if not 0 < back <= len(made) or len(made) + length > most:
                raise DamageError("packed bytes are damaged")
            piece = made[-back:] if back >= length else made[-back:] * (length // back + 1)
            made += piece[:length]
    if len(made) > most:
        raise DamageError(f"more than {most} unpacked bytes")
    return bytes(made)


def _length(data: memoryview, at: int, nibble: int) -> tuple[int, int]:
    """Length that begins in four bits and may go on in bytes; and where it ends."""
    if nibble == 15:
        more = 255
        while more == 255:
            more = data[at]
            nibble, at = nibble + more, at + 1
    return nibble, at
