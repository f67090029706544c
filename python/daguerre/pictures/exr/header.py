"""Reads and makes headers of OpenEXR files; attributes of unknown types are kept as bytes.

Layout: "OpenEXR File Layout", https://openexr.com/en/latest/OpenEXRFileLayout.html
"""

from __future__ import annotations

import os
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from daguerre.checks import short
from daguerre.errors import InputError
from daguerre.files.reading import opened, reading

MAGIC = 20000630
TILED, LONG_NAMES, DEEP, MULTIPART = 0x200, 0x400, 0x800, 0x1000
KNOWN_FLAGS = TILED | LONG_NAMES | DEEP | MULTIPART
#: Bytes read for headers: at first, and at most.
FIRST_READ, MAX_HEADER = 1 << 16, 1 << 26
#: Limits: attributes of all headers together, and bytes of a name.
MAX_ATTRIBUTES, MAX_NAME = 1 << 16, 255
#: Bytes of a name that need no flag.
SHORT_NAME = 31
MAX_CHANNELS = 4096
PIXEL_TYPES = ("uint32", "float16", "float32")


@dataclass(frozen=True)
class ExrChannel:
    """A channel: its name, and the type of its pixels in numpy's terms."""

    name: str
    dtype: str
    subsampled: bool = False


@dataclass(frozen=True)
class ExrHeader:
    """The header of a part.

    Attributes:
        attributes: Type and bytes by name, in the file's order.
        flags: Flags of the version field.
        parts: Number of parts of the file.
    """

    attributes: dict[str, tuple[str, bytes]]
    flags: int
    parts: int

    @property
    def facts(self) -> dict[str, Any]:
        """Values of all attributes of known type, by name."""
        known = {name: _decoded(kind, data) for name, (kind, data) in self.attributes.items()}
        return {name: value for name, value in known.items() if value is not None}

    @property
    def channels(self) -> list[ExrChannel]:
        """Channels in the order of the file, which sorts names by their bytes.

        Raises:
            ValueError: The list is damaged, or has more than 4096 channels.
        """
        data, at = self.attributes["channels"][1], 0
        found: list[ExrChannel] = []
        while data[at] != 0:
            if len(found) == MAX_CHANNELS:
                raise ValueError("channels")
            name, end = _name(data, at)
            kind, _, x, y = struct.unpack_from("<4i", data, end)
            if not (0 <= kind < len(PIXEL_TYPES) and x >= 1 and y >= 1):
                raise ValueError("channels")
            found.append(ExrChannel(name, PIXEL_TYPES[kind], (x, y) != (1, 1)))
            at = end + 16
        return found


@dataclass(frozen=True)
class ExrHeaders:
    """Headers of a file, their end and the size of the file, bytes."""

    parts: list[ExrHeader]
    end: int
    size: int


class _CutError(ValueError):
    """The bytes end before the header does."""


def read_headers(path: Path) -> ExrHeaders:
    """Reads the headers of all parts, and not the whole file.

    Raises:
        InputError: The file is not OpenEXR, is truncated, or a header is damaged or too long.
    """
    with opened(path) as stream, reading(path):
        size = os.fstat(stream.fileno()).st_size
        data, wanted = b"", FIRST_READ
        while True:
            data += stream.read(wanted - len(data))
            try:
                parts, end = _headers(data, path)
                return ExrHeaders(parts, end, size)
            except _CutError:
                if len(data) < wanted or wanted >= MAX_HEADER:
                    raise InputError(f"{path}: header: truncated or too long") from None
            wanted *= 8


def _headers(data: bytes, path: Path) -> tuple[list[ExrHeader], int]:
    if len(data) < 8 or struct.unpack_from("<i", data)[0] != MAGIC:
        got = short(data[:8]) if data else "an empty file"
        raise InputError(f"{path}: format: wanted an OpenEXR file, got {got}")
    flags = struct.unpack_from("<I", data, 4)[0]
    if flags & 0xFF != 2 or (flags & ~0xFF) & ~KNOWN_FLAGS:
        raise InputError(f"{path}: format: wanted OpenEXR 2, got version bits {flags:#x}")
    found: list[dict[str, tuple[str, bytes]]] = []
    at = 8
    try:
        while True:
            attributes, at = _attributes(data, at, sum(len(part) for part in found))
            found.append(attributes)
            if not flags & MULTIPART:
                break
            if at >= len(data):
                raise _CutError
            if data[at] == 0:
                at += 1
                break
    except (ValueError, struct.error) as error:
        if isinstance(error, _CutError):
            raise
        raise InputError(f"{path}: header: damaged") from error
    return [ExrHeader(attributes, flags, len(found)) for attributes in found], at


