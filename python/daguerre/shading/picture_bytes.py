"""Bytes of pictures, from files and packages, and their pixels.

Source: the usdz specification (https://openusd.org/release/spec_usdz.html).
"""

from __future__ import annotations

import os
import re
import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre import memory
from daguerre.errors import InputError, asked_by
from daguerre.files.json_item import short
from daguerre.files.reading import opened, read_bytes
from daguerre.pictures import images
from daguerre.pictures.exr.reader import ExrReader, is_exr, light_names
from daguerre.pictures.light import checked_light, read_light
from daguerre.pictures.reading import kinds
from daguerre.pictures.reading.size import MAX_BYTES
from daguerre.pictures.stated_colors import PLAIN, Colors, of_exr


class UnknownFormat(InputError):
    """Reports a picture of a suffix and a content that no reader knows, such as a Ptex."""


def decoded(data: bytes, name: str, where: str) -> tuple[NDArray[Any], Colors]:
    """Decodes a picture of any kind that :mod:`daguerre.pictures.reading` reads, or OpenEXR.

    Args:
        data: Bytes of the file.
        name: Name of the file; its suffix chooses between formats without a mark.
        where: Place and path, for messages.

    Returns:
        Pixels as in the file, shape (H, W, 1..4), uint8 or float32; and their colour encoding.

    Raises:
        InputError: The picture is damaged or too large.
        UnknownFormat: Neither the bytes nor the name are a picture's.
    """
    if images.is_of_gltf(data):
        return images.decode(data, where), PLAIN
    descriptor, temporary = tempfile.mkstemp(suffix=_suffix(name), prefix="daguerre-")
    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(data)
        return _other(Path(temporary))
    except InputError as error:
        kind = InputError if is_known(name) else UnknownFormat
        raise kind(str(error).replace(temporary, where)) from None
    finally:
        Path(temporary).unlink(missing_ok=True)


def is_known(name: str) -> bool:
    """Whether a picture has no suffix, or one that a reader knows."""
    suffix = _suffix(name).lower().removeprefix(".")
    return suffix in ("", "ktx2") or kinds.is_known(suffix)


def _suffix(name: str) -> str:
    """Suffix of a name, of letters and digits."""
    return re.sub(r"[^.A-Za-z0-9]", "", Path(name).suffix)[:16]


def _exr(file: Path) -> tuple[NDArray[np.float32], Colors]:
    """Reads the data window of an OpenEXR; textures may be negative, but are finite."""
    with ExrReader(file) as reader:
        size = reader.width * reader.height * 16
        if size > MAX_BYTES:
            most = memory.shown(MAX_BYTES)
            raise InputError(f"{file}: image size: the limit is {most}")
        names = light_names(list(reader.channels), str(file))
        colors = of_exr(reader.facts, tuple(names))
        names += [name for name in reader.channels if name == "A"]
        planes = reader.rows(0, reader.height, list(dict.fromkeys(names)))
    pixels = np.stack([planes[name] for name in names], axis=2).astype(np.float32)
    return np.nan_to_num(pixels, nan=0.0, posinf=0.0, neginf=0.0), colors


def _other(file: Path) -> tuple[NDArray[Any], Colors]:
    """Decodes a format that glTF does not have: light as it is, integers to 0 .. 1."""
    if is_exr(file):
        return _exr(file)
    with opened(file) as stream:
        if stream.read(2) == b"#?":
            light, colors = read_light(file)
            return checked_light(file, light), colors
    pixels = images.read_file(file)[:, :, :4]
    if pixels.dtype == np.uint8:
        return np.ascontiguousarray(pixels), PLAIN
    if np.issubdtype(pixels.dtype, np.integer):
        return (pixels / np.float64(np.iinfo(pixels.dtype).max)).astype(np.float32), PLAIN
    return np.nan_to_num(pixels.astype(np.float32), posinf=0.0, neginf=0.0), PLAIN


def bytes_of(file: Path, where: str) -> bytes:
    """Bytes of a file, if there are not too many."""
    with asked_by(where):
        return read_bytes(file, MAX_BYTES)


@contextmanager
def opened_package(file: Path, where: str) -> Iterator[zipfile.ZipFile]:
    """Opens a package; a damaged package is an error."""
    try:
        with opened(file) as stream, zipfile.ZipFile(stream) as archive:
            yield archive
    except (zipfile.BadZipFile, EOFError, NotImplementedError, OSError, RuntimeError) as error:
        raise InputError(f"{where}: wanted a usdz package, got {short(str(error))}") from None


def member(archive: zipfile.ZipFile, name: str, where: str) -> bytes:
    """Bytes of a file in a package, which stores them without compression (usdz specification)."""
    info = archive.getinfo(name)
    if info.compress_type != zipfile.ZIP_STORED or info.file_size > MAX_BYTES:
        raise InputError(f"{where}: the file in the package is compressed or too large")
    return archive.read(name)
