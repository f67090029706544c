"""PNG for the eye: 8 bits, sRGB, with what a photographer expects in the EXIF block."""

from __future__ import annotations

import os
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
from daguerre.errors import OutputError
from numpy.typing import NDArray

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
    return "" if done else str(output.geterror() or "unknown reason")