def header_bytes(parts: Sequence[Mapping[str, tuple[str, bytes]]]) -> bytes:
    """Encodes magic number, version and the attributes of each part of a scanline file."""
    flags = MULTIPART if len(parts) > 1 else 0
    if any(_has_long_names(attributes) for attributes in parts):
        flags |= LONG_NAMES
    out = [struct.pack("<ii", MAGIC, 2 | flags)]
    for attributes in parts:
        for name, (kind, data) in attributes.items():
            out += [_text(name), _text(kind), struct.pack("<i", len(data)), data]
        out.append(b"\0")
    return b"".join([*out, b"\0" if len(parts) > 1 else b""])


def _has_long_names(attributes: Mapping[str, tuple[str, bytes]]) -> bool:
    channels = ExrHeader(dict(attributes), 0, 1).channels
    names = [*attributes, *(channel.name for channel in channels)]
    return any(len(_text(name)) > SHORT_NAME + 1 for name in names)


def new_header(
    names: tuple[str, ...], corner: tuple[int, int], size: tuple[int, int], full: tuple[int, int]
) -> ExrHeader:
    """Makes the header of a new file of float channels.

    Args:
        names: Names of the channels, sorted.
        corner: First pixel of the data window, px.
        size: Width and height of the data window, px.
        full: Width and height of the display window, which begins at (0, 0), px.
    """
    window = struct.pack("<4i", *corner, corner[0] + size[0] - 1, corner[1] + size[1] - 1)
    attributes = {
        "channels": ("chlist", channel_list([ExrChannel(name, "float32") for name in names])),
        "compression": ("compression", b"\3"),
        "dataWindow": ("box2i", window),
        "displayWindow": ("box2i", struct.pack("<4i", 0, 0, full[0] - 1, full[1] - 1)),
        "lineOrder": ("lineOrder", b"\0"),
        "pixelAspectRatio": ("float", struct.pack("<f", 1.0)),
        "screenWindowCenter": ("v2f", struct.pack("<2f", 0.0, 0.0)),
        "screenWindowWidth": ("float", struct.pack("<f", 1.0)),
    }
    return ExrHeader(attributes, 0, 1)


def channel_list(channels: list[ExrChannel]) -> bytes:
    """Encodes the value of the attribute ``channels``."""
    rows = [
        _text(c.name) + struct.pack("<4i", PIXEL_TYPES.index(c.dtype), 0, 1, 1) for c in channels
    ]
    return b"".join([*rows, b"\0"])


def _text(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape") + b"\0"


def _attributes(data: bytes, at: int, before: int) -> tuple[dict[str, tuple[str, bytes]], int]:
    """Reads attributes of one part, and its end; earlier parts have ``before`` attributes."""
    found: dict[str, tuple[str, bytes]] = {}
    while True:
        if at >= len(data):
            raise _CutError
        if data[at] == 0:
            return found, at + 1
        name, at = _name(data, at)
        kind, at = _name(data, at)
        if at + 4 > len(data):
            raise _CutError
        (size,) = struct.unpack_from("<i", data, at)
        at += 4
        if size < 0 or name in found or before + len(found) >= MAX_ATTRIBUTES:
            raise ValueError(name)
        if at + size > len(data):
            raise _CutError
        found[name] = (kind, data[at : at + size])
        at += size


def _name(data: bytes, at: int) -> tuple[str, int]:
    end = data.find(b"\0", at, at + MAX_NAME + 1)
    if end < 0:
        raise _CutError if len(data) <= at + MAX_NAME else ValueError("name")
    return data[at:end].decode("utf-8", "surrogateescape"), end + 1


_FORMATS = {
    "int": "<i", "float": "<f", "double": "<d", "v2i": "<2i", "v2f": "<2f", "v3f": "<3f",
    "m44f": "<16f", "box2i": "<4i", "chromaticities": "<8f", "compression": "<B",
}  # fmt: skip


def _decoded(kind: str, data: bytes) -> Any:
    """Decodes a value; None: unknown type, or damaged."""
    try:
        if kind == "string":
            return data.decode("utf-8", "replace")
        if kind == "rational":
            return Fraction(*struct.unpack("<iI", data))
        if kind in _FORMATS:
            values = struct.unpack(_FORMATS[kind], data)
            return values[0] if len(values) == 1 else values
    except (struct.error, ZeroDivisionError):
        pass
    return None
