"""Checks Radiance pictures before they are decoded.

Source: Greg Ward, "Real Pixels", and filefmts.pdf of Radiance.
"""

from __future__ import annotations

import re

from daguerre.errors import InputError

from .size import check_size
from .source import PictureBytes

_SIZE = re.compile(rb"\n\n([+-])[XY] (\d{1,9}) ([+-])[XY] (\d{1,9})\n")


def check(source: PictureBytes, where: str, limit: int) -> None:
    """Checks the size; each line of pixels takes four bytes or more.

    Raises:
        InputError: The size is missing or too large, or the file is too short for it.
    """
    found = _SIZE.search(source.at(0, 1 << 16).replace(b"\r\n", b"\n"))
    if found is None:
        raise InputError(f"{where}: cannot be decoded: a Radiance file without a size")
    height, width = int(found[2]), int(found[4])
    check_size(width, height, 3, 4, where, limit)
    if source.size - found.end() < 4 * min(width, height):
        raise InputError(
            f"{where}: cannot be decoded: {source.size} bytes cannot hold {width}x{height} pixels"
        )
