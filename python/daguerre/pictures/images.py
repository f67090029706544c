"""Decodes pictures: textures from bytes, environments from files.

:mod:`daguerre.pictures.reading` reads them. OpenImageIO's Python wheel cannot read from memory, so
bytes pass through a temporary file.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.json_item import short

from . import ktx2
from .reading.kinds import KINDS
from .reading.read import read
from .reading.size import check_size
from .reading.source import PictureBytes

#: Kinds of pictures that glTF has beside KTX2.
_OF_GLTF = ("png", "jpeg", "webp")


def decode(data: bytes | memoryview, where: str) -> NDArray[np.uint8] | NDArray[np.float32]:
    """Decodes a PNG, JPEG, WebP or KTX2 image; straight alpha, row 0 at the top.

    Args:
        data: Bytes of the file.
        where: File and JSON path, for messages.

    Returns:
        Shape (H, W, 1..4); uint8, or float32 in 0 .. 1 from 16-bit pictures, as 8 bits would show
        steps in normal maps.

    Raises:
        InputError: The format is another, or the image is truncated, corrupt or too large.
    """
    data = bytes(data)
    if data.startswith(ktx2.MAGIC):
        check_size(*ktx2.size(data, where), 4, 1, where)
        return ktx2.decode(data, where)
    if not is_of_gltf(data):
        raise InputError(f"{where}: wanted a PNG, JPEG, WebP or KTX2 image, got {short(data[:8])}")
    pixels = read(PictureBytes(data=data), where).pixels
    if pixels.shape[2] > 4:
        raise InputError(f"{where}: wanted 1 to 4 channels, got {pixels.shape[2]}")
    if pixels.dtype == np.uint8:
        return pixels
    if pixels.dtype == np.uint16:
        return pixels.astype(np.float32) / np.float32(65535)
    return pixels.astype(np.float32)


def is_of_gltf(start: bytes) -> bool:
    """Whether a file begins as a PNG, JPEG, WebP or KTX2."""
    return start.startswith(ktx2.MAGIC) or any(
        kind.matches(start) for kind in KINDS if kind.name in _OF_GLTF
    )


def read_file(path: Path, *, floats: bool = False) -> NDArray[Any]:
    """Reads pixels in the type of the file, shape (H, W, C), not turned upright.

    Args:
        path: Picture of any kind of :mod:`daguerre.pictures.reading`.
        floats: Return float32 instead: integers scaled to 0 .. 1, premultiplied by alpha.

    Returns:
        The pixels, with straight alpha unless ``floats``.

    Raises:
        InputError: The file cannot be decoded, is truncated or too large.
    """
    from .exr.reader import is_exr

    source = PictureBytes(path)
    if is_exr(path):
        raise InputError(f"{path}: OpenEXR is not supported here")
    return read(source, str(path), floats=floats).pixels


def upright(pixels: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Undoes EXIF orientation 1 .. 8 of a picture, shape (H, W) or (H, W, C)."""
    if orientation >= 5:
        pixels = pixels.swapaxes(0, 1)
    if orientation in (2, 3, 6, 7):
        pixels = pixels[:, ::-1]
    if orientation in (3, 4, 7, 8):
        pixels = pixels[::-1]
    return pixels
