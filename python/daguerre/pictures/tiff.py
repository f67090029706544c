"""Writes TIFF files with any tags and an EXIF directory, by tifffile."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.files import extras

from . import exif
from .exif import Tags

#: Photometric interpretation of mosaics, and of raw pictures without a mosaic.
CFA, LINEAR_RAW = 32803, 34892
_PHOTOMETRIC, _CHILDREN = 262, 330
#: Placeholder for the tag of the EXIF directory, which tifffile cannot write; this number is unused
#: and is replaced afterwards.
_PLACE = exif.EXIF_DIRECTORY + 1
#: Types with two numbers per value.
_PAIRS = (exif.RATIONAL, exif.SRATIONAL)


@dataclass(frozen=True)
class TiffImage:
    """One image of a file.

    Attributes:
        pixels: Shape (H, W) or (H, W, 3), uint8 or uint16.
        photometric: Photometric interpretation: tifffile's name, or the number.
        tags: Additional tags.
        reduced: Whether it is a thumbnail of the main picture.
    """

    pixels: NDArray[Any]
    photometric: str | int
    tags: Tags = field(default_factory=dict)
    reduced: bool = False

    @property
    def grey_raw(self) -> bool:
        """Whether it is a raw picture of one sample per pixel, without a mosaic."""
        return self.photometric == LINEAR_RAW and self.pixels.ndim == 2


def write_tiff(target: Path | IO[bytes], images: list[TiffImage], exposure: Tags) -> None:
    """Writes images, later images as children of the first, and the EXIF directory.

    Args:
        target: File, which is replaced, or stream, which is written from its start.
        images: Images; simple readers show the first.
        exposure: Tags of the EXIF directory.

    Raises:
        UsageError: The package tifffile is not installed.
    """
    if isinstance(target, Path):
        with target.open("w+b") as stream:
            write_tiff(stream, images, exposure)
        return
    extras.need("tifffile", "a TIFF or DNG file")
    import tifffile

    with tifffile.TiffWriter(target, byteorder="<") as writer:
        for k, image in enumerate(images):
            tags = dict(image.tags) if k else image.tags | {_PLACE: (exif.LONG, (0,))}
            writer.write(
                image.pixels,
                photometric="minisblack" if image.grey_raw else image.photometric,
                subfiletype=int(image.reduced),
                subifds=len(images) - 1 if k == 0 and len(images) > 1 else None,
                extratags=[_extra(n, kind, value) for n, (kind, value) in sorted(tags.items())],
                metadata=None,
                software=False,
            )
    _append_exposure(target, exposure)
    if len(images) == 2:  # DNG has a LONG; tifffile writes the type IFD
        place, child = _entry(target, _first_directory(target), _CHILDREN)
        _set_entry(target, place, (_CHILDREN, exif.LONG, 1, child))
    if images[-1].grey_raw:  # tifffile needs three samples for it
        at = _first_directory(target)
        if len(images) > 1:
            at = _entry(target, at, _CHILDREN)[1]
        place, _ = _entry(target, at, _PHOTOMETRIC)
        _set_entry(target, place, (_PHOTOMETRIC, exif.SHORT, 1, LINEAR_RAW))


def _extra(number: int, kind: int, value: Any) -> tuple[int, int, int, Any, bool]:
    """Converts a tag to tifffile's form."""
    if kind == exif.ASCII:
        return number, kind, 0, value.encode("utf-8"), True
    count = len(value) // (2 if kind in _PAIRS else 1)
    if kind in (exif.BYTE, exif.UNDEFINED):
        value = bytes(value)
    return number, kind, count, value, True


def _append_exposure(stream: IO[bytes], exposure: Tags) -> None:
    """Appends the EXIF directory and points the first directory to it."""
    end = stream.seek(0, 2)
    stream.write(b"\0" * (end % 2) + exif.directory(exposure, end + end % 2))
    place, _ = _entry(stream, _first_directory(stream), _PLACE)
    _set_entry(stream, place, (exif.EXIF_DIRECTORY, exif.LONG, 1, end + end % 2))


def _first_directory(stream: IO[bytes]) -> int:
    stream.seek(4)
    return int(struct.unpack("<I", stream.read(4))[0])


def _entry(stream: IO[bytes], directory: int, tag: int) -> tuple[int, int]:
    """Position of a directory's entry in the file, and its value or the position of its values."""
    stream.seek(directory)
    (count,) = struct.unpack("<H", stream.read(2))
    entries = np.frombuffer(stream.read(12 * count), "<u2,<u2,<u4,<u4")
    k = int(np.flatnonzero(entries["f0"] == tag)[0])
    return directory + 2 + 12 * k, int(entries["f3"][k])


def _set_entry(stream: IO[bytes], place: int, entry: tuple[int, int, int, int]) -> None:
    stream.seek(place)
    stream.write(struct.pack("<HHII", *entry))
