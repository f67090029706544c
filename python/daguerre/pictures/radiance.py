"""Headers of Radiance pictures (.hdr, .pic): exposure and colours.

Source: Radiance, "File Formats" (filefmts.pdf) and ``color.h``: EXPOSURE and COLORCORR multiply
light and accumulate; PRIMARIES has x and y of red, green, blue and white; numbers of the format
``32-bit_rle_xyze`` are CIE XYZ in which white is (1, 1, 1).
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.color.encodings import XYZ_E
from daguerre.errors import InputError
from daguerre.files.reading import opened

from .stated_colors import PLAIN, Colors, of_primaries

_MAGIC, _XYZE, _RGBE = b"#?", b"32-bit_rle_xyze", b"32-bit_rle_rgbe"
#: Most bytes of a header: its lines list the commands that made the picture.
_MOST = 1 << 20


@dataclass(frozen=True)
class RadianceHeader:
    """The header of a Radiance picture.

    Attributes:
        gains: Factors on the stored numbers, shape (3,).
        colors: Colour encoding of the numbers.
        format_at: Place of the format's name in the file if the numbers are XYZ, else None.
    """

    gains: NDArray[np.float64]
    colors: Colors
    format_at: int | None = None


def is_radiance(file: Path) -> bool:
    """Whether a file begins like a Radiance picture."""
    with opened(file) as stream:
        return stream.read(2) == _MAGIC


def read_header(file: Path) -> RadianceHeader:
    """Reads exposure and colours.

    Raises:
        InputError: A line of the header has an invalid number.
    """
    gains, corners, format_at = np.ones(3), None, None
    for at, line in _lines(file):
        name, equals, value = line.partition(b"=")
        if not equals:
            continue
        if name == b"EXPOSURE":
            gains *= _numbers(file, "EXPOSURE", value, 1)
        elif name == b"COLORCORR":
            gains *= _numbers(file, "COLORCORR", value, 3)
        elif name == b"PRIMARIES":
            corners = _numbers(file, "PRIMARIES", value, 8)
        elif name == b"FORMAT" and value.strip() == _XYZE:
            format_at = at + line.index(_XYZE)
        if not ((gains > 1e-30) & (gains < 1e30)).all():
            said = name.decode("ascii")
            raise InputError(f"{file}: {said}: wanted a positive number, 1e-30 to 1e30")
    is_xyz = format_at is not None
    colors = Colors(XYZ_E, "format xyze") if is_xyz else PLAIN
    if corners is not None:
        colors = of_primaries(tuple(corners.tolist()), "PRIMARIES", is_xyz=is_xyz)
    return RadianceHeader(gains, colors, format_at)


def _lines(file: Path) -> Iterator[tuple[int, bytes]]:
    """Lines of the header with their places, up to the empty line."""
    with opened(file) as stream:
        at = 0
        while at < _MOST:
            line = stream.readline(_MOST)
            if not line.strip():
                return
            yield at, line.rstrip(b"\r\n")
            at += len(line)


def _numbers(file: Path, name: str, text: bytes, count: int) -> NDArray[np.float64]:
    try:
        found = np.array([float(word) for word in text.split()])
    except ValueError:
        found = np.empty(0)
    if len(found) == count:
        return found
    if count == 1:
        raise InputError(f"{file}: {name}: wanted a positive number, 1e-30 to 1e30")
    raise InputError(f"{file}: {name}: wanted {count} numbers")


@contextmanager
def as_rgbe(file: Path, header: RadianceHeader) -> Iterator[Path]:
    """A file that OpenImageIO reads: XYZ are stored like RGB, under another name of the format."""
    if header.format_at is None:
        yield file
        return
    handle, name = tempfile.mkstemp(suffix=".hdr", prefix="daguerre-")
    try:
        with os.fdopen(handle, "wb") as target, opened(file) as source:
            target.write(source.read(header.format_at) + _RGBE)
            source.seek(header.format_at + len(_XYZE))
            shutil.copyfileobj(source, target, 1 << 20)
        yield Path(name)
    finally:
        Path(name).unlink(missing_ok=True)
