"""Writes pictures into the folder of a scene: PNG for 8 bits, else EXR of 32-bit floats."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import OutputError
from daguerre.pictures import exif

from .folder import OutgoingFolder


def write_pixels(folder: OutgoingFolder, kind: str, pixels: NDArray[Any]) -> str:
    """Writes pixels of shape (H, W, 1 or 3); returns the path relative to the scene file.

    Raises:
        OutputError: The file cannot be written.
    """
    pixels = np.ascontiguousarray(pixels)
    content = hashlib.sha256(f"{pixels.dtype}{pixels.shape}".encode())
    content.update(pixels.data)
    suffix = ".png" if pixels.dtype == np.uint8 else ".exr"
    return folder.write(kind, suffix, content, lambda path: _write(path, pixels))


def _write(path: Path, pixels: NDArray[Any]) -> None:
    import OpenImageIO as oiio

    height, width, channels = pixels.shape
    eight = pixels.dtype == np.uint8
    spec = oiio.ImageSpec(width, height, channels, oiio.UINT8 if eight else oiio.FLOAT)
    spec.channelnames = ("Y",) if channels == 1 else ("R", "G", "B")
    if not eight:
        spec.attribute("compression", "zip")
        spec.attribute("DateTime", exif.date({}))
    output = oiio.ImageOutput.create(str(path))
    if output is None:
        raise _error(path, str(oiio.geterror()))
    if not (output.open(str(path), spec) and output.write_image(pixels) and output.close()):
        raise _error(path, str(output.geterror()))


def _error(path: Path, reason: str) -> OutputError:
    first = (reason.splitlines() or ["unknown reason"])[0]
    return OutputError(f"{path.parent}: cannot write: {first}")
