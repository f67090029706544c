"""Reads COLMAP's binary models: ``cameras.bin`` and ``images.bin``, little-endian.

Source: COLMAP, "Output Format" and src/colmap/scene/reconstruction_io.cc; numbers of models are
from src/colmap/sensor/models.h.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import BinaryIO, NoReturn

from daguerre.errors import InputError
from daguerre.files.reading import not_utf8, opened, reading

from .colmap_rows import MOST, CameraRow, ImageRow

#: Models by number.
NAMES = (
    *("SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "OPENCV_FISHEYE"),
    *("FULL_OPENCV", "FOV", "SIMPLE_RADIAL_FISHEYE", "RADIAL_FISHEYE", "THIN_PRISM_FISHEYE"),
    "RAD_TAN_THIN_PRISM_FISHEYE",
)
#: Largest file (mostly points), and longest name of a picture, bytes.
MAX_BYTES, _LONGEST_NAME = 1 << 33, 4096
_POINT_BYTES = 24


class _ColmapReader:
    """Reads numbers in order; a file that ends too early is an error."""

    def __init__(self, file: BinaryIO, path: Path) -> None:
        self.file, self.path = file, path
        self.size = os.fstat(file.fileno()).st_size

    def take(self, form: str) -> tuple[float, ...]:
        data = self.file.read(struct.calcsize("<" + form))
        if len(data) < struct.calcsize("<" + form):
            self.truncated()
        return struct.unpack("<" + form, data)

    def count(self, least_bytes: int) -> int:
        """A count of things that have at least so many bytes each."""
        (count,) = self.take("Q")
        if count * least_bytes > self.size - self.file.tell():
            self.truncated()
        return int(count)

    def name(self) -> str:
        """A text up to its zero byte."""
        start = self.file.tell()
        data = self.file.read(_LONGEST_NAME)
        end = data.find(b"\0")
        if end < 0:
            self.truncated()
        self.file.seek(start + end + 1)
        try:
            return data[:end].decode("utf-8")
        except UnicodeDecodeError as error:
            raise InputError(f"{self.path}: name of a picture: {not_utf8(error)}") from None

    def truncated(self) -> NoReturn:
        raise InputError(f"{self.path}: truncated: the file ends at byte {self.size}")


def cameras(path: Path, counts: Mapping[str, int]) -> Iterator[CameraRow]:
    """Yields the cameras of a ``cameras.bin``.

    Args:
        path: The file.
        counts: Number of parameters by model, which gives the length of a camera.

    Raises:
        InputError: The file cannot be read, or has another model.
    """
    with opened(path, MAX_BYTES) as file, reading(path):
        reader = _ColmapReader(file, path)
        for index in range(reader.count(48)):
            camera, model, width, height = (int(v) for v in reader.take("IiQQ"))
            where = f"{path}: camera {index + 1}"
            name = NAMES[model] if 0 <= model < len(NAMES) else f"number {model}"
            if name not in counts:
                raise InputError(f"{where}: model: wanted {', '.join(counts)}; got {name}")
            numbers = list(reader.take(f"{counts[name]}d"))
            _check(numbers, where)
            yield CameraRow(where, str(camera), name, (width, height), numbers)


def images(path: Path) -> Iterator[ImageRow]:
    """Yields the pictures of an ``images.bin``; their points are skipped.

    Raises:
        InputError: The file cannot be read.
    """
    with opened(path, MAX_BYTES) as file, reading(path):
        reader = _ColmapReader(file, path)
        for index in range(reader.count(73)):
            where = f"{path}: picture {index + 1}"
            _, *pose = reader.take("I7d")
            _check(pose, where)
            (camera,) = reader.take("I")
            name = reader.name()
            file.seek(reader.count(_POINT_BYTES) * _POINT_BYTES, 1)
            yield ImageRow(where, pose, str(int(camera)), name)


def _check(numbers: list[float], where: str) -> None:
    wrong = next((value for value in numbers if not abs(value) < MOST), None)
    if wrong is not None:
        raise InputError(f"{where}: wanted a finite number below 1e15 in size, got {wrong:g}")
