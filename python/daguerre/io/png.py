"""PNG for the eye: 8 bits, sRGB, with what a photographer expects in the EXIF block."""

from __future__ import annotations

import os
import zlib
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import OutputError

from .atomic import atomic_path

if TYPE_CHECKING:
    from daguerre.frame import Frame

#: metadata name -> EXIF name in OpenImageIO
EXIF = {
    "expTime": "ExposureTime",
    "aperture": "FNumber",
    "nominalFocalLength": "Exif:FocalLength",
    "lensModel": "Exif:LensModel",
    "lensMake": "Exif:LensMake",
}


def write_png(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes the display picture of a frame, atomically."""
    pixels = frame.display(tone)
    with atomic_path(path) as temp:
        reason = _write(temp, pixels, frame.metadata)
        if reason:
            raise OutputError(f"{path}: cannot write: {reason.replace(str(temp), str(path))}")


def write_pixels(path: Path, pixels: NDArray[np.uint8]) -> None:
    """Writes (H, W, 3) uint8 that are no frame's.

    Raises:
        OutputError: It cannot be written.
    """
    if reason := _write(path, pixels, {}):
        raise OutputError(f"{path}: cannot write: {reason}")


def png_bytes(frame: Frame, tone: str = "srgb") -> bytes:
    """The same file as bytes, for notebooks."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "frame.png"
        reason = _write(path, frame.display(tone), frame.metadata)
        if reason:
            raise OutputError(f"{path}: cannot write: {reason}")
        return path.read_bytes()


def _write(path: Path, pixels: NDArray[np.uint8], metadata: dict[str, Any]) -> str:
    """Writes (H, W, 3) uint8; returns what went wrong, or an empty text."""
    import OpenImageIO as oiio

    output = oiio.ImageOutput.create(str(path))
    if output is None:
        return str(oiio.geterror())
    height, width, count = pixels.shape
    spec = oiio.ImageSpec(width, height, count, oiio.UINT8)
    spec.attribute("oiio:ColorSpace", "sRGB")
    spec.attribute("Software", f"daguerre {metadata.get('version', '')}".strip())
    for key, name in EXIF.items():
        if metadata.get(key):
            value = metadata[key]
            spec.attribute(name, value if isinstance(value, str) else float(value))
    if metadata.get("isoSpeed"):
        spec.attribute("Exif:PhotographicSensitivity", round(float(metadata["isoSpeed"])))
    done = output.open(str(path), spec) and output.write_image(pixels) and output.close()
    if not done:
        return str(output.geterror() or "unknown reason")
    # libpng's writer does not notice a full disk, so what is there is read back.
    return "" if _intact(path.read_bytes()) else "the file is not complete; is the disk full?"


def _intact(data: bytes) -> bool:
    """Whether every chunk has its checksum and the last one is IEND (PNG specification, 5.3)."""
    place = 8
    while place + 12 <= len(data):
        length = int.from_bytes(data[place : place + 4], "big")
        end = place + 8 + length
        checksum = int.from_bytes(data[end : end + 4], "big")
        if end + 4 > len(data) or zlib.crc32(data[place + 4 : end]) != checksum:
            return False
        if data[place + 4 : place + 8] == b"IEND":
            return end + 4 == len(data)
        place = end + 4
    return False
