"""Reads photographs by the suffix of their file names."""

from __future__ import annotations

import os
from pathlib import Path

from daguerre.files.reading import size_of

from .display_file import read_display
from .linear_file import read_linear
from .photograph import Photograph
from .raw_file import read_raw

DISPLAY = (".jpg", ".jpeg", ".png", ".tif", ".tiff", ".webp")


def read(path: str | os.PathLike[str]) -> Photograph:
    """Reads a photograph; the suffix of its name sets the format.

    Args:
        path: ``.jpg``, ``.png``, ``.tif``: developed; ``.exr``: linear light; any other suffix,
            such as ``.dng``: a raw file that LibRaw reads.

    Raises:
        InputError: There is no such file, or it has no RGB or grey picture.
    """
    file = Path(path)
    size_of(file)
    suffix = file.suffix.lower()
    if suffix == ".exr":
        return read_linear(file)
    return read_display(file) if suffix in DISPLAY else read_raw(file)
