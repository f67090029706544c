"""Reads NanoVDB files: segments of grids, plain, zipped or by Blosc, and raw grids.

Grids of single-precision numbers (FloatGrid) that are no level sets become dense: the box around
their active values and a layer of background, as renderers interpolate between both.

Source: OpenVDB, the comments of ``nanovdb/io/IO.h`` and ``NanoVDB.h``, version 32 (Apache-2.0 and
MPL-2.0; read for the layout of the file).
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

import numpy as np

from daguerre.checks import short
from daguerre.errors import InputError, suggest
from daguerre.files import extras
from daguerre.importers.file_bytes import Bytes, Inflated, check_room, read_bytes

from .grid import FileGrid
from .nanovdb_tree import dense, name_of

_SEGMENT, _RAW = (b"NanoVDB0", b"NanoVDB2"), b"NanoVDB1"
_HEADER = np.dtype([("magic", "S8"), ("version", "<u4"), ("grids", "<u2"), ("codec", "<u2")])
_META = np.dtype(
    {
        "names": ["grid_size", "file_size", "name_size", "codec"],
        "formats": ["<u8", "<u8", "<u4", "<u2"],
        "offsets": [0, 8, 136, 168],
        "itemsize": 176,
    }
)
_PLAIN, _ZIP, _BLOSC = 0, 1, 2
#: Bytes of a grid that Blosc packs at a time.
_BLOSC_CHUNK = 1 << 30


@dataclass(frozen=True)
class _Entry:
    """A packed grid of a file: name, position, and unpacked size."""

    name: str
    begin: int
    end: int
    size: int
    codec: int


def read(path: str | os.PathLike[str], name: str = "") -> FileGrid:
    """Reads a grid.

    Args:
        path: The file.
        name: Name of the grid; default: the first grid.

    Raises:
        InputError: The file is not NanoVDB, has no such grid, or the grid is of another kind or
            packed in a way that cannot be read here.
    """
    file = Path(path)
    data = read_bytes(file)
    entries = list(_entries(data, str(file)))
    found = next((entry for entry in entries if name in ("", entry.name)), None)
    if found is None:
        names = [entry.name for entry in entries]
        raise InputError(
            f"{file}: wanted a grid {short(name)}, got {', '.join(map(short, names[:8])) or 'none'}"
            f"{suggest(name, names)}"
        )
    where = f"{file}: grid {short(found.name)}"
    return dense(_unpacked(data[found.begin : found.end], found, where), where)


def _entries(data: Bytes, where: str) -> Iterator[_Entry]:
    """Grids of a file."""
    magic = data[:8].tobytes()
    if magic == _RAW:
        yield _Entry(name_of(data, where), 0, len(data), len(data), _PLAIN)
        return
    at = 0
    while at < len(data):
        if len(data) - at < _HEADER.itemsize or data[at : at + 8].tobytes() not in _SEGMENT:
            raise InputError(
                f"{where}: byte {at}: wanted a segment of NanoVDB, "
                f"got {data[at : at + 8].tobytes()!r}"
            )
        header = data[at : at + _HEADER.itemsize].view(_HEADER)[0]
        at += _HEADER.itemsize
        metas = []
        for _ in range(int(header["grids"])):
            meta, name, at = _meta(data, at, where)
            metas.append((meta, name))
        for meta, name in metas:
            size = int(meta["file_size"])
            if size > len(data) - at:
                raise InputError(
                    f"{where}: grid {short(name)}: wanted {size} bytes, got {len(data) - at}"
                )
            yield _Entry(name, at, at + size, int(meta["grid_size"]), int(meta["codec"]))
            at += size


def _meta(data: Bytes, at: int, where: str) -> tuple[np.void, str, int]:
    """Facts about a grid, its name, and where they end."""
    begin = at + _META.itemsize
    if begin > len(data):
        raise InputError(f"{where}: truncated: the header of a grid at byte {at} is missing")
    meta = data[at:begin].view(_META)[0]
    end = begin + int(meta["name_size"])
    if end > len(data):
        raise InputError(f"{where}: truncated: the name of a grid at byte {begin} is missing")
    return meta, data[begin:end].tobytes().split(b"\0")[0].decode("utf-8", "replace"), end


def _unpacked(packed: Bytes, entry: _Entry, where: str) -> Bytes:
    """The bytes of a grid."""
    if entry.codec == _PLAIN:
        if entry.size > len(packed):
            raise InputError(f"{where}: wanted {entry.size} bytes, got {len(packed)}")
        return packed[: entry.size]
    if entry.codec == _ZIP:
        chunk, _ = _chunk(packed, 0, where)
        return np.frombuffer(Inflated(chunk, where).take(entry.size), np.uint8)
    if entry.codec == _BLOSC:
        return _unblosced(packed, entry.size, where)
    raise InputError(f"{where}: wanted plain, ZIP or BLOSC data (0 .. 2), got {entry.codec}")


def _chunk(packed: Bytes, at: int, where: str) -> tuple[Bytes, int]:
    """Packed data that begin with their size, and where they end."""
    head = packed[at : at + 8]
    size = int(head.view("<u8")[0]) if len(head) == 8 else -1
    if not 0 <= size <= len(packed) - at - 8:
        raise InputError(f"{where}: wanted packed data, got {len(packed) - at} bytes of {size}")
    return packed[at + 8 : at + 8 + size], at + 8 + size


def _unblosced(packed: Bytes, size: int, where: str) -> Bytes:
    """Unpacks Blosc data; each chunk states its size."""
    if extras.missing("blosc"):
        raise InputError(
            f"{where}: compressed by BLOSC: {extras.lack('blosc')} (or convert the file with "
            "nanovdb_convert --zip)"
        )
    blosc = import_module("blosc")
    check_room(size, where)
    parts, at = [], 0
    while size:
        chunk, at = _chunk(packed, at, where)
        wanted = min(size, _BLOSC_CHUNK)
        head = chunk[:16].view("<u4").tolist() if len(chunk) >= 16 else [0, 0, 0, 0]
        if (head[1], head[3]) != (wanted, len(chunk)):
            raise InputError(f"{where}: wanted {wanted} bytes packed by BLOSC, got {head[1]}")
        try:
            parts.append(blosc.decompress(chunk.tobytes()))
        except (ValueError, TypeError, blosc.blosc_extension.error) as error:
            raise InputError(f"{where}: wanted data packed by BLOSC, got {error}") from None
        size -= wanted
    return np.frombuffer(b"".join(parts), np.uint8)
