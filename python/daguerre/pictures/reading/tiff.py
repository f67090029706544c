"""Reads the tags of TIFF files: whether a file is plain, and the pixels of the plainest files.

libtiff decodes dozens of compressions and kinds of pixels. Grey, RGB and palettes of whole bytes,
not packed or by LZW, deflate or PackBits, are plain; all others are decoded apart.
Source: TIFF 6.0, sections 2, 3, 8, 15; libtiff's page on BigTIFF.
"""

from __future__ import annotations

import struct
from typing import Final

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import DEFLATE_LIMIT
from daguerre.errors import InputError

from .size import check_size
from .source import PictureBytes

_WIDTH, _HEIGHT, _BITS, _COMPRESSION, _PHOTOMETRIC = 256, 257, 258, 259, 262
_STRIPS, _CHANNELS, _ROWS, _STRIP_BYTES, _PLANAR = 273, 277, 278, 279, 284
_TILE_WIDTH, _TILE_HEIGHT, _TILES, _TILE_BYTES, _FORMAT = 322, 323, 324, 325, 339
#: Bytes of whole numbers by type: BYTE, SHORT, LONG, LONG8.
_TYPES: Final = {1: "B", 3: "H", 4: "I", 16: "Q"}
_NOT_PACKED = 1
#: Most bytes that one of a compression becomes: LZW codes have 9 bits or more and stand for at most
#: 4096 bytes, a run of PackBits for 128.
_GROWTH = {_NOT_PACKED: 1, 5: 4096, 8: DEFLATE_LIMIT, 32946: DEFLATE_LIMIT, 32773: 64}
_MOST_TAGS, _MOST_VALUES, _MOST_CHANNELS, _LONGEST = 4096, 1 << 20, 64, 1 << 16
#: Tags that are read.
_WANTED = {
    _WIDTH, _HEIGHT, _BITS, _COMPRESSION, _PHOTOMETRIC, _STRIPS, _CHANNELS, _ROWS, _STRIP_BYTES,
    _PLANAR, _TILE_WIDTH, _TILE_HEIGHT, _TILES, _TILE_BYTES, _FORMAT,
}  # fmt: skip

Tags = dict[int, tuple[int, ...]]


