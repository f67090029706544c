"""Reads a picture by the reader of its kind, after checks of its head."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import apart, jpeg, library, png, radiance, targa, tiff, webp
from .kinds import kind_of
from .size import MAX_BYTES
from .source import PictureBytes

#: Checks before a kind is decoded in this process; a check returns False to decode apart instead.
_CHECKS: dict[str, Callable[[PictureBytes, str, int], bool | None]] = {
    "png": png.check,
    "jpeg": jpeg.check,
    "webp": webp.check,
    "hdr": radiance.check,
    "tiff": tiff.check,
    "targa": targa.check,
}


@dataclass(frozen=True)
class FilePicture:
    """A picture with the numbers of its file.

    Attributes:
        pixels: Shape (H, W, C), not turned upright.
        names: Names of the channels.
        orientation: EXIF orientation, 1 to 8.
        kind: Name of its kind; see :mod:`daguerre.pictures.reading.kinds`.
    """

    pixels: NDArray[Any]
    names: tuple[str, ...]
    orientation: int
    kind: str


def read(
    source: PictureBytes, where: str, limit: int = MAX_BYTES, *, floats: bool = False
) -> FilePicture:
    """Reads the first picture of a file, other than OpenEXR.

    Args:
        source: The picture.
        where: Place of the picture, for messages.
        limit: Most bytes of its pixels.
        floats: Return float32: integers scaled to 0 .. 1, premultiplied by alpha; otherwise the
            type of the file, with straight alpha.

    Raises:
        InputError: It cannot be decoded, is truncated or too large; UnknownPicture: it is of none
            of the kinds of :mod:`daguerre.pictures.reading.kinds`.
    """
    kind = kind_of(source, where)
    if kind.here and _CHECKS[kind.name](source, where, limit) is not False:
        with source.file(kind.suffixes) as name:
            pixels, spec = library.read(name, where, limit, floats=floats)
        turn = spec.get_int_attribute("Orientation", 1)
        return FilePicture(pixels, tuple(str(name) for name in spec.channelnames), turn, kind.name)
    pixels, names, turn = apart.read(source, kind, where, limit, straight=not floats)
    if floats and np.issubdtype(pixels.dtype, np.integer):
        pixels = pixels.astype(np.float32) / np.float32(np.iinfo(pixels.dtype).max)
    elif floats:
        pixels = pixels.astype(np.float32)
    return FilePicture(pixels, tuple(names), turn, kind.name)
