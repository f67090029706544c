"""Finds EXIF and XMP in a photograph's file: JPEG, PNG, WebP, TIFF and raw files built like it.

Layouts: Exif 3.0, 4.5 and 4.7; XMP specification, part 3; PNG, 3rd edition, 11.3; RIFF of WebP.
"""

from __future__ import annotations

import mmap
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO

from daguerre.files.reading import opened, reading

from . import png_chunks
from .exif_reader import exif_tags
from .xmp import xmp_tags

_EXIF, _XMP = b"Exif\0\0", b"http://ns.adobe.com/xap/1.0/\0"
_PNG_XMP = b"XML:com.adobe.xmp\0\0\0"


@dataclass(frozen=True)
class ShotTags:
    """Tags of a shot by EXIF's names; fractions are pairs.

    Attributes:
        exif: Tags of EXIF.
        xmp: Properties of XMP, which other programs write, and which may be old.
        notes: Parts that cannot be read.
    """

    exif: dict[str, Any] = field(default_factory=dict)
    xmp: dict[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def read_tags(path: Path) -> ShotTags:
    """Reads the tags of a file; other formats have none."""
    with opened(path) as file, reading(path):
        head = file.read(12)
        if head[:2] in (b"II", b"MM"):
            with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                exif = exif_tags(data)
            return _tags(exif, exif.pop("XMP", b""))
        blocks = dict(reversed(list(_blocks(file, head))))  # the first of each
    exif = exif_tags(blocks.get("exif", b"").removeprefix(_EXIF))
    exif.pop("XMP", None)
    return _tags(exif, blocks.get("xmp", b""))


def _tags(exif: dict[str, Any], packet: object) -> ShotTags:
    if not isinstance(packet, bytes) or not packet:
        return ShotTags(exif)
    xmp = xmp_tags(packet)
    if xmp is None:
        return ShotTags(exif, {}, ("XMP: ignored, as it is not XML without document type",))
    return ShotTags(exif, xmp)


def _blocks(file: BinaryIO, head: bytes) -> Iterator[tuple[str, bytes]]:
    if head[:2] == b"\xff\xd8":
        yield from _of_jpeg(file)
    elif head[:8] == b"\x89PNG\r\n\x1a\n":
        yield from _of_png(file)
    elif head[:4] == b"RIFF" and head[8:12] == b"WEBP":
        yield from _of_webp(file)


def _of_jpeg(file: BinaryIO) -> Iterator[tuple[str, bytes]]:
    """Segments before the picture: marker, and a length that includes itself."""
    file.seek(2)
    while len(head := file.read(4)) == 4 and head[0] == 0xFF:
        if head[1] == 0xFF:  # fill bytes
            file.seek(-3, 1)
            continue
        marker, length = head[1], int.from_bytes(head[2:], "big")
        if marker == 0xDA or length < 2:  # the picture begins
            return
        data = file.read(length - 2)
        if marker == 0xE1 and data.startswith(_EXIF):
            yield "exif", data.removeprefix(_EXIF)
        elif marker == 0xE1 and data.startswith(_XMP):
            yield "xmp", data.removeprefix(_XMP)


def _of_png(file: BinaryIO) -> Iterator[tuple[str, bytes]]:
    for chunk in png_chunks.chunks(file):
        if chunk.kind == b"eXIf":
            yield "exif", chunk.data
        elif chunk.kind == b"iTXt" and chunk.data.startswith(_PNG_XMP):  # not compressed
            # Language and translated keyword precede the text, each with a zero byte.
            yield "xmp", chunk.data.removeprefix(_PNG_XMP).split(b"\0", 2)[-1]


def _of_webp(file: BinaryIO) -> Iterator[tuple[str, bytes]]:
    file.seek(12)
    while len(head := file.read(8)) == 8:
        (size,) = struct.unpack("<I", head[4:])
        if head[:4] in (b"EXIF", b"XMP "):
            yield "exif" if head[:4] == b"EXIF" else "xmp", file.read(size)
            file.seek(size % 2, 1)
        else:
            file.seek(size + size % 2, 1)
