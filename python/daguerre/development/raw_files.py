"""Writes raw pictures to files, for the table of formats."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from daguerre.errors import UsageError
from daguerre.files.atomic import atomic_path
from daguerre.frame.raw import Raw

from .binning import bayer_of
from .dng import put_dng
from .preview import preview_of
from .recipe import develop


def write_dng(path: str | os.PathLike[str], raw: Raw) -> None:
    """Writes a raw picture, whole or not at all.

    A Quad-Bayer mosaic is binned as in cameras, 2 x 2 photosites to a pixel: no reader knows its
    pattern of four by four.

    Args:
        path: File to write; the name should end in ``.dng``.
        raw: The picture.

    Raises:
        OutputError: The file cannot be written.
    """
    with atomic_path(path) as temp:
        binned = bayer_of(raw)
        put_dng(temp, binned, preview_of(binned))


def as_dng(path: str | os.PathLike[str], raw: Raw, **look: object) -> None:
    """Writes the undeveloped values as DNG.

    Raises:
        UsageError: A parameter of development is given.
    """
    if look:
        raise UsageError(f"{Path(path)}: a DNG is not developed: leave out {', '.join(look)}")
    write_dng(path, raw)


def as_picture(path: str | os.PathLike[str], raw: Raw, **look: Any) -> None:
    """Develops and writes the picture; ``quality`` and ``bits`` set the file format."""
    files = {name: look.pop(name) for name in ("quality", "bits") if name in look}
    develop(raw, **look).save(path, **files)
