"""Decodes pictures in a process apart: OpenImageIO's readers of rare formats overran buffers.

Only that process crashes; :mod:`daguerre.pictures.decoder` has it write plain pixels into a
temporary file, which our own reader reads.
"""

from __future__ import annotations

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from numpy.typing import NDArray

from daguerre.pictures import decoder

from . import tiff
from .kinds import Kind
from .size import check_size
from .source import PictureBytes

#: Time limit: seconds for any picture, and bytes of its file per second in addition.
PATIENCE, PACE = 30.0, 10e6


def read(
    source: PictureBytes, kind: Kind, where: str, limit: int, *, straight: bool
) -> tuple[NDArray[Any], list[str], int]:
    """Reads the first picture of a file.

    Args:
        source: The picture.
        kind: Kind of the picture.
        where: Place of the picture, for messages.
        limit: Most bytes of its pixels.
        straight: Whether alpha is straight; otherwise colours are premultiplied.

    Returns:
        Pixels in the type of the file, shape (H, W, C); names of channels; EXIF orientation.

    Raises:
        InputError: The picture cannot be decoded or is too large, or the process failed.
    """
    with TemporaryDirectory(prefix="daguerre-") as folder, source.file(kind.suffixes) as name:
        target = Path(folder, "plain.tif")
        seconds = PATIENCE + source.size / PACE
        wanted = decoder.Wanted("tiff", target, limit, seconds, straight)
        output = decoder.run(name, wanted, where, kind.title)
        plain = PictureBytes(target)
        pixels = tiff.plain_pixels(plain, where, limit)
    height, width, channels = pixels.shape
    check_size(width, height, channels, pixels.dtype.itemsize, where, limit)
    try:
        facts = json.loads(output)
        names, turn = [str(name) for name in facts["names"]], int(facts["orientation"])
    except (ValueError, KeyError, TypeError, RecursionError):
        names, turn = [], 1
    if len(names) != channels:
        names = list("RGBA"[:channels]) if channels != 1 else ["Y"]
    return pixels, names, turn if 1 <= turn <= 8 else 1