def check(source: PictureBytes, where: str, limit: int) -> bool:
    """Checks the size of the first picture, and whether it is plain.

    Returns:
        Whether the file is plain, with all pixels within the file: it may be decoded here.

    Raises:
        InputError: The picture is too large.
    """
    tags = read_tags(source, where)
    width, height, channels = _size(tags)
    bits = tags.get(_BITS, (1,))
    check_size(width, height, channels, max(1, max(bits) // 8), where, limit)
    growth = _GROWTH.get(_one(tags, _COMPRESSION, 1))
    plain = (
        1 <= channels <= _MOST_CHANNELS
        and len(bits) in (1, channels)
        and len(set(bits)) == 1
        and bits[0] in (8, 16, 32)
        and _one(tags, _PHOTOMETRIC, -1) in (0, 1, 2, 3)
        and _one(tags, _PLANAR, 1) in (1, 2)
        and growth is not None
    )
    return plain and _is_whole(tags, source.size, growth or 1)


def _is_whole(tags: Tags, size: int, growth: int) -> bool:
    """Whether strips or tiles are as many as the size wants, within the file, and large enough."""
    width, height, channels = _size(tags)
    planes = channels if _one(tags, _PLANAR, 1) == 2 else 1
    tiled = _TILES in tags
    if tiled:
        across, down = _one(tags, _TILE_WIDTH, 0), _one(tags, _TILE_HEIGHT, 0)
    else:
        across, down = width, min(_one(tags, _ROWS, height), height)
    if not (1 <= across <= _LONGEST and 1 <= down <= _LONGEST):
        return False
    lines = -(-height // down)
    starts = tags.get(_TILES if tiled else _STRIPS, ())
    counts = tags.get(_TILE_BYTES if tiled else _STRIP_BYTES, ())
    if not len(starts) == len(counts) == -(-width // across) * lines * planes:
        return False
    row = across * (channels // planes) * (tags[_BITS][0] // 8)
    return all(
        start + count <= size
        and count * growth >= row * (down if tiled else min(down, height - i % lines * down))
        for i, (start, count) in enumerate(zip(starts, counts, strict=True))
    )


def plain_pixels(source: PictureBytes, where: str, limit: int) -> NDArray[np.generic]:
    """Reads pixels that are not packed, pixel by pixel; shape (H, W, C).

    Raises:
        InputError: The file is of another kind.
    """
    tags = read_tags(source, where)
    if not (check(source, where, limit) and _one(tags, _COMPRESSION, 1) == _NOT_PACKED):
        raise InputError(f"{where}: wanted a plain TIFF")
    kind = {1: "u", 2: "i", 3: "f"}.get(_one(tags, _FORMAT, 1))
    if kind is None or _STRIPS not in tags or _one(tags, _PLANAR, 1) != 1:
        raise InputError(f"{where}: wanted a plain TIFF")
    dtype = np.dtype(f"{_order(source.at(0, 2))}{kind}{tags[_BITS][0] // 8}")
    data = b"".join(
        source.at(start, count)
        for start, count in zip(tags[_STRIPS], tags[_STRIP_BYTES], strict=True)
    )
    width, height, channels = _size(tags)
    wanted = width * height * channels
    if len(data) < wanted * dtype.itemsize:
        raise InputError(f"{where}: wanted a plain TIFF")
    pixels = np.frombuffer(data, dtype, wanted).reshape(height, width, channels)
    return pixels.astype(dtype.newbyteorder("="), copy=False)


def read_tags(source: PictureBytes, where: str) -> Tags:
    """Reads the whole numbers of the first directory; each tag has at least one number.

    Raises:
        InputError: The directory is not within the file.
    """
    head = source.at(0, 16)
    order, big = _order(head), head[2:4] in (b"+\0", b"\0+")
    try:
        (at,) = struct.unpack_from(f"{order}{'Q' if big else 'I'}", head, 8 if big else 4)
        (count,) = struct.unpack(f"{order}{'Q' if big else 'H'}", source.at(at, 8 if big else 2))
        count, size = min(count, _MOST_TAGS), 20 if big else 12
        table = source.at(at + (8 if big else 2), count * size)
        entries = [
            struct.unpack_from(f"{order}HH{'Q8s' if big else 'I4s'}", table, i * size)
            for i in range(count)
        ]
    except (struct.error, OverflowError, ValueError, OSError):
        raise InputError(f"{where}: cannot be decoded: a TIFF whose tags are cut off") from None
    tags: Tags = {}
    for tag, type_, number, value in entries:
        letter = _TYPES.get(type_)
        if letter is None or tag not in _WANTED or tag in tags:
            continue
        if not 1 <= number <= _MOST_VALUES:
            continue
        form = f"{order}{number}{letter}"
        wanted = struct.calcsize(form)
        if wanted > len(value):
            (place,) = struct.unpack(f"{order}{'Q' if big else 'I'}", value)
            value = source.at(place, wanted) if place < source.size else b""
        if len(value) >= wanted:
            tags[tag] = struct.unpack_from(form, value)
    return tags


def _order(head: bytes) -> str:
    return "<" if head[:2] == b"II" else ">"


def _size(tags: Tags) -> tuple[int, int, int]:
    """Width and height, px, and number of channels."""
    return _one(tags, _WIDTH, 0), _one(tags, _HEIGHT, 0), _one(tags, _CHANNELS, 1)


def _one(tags: Tags, tag: int, default: int) -> int:
    """First value of a tag."""
    values = tags.get(tag, ())
    return values[0] if values else default
