"""The header of an OpenEXR file as bytes: what nobody here understands is kept all the same.

Layout: "OpenEXR File Layout", https://openexr.com/en/latest/OpenEXRFileLayout.html
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from daguerre.errors import InputError

MAGIC = 20000630
LONG_NAMES, DEEP, MULTIPART = 0x400, 0x800, 0x1000
MAX_HEADER = 1 << 26  # bytes
PIXEL_TYPES = ("uint32", "float16", "float32")


@dataclass(frozen=True)
class ExrChannel:
    """A channel: its name, and the type of its pixels as numpy names it."""

    name: str
    dtype: str
    subsampled: bool = False


@dataclass(frozen=True)
class ExrHeader:
    """The header of a file's first part.

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
        """The values of all attributes whose type is known."""
        known = {name: _decoded(*typed) for name, typed in self.attributes.items()}
        return {name: value for name, value in known.items() if value is not None}

    @property
    def channels(self) -> list[ExrChannel]:
        """In the order of the file: that of their names' bytes."""
        data, found, at = self.attributes["channels"][1], [], 0
        while data[at] != 0:
            end = data.index(b"\0", at)
            kind, _, x, y = struct.unpack_from("<4i", data, end + 1)
            name = data[at:end].decode("utf-8", "surrogateescape")
            found.append(ExrChannel(name, PIXEL_TYPES[kind], (x, y) != (1, 1)))
            at = end + 17
        return found


def read_header(path: Path) -> ExrHeader:
    """The header of the first part.

    Raises:
        InputError: It is no OpenEXR file, is cut off, or has deep pixels.
    """
    if os.path.exists(path) and not (path.is_file() or path.is_dir()):  # noqa: PTH110 - a pipe might never end
        raise InputError(f"{path}: format: wanted an OpenEXR file, got something else")
    try:
        with path.open("rb") as stream:
            data = stream.read(MAX_HEADER)
    except OSError as error:
        raise InputError(f"{path}: cannot read: {error.strerror or error}") from error
    if len(data) < 8 or struct.unpack_from("<i", data)[0] != MAGIC:
        raise InputError(f"{path}: format: wanted an OpenEXR file, got something else")
    flags = struct.unpack_from("<i", data, 4)[0]
    if flags & DEEP:
        raise InputError(f"{path}: format: wanted flat pixels, got deep ones")
    try:
        first, at = _attributes(data, 8)
        parts = 1
        while flags & MULTIPART and data[at] != 0:
            _, at = _attributes(data, at)
            parts += 1
        header = ExrHeader(first, flags, parts)
        if not header.channels:
            raise InputError(f"{path}: channels: wanted some, got none")
    except (IndexError, KeyError, ValueError, struct.error) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path}: header: wanted that of an OpenEXR file, got a broken one") from (
            error
        )
    return header


def header_bytes(header: ExrHeader) -> bytes:
    """Magic number, version and attributes of a scanline file of one part."""
    out = [struct.pack("<ii", MAGIC, 2 | (header.flags & LONG_NAMES))]
    for name, (kind, data) in header.attributes.items():
        out += [_text(name), _text(kind), struct.pack("<i", len(data)), data]
    return b"".join([*out, b"\0"])


def new_header(
    names: tuple[str, ...], corner: tuple[int, int], size: tuple[int, int], full: tuple[int, int]
) -> ExrHeader:
    """Makes the header of a new file of float channels.

    Args:
        names: Names of the channels, sorted.
        corner: First pixel of the data window, px.
        size: Width and height of the data window, px.
        full: Those of the display window, which begins at (0, 0), px.
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
    """The value of the attribute ``channels``."""
    rows = [
        _text(c.name) + struct.pack("<4i", PIXEL_TYPES.index(c.dtype), 0, 1, 1) for c in channels
    ]
    return b"".join([*rows, b"\0"])


def _text(text: str) -> bytes:
    return text.encode("utf-8", "surrogateescape") + b"\0"


def _attributes(data: bytes, at: int) -> tuple[dict[str, tuple[str, bytes]], int]:
    found = {}
    while data[at] != 0:
        name, at = _name(data, at)
        kind, at = _name(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        at += 4
        if size < 0 or at + size > len(data):
            raise ValueError("cut off")
        found[name] = (kind, data[at : at + size])
        at += size
    return found, at + 1


def _name(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode("utf-8", "surrogateescape"), end + 1


_FORMATS = {
    "int": "<i", "float": "<f", "double": "<d", "v2i": "<2i", "v2f": "<2f", "v3f": "<3f",
    "m44f": "<16f", "box2i": "<4i", "chromaticities": "<8f", "compression": "<B",
}  # fmt: skip


def _decoded(kind: str, data: bytes) -> Any:
    """None: of a type that is not decoded, or broken."""
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
