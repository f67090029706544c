"""Photographs from files, by the end of their names."""

from __future__ import annotations

import os
from pathlib import Path

from daguerre.errors import InputError

from .display_file import read_display
from .linear_file import read_linear
from .photograph import Photograph
from .raw_file import read_raw

DISPLAY = (".jpg", ".jpeg", ".png", ".tif", ".tiff", ".webp")


def read(path: str | os.PathLike[str]) -> Photograph:
    """Reads a photograph by the end of its name.

    Args:
        path: ``.jpg``, ``.png``, ``.tif``: developed; ``.exr``: linear light; others are raw files,
            ``.dng`` and what else LibRaw reads.

    Raises:
        InputError: It is no such file, or holds no picture of red, green and blue, or grey.
    """
    file = Path(path)
    if not file.is_file():
        got = "a folder" if file.is_dir() else "no such file"
        raise InputError(f"{file}: wanted a photograph, got {got}")
    suffix = file.suffix.lower()
    if suffix == ".exr":
        return read_linear(file)
    return read_display(file) if suffix in DISPLAY else read_raw(file)
