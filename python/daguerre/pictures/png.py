"""Writes display pictures as PNG: 8 bits, sRGB, with exposure and lens in EXIF."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import OutputError
from daguerre.files.atomic import atomic_path

from . import exif
from .png_chunks import checksum, chunks, is_complete

#: EXIF name in OpenImageIO by metadata name.
EXIF = {
    "expTime": "ExposureTime",
    "aperture": "FNumber",
    "nominalFocalLength": "Exif:FocalLength",
    "lensModel": "Exif:LensModel",
    "lensMake": "Exif:LensMake",
}


class PngWriter:
    """Writes a PNG row by row, so that memory holds only the rows in work."""

    def __init__(
        self,
        path: Path,
        width: int,
        height: int,
        metadata: Mapping[str, Any] = {},
        *,
        target: str | os.PathLike[str] | None = None,
    ) -> None:
        """Opens a file.

        Args:
            path: File; use :func:`daguerre.files.atomic.atomic_path` for an atomic write.
            width: Columns, px.
            height: Rows, px.
            metadata: Metadata of a frame; EXIF gets exposure and lens from it.
            target: Name for messages; default: ``path``.

        Raises:
            OutputError: The file cannot be written.
        """
        import OpenImageIO as oiio

        self._path, self._name, self._next = path, str(target or path), 0
        output = oiio.ImageOutput.create(str(path))
        if output is None:
            raise self._error(str(oiio.geterror()))
        self._output = output
        spec = oiio.ImageSpec(width, height, 3, oiio.UINT8)
        spec.attribute("oiio:ColorSpace", "sRGB")
        spec.attribute("Software", f"daguerre {metadata.get('version', '')}".strip())
        for key, name in EXIF.items():
            if metadata.get(key):
                value = metadata[key]
                spec.attribute(name, value if isinstance(value, str) else float(value))
        if metadata.get("isoSpeed"):
            spec.attribute("Exif:PhotographicSensitivity", round(float(metadata["isoSpeed"])))
        self._rationals = exif.rationals(metadata)
        self._check(self._output.open(str(path), spec))

    def write(self, pixels: NDArray[np.uint8]) -> None:
        """Writes the next rows, shape (rows, W, 3).

        Raises:
            OutputError: The disk is full, or not available.
        """
        end = self._next + len(pixels)
        rows = np.ascontiguousarray(pixels)
        self._check(self._output.write_scanlines(self._next, end, 0, rows))
        self._next = end

    def close(self) -> None:
        """Completes the file.

        Raises:
            OutputError: The disk is full, or not available.
        """
        self._check(self._output.close())
        with self._path.open("r+b") as file:
            _put_rationals(file, self._rationals)
        # libpng may not notice a full disk, so the file is read back.
        with self._path.open("rb") as file:
            if not is_complete(file):
                raise self._error("the file is not complete; is the disk full?")

    def _check(self, done: bool) -> None:
        # OpenImageIO may return success and keep an error, with a line for each block.
        if not done or self._output.has_error:
            lines = str(self._output.geterror()).splitlines() or ["unknown reason"]
            raise self._error(lines[0].strip())

    def _error(self, reason: str) -> OutputError:
        reason = reason.replace(str(self._path), self._name)
        return OutputError(f"{self._name}: cannot write: {reason}")


def write_png(
    path: str | os.PathLike[str], pixels: NDArray[np.uint8], metadata: Mapping[str, Any]
) -> None:
    """Writes a picture atomically; see :class:`PngWriter`."""
    height, width = pixels.shape[:2]
    with atomic_path(path) as temp:
        writer = PngWriter(temp, width, height, metadata, target=path)
        writer.write(pixels)
        writer.close()


def _put_rationals(file: BinaryIO, values: Mapping[int, tuple[int, int]]) -> None:
    """Sets short fractions such as 1/48 in the EXIF chunk, which comes before the pixels."""
    for chunk in chunks(file):
        if chunk.kind == b"eXIf" and chunk.intact:
            block = exif.with_rationals(chunk.data, values)
            file.seek(chunk.at)
            file.write(block + checksum(b"eXIf", block))
        if chunk.kind in (b"eXIf", b"IDAT"):
            return
