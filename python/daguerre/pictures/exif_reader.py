"""Reads the EXIF of a shot from its block: the main directory and the EXIF directory, no more.

Maker notes, thumbnails and positions stay unread: their tags have the same numbers, and other
meanings. Layout: TIFF 6.0, section 2, and BigTIFF; tags: Exif 3.0 (CIPA DC-008-2023), 4.6.
"""

from __future__ import annotations

import mmap
import struct
from collections.abc import Iterator
from typing import Any, NamedTuple

from .exif import EXIF_DIRECTORY

Buffer = bytes | mmap.mmap

_XMP_PACKET = 700
#: Names of the tags that are read, in either directory.
NAMES = {
    271: "Make",
    272: "Model",
    274: "Orientation",
    _XMP_PACKET: "XMP",
    33434: "ExposureTime",
    33437: "FNumber",
    34855: "PhotographicSensitivity",
    34864: "SensitivityType",
    34865: "StandardOutputSensitivity",
    34866: "RecommendedExposureIndex",
    34867: "ISOSpeed",
    36867: "DateTimeOriginal",
    37377: "ShutterSpeedValue",
    37378: "ApertureValue",
    37382: "SubjectDistance",
    37386: "FocalLength",
    40961: "ColorSpace",
    40962: "PixelXDimension",
    41486: "FocalPlaneXResolution",
    41487: "FocalPlaneYResolution",
    41488: "FocalPlaneResolutionUnit",
    41989: "FocalLengthIn35mmFilm",
    42035: "LensMake",
    42036: "LensModel",
}
#: Format and bytes of a value, by the number of its type.
_TYPES = {
    1: ("B", 1), 2: ("s", 1), 3: ("H", 2), 4: ("I", 4), 5: ("2I", 8), 6: ("b", 1), 7: ("s", 1),
    8: ("h", 2), 9: ("i", 4), 10: ("2i", 8), 11: ("f", 4), 12: ("d", 8), 16: ("Q", 8), 17: ("q", 8),
}  # fmt: skip
#: Numbers after the byte order: TIFF, BigTIFF, and TIFF as in raw files of Olympus and Panasonic.
_TIFF, _BIG, _OF_CAMERAS = 42, 43, (0x4F52, 0x5352, 0x0055)
_MOST_ENTRIES, _LONGEST_TEXT, _LONGEST_XMP = 4096, 4096, 1 << 24


class _Layout(NamedTuple):
    """Sizes in a file: formats of a count of entries, of an entry, of an offset; bytes of each."""

    order: str
    counter: str
    entry: str
    offset: str
    first: int  # position of the offset of the main directory

    def size(self, part: str) -> int:
        return struct.calcsize(self.order + part)


def exif_tags(block: Buffer) -> dict[str, Any]:
    """Returns known tags by name, without damaged ones.

    Args:
        block: Bytes of an EXIF block, which is a small TIFF file, or of a TIFF file.

    Returns:
        Numbers; fractions as pairs (numerator, denominator); texts; XMP as bytes.
    """
    layout = _layout(block)
    if layout is None:
        return {}
    main = dict(
        _directory(block, layout, _number(block, layout.order, layout.offset, layout.first))
    )
    found = {NAMES[tag]: value for tag, value in main.items() if tag in NAMES}
    more = main.get(EXIF_DIRECTORY)
    if isinstance(more, int):
        exif = dict(_directory(block, layout, more))
        found |= {NAMES[tag]: value for tag, value in exif.items() if tag in NAMES}
    return found


def _layout(block: Buffer) -> _Layout | None:
    order = {b"II": "<", b"MM": ">"}.get(bytes(block[:2]))
    if order is None or len(block) < 8:
        return None
    (kind,) = struct.unpack_from(f"{order}H", block, 2)
    if kind == _BIG:
        return _Layout(order, "Q", "HHQ8s", "Q", 8)
    return _Layout(order, "H", "HHI4s", "I", 4) if kind in (_TIFF, *_OF_CAMERAS) else None


def _number(block: Buffer, order: str, form: str, at: int) -> int:
    """The number at a position; 0 beyond the end."""
    size = struct.calcsize(order + form)
    return int(struct.unpack_from(order + form, block, at)[0]) if at + size <= len(block) else 0


def _directory(block: Buffer, layout: _Layout, at: int) -> Iterator[tuple[int, Any]]:
    """Yields tag and value of the entries of a directory that can be read."""
    if at <= 0:
        return
    count = min(_number(block, layout.order, layout.counter, at), _MOST_ENTRIES)
    step, start = layout.size(layout.entry), at + layout.size(layout.counter)
    for entry in range(start, start + count * step, step):
        if entry + step > len(block):
            return
        tag, kind, length, inside = struct.unpack_from(layout.order + layout.entry, block, entry)
        if tag not in NAMES and tag != EXIF_DIRECTORY:
            continue
        form, each = _TYPES.get(kind, ("", 0))
        place = entry + step - len(inside)
        if length * each > len(inside):
            place = _number(block, layout.order, layout.offset, place)
        if not form or length < 1 or place + each * length > len(block):
            continue
        if tag == _XMP_PACKET:
            yield tag, bytes(block[place : place + each * min(length, _LONGEST_XMP)])
        elif form == "s":
            yield tag, _text(bytes(block[place : place + min(length, _LONGEST_TEXT)]))
        else:  # of several numbers the first
            numbers = struct.unpack_from(layout.order + form, block, place)
            yield tag, numbers if len(numbers) == 2 else numbers[0]


def _text(data: bytes) -> str:
    """A text up to its first zero byte, UTF-8 or else Latin-1."""
    data = data.split(b"\0", 1)[0]
    try:
        return data.decode("utf-8").strip()
    except UnicodeDecodeError:
        return data.decode("latin-1").strip()
