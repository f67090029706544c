"""Reads Mitsuba's serialized meshes: several deflated meshes in a file, and where each begins.

Source: the documentation of Mitsuba 3's ``serialized`` plugin. In version 3, meshes have no names,
and the places at the end of the file have 4 bytes.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.errors import InputError
from daguerre.importers.file_bytes import Bytes, Inflated, read_bytes

from .file_mesh import FileMesh, Floats, check_corners, check_finite, checked_positions

_FORMAT, _VERSIONS = 0x041C, (3, 4)
_HEAD = 4
_NORMALS, _UV, _COLORS, _FACETED, _DOUBLE = 0x0001, 0x0002, 0x0008, 0x0010, 0x2000
#: Numbers of a vertex besides its position, by flag, in the order of the file.
_ATTRIBUTES = {_NORMALS: ("normal", 3), _UV: ("uv", 2), _COLORS: ("color", 3)}
_MOST, _MOST_NAME = (1 << 31) - 1, 1 << 12


def read(path: str | os.PathLike[str], index: int = 0) -> FileMesh:
    """Reads a mesh of a file.

    A mesh that asks for faces without smooth normals gets none.

    Args:
        path: The file.
        index: Number of the mesh, from 0.

    Raises:
        InputError: The file is not a serialized mesh, has no mesh of this number, or is damaged.
    """
    file = Path(path)
    data = read_bytes(file)
    version = _version(data, 0, str(file))
    # Mitsuba finds the first mesh without the table at the end.
    begin = _begin(data, version, index, str(file)) if index else 0
    where = f"{file}: mesh {index}"
    _version(data, begin, where)
    return _mesh(_Stream(data[begin + _HEAD :], where), version, where)


def _begin(data: Bytes, version: int, index: int, where: str) -> int:
    """Where a mesh begins."""
    begins = _begins(data, version, where)
    if not 0 <= index < len(begins):
        raise InputError(
            f"{where}: shape_index: wanted a mesh of 0 .. {len(begins) - 1}, got {index}"
        )
    return begins[index]


def count(path: str | os.PathLike[str]) -> int:
    """Number of meshes in a file.

    Raises:
        InputError: The file is not a serialized mesh.
    """
    file = Path(path)
    data = read_bytes(file)
    return len(_begins(data, _version(data, 0, str(file)), str(file)))


def _version(data: Bytes, begin: int, where: str) -> int:
    """Version of the format in the head of a mesh."""
    head = data[begin : begin + _HEAD]
    form, version = head.view("<u2").tolist() if len(head) == _HEAD else (0, 0)
    if form != _FORMAT:
        raise InputError(
            f"{where}: not a serialized mesh of Mitsuba: wanted 0x041C, got {form:#06x}"
        )
    if version not in _VERSIONS:
        raise InputError(f"{where}: wanted version 3 or 4, got {version}")
    return int(version)


def _begins(data: Bytes, version: int, where: str) -> list[int]:
    """Where the meshes begin, from the end of the file."""
    size = 8 if version == 4 else 4
    total = int(data[-4:].view("<u4")[0])
    table = len(data) - 4 - size * total
    if not total >= 1 or table < _HEAD:
        raise InputError(
            f"{where}: wanted a number of meshes at the end of the file, got {total} "
            f"for {len(data)} bytes"
        )
    found = data[table : len(data) - 4].view(f"<u{size}")
    if found.max() > table - _HEAD:
        raise InputError(f"{where}: wanted meshes before byte {table}, got one at {found.max()}")
    return [int(begin) for begin in found]


class _Stream:
    """Numbers of a deflated mesh."""

    def __init__(self, data: Bytes, where: str) -> None:
        self._inflated, self._where = Inflated(data, where), where

    def numbers(self, kind: str, *shape: int) -> NDArray[Any]:
        """An array of numbers."""
        size = np.dtype(kind).itemsize * int(np.prod(shape, dtype=object))
        return np.frombuffer(self._inflated.take(size), kind).reshape(shape)

    def count(self, what: str) -> int:
        """A number of things."""
        found = int(self.numbers("<u8", 1)[0])
        if found > _MOST:
            raise InputError(f"{self._where}: wanted at most {_MOST} {what}, got {found}")
        return found

    def name(self) -> str:
        """A text that ends with 0."""
        found = bytearray()
        while byte := self._inflated.take(1):
            if byte == b"\0":
                break
            found += byte
            if len(found) > _MOST_NAME:
                raise InputError(f"{self._where}: wanted a name of at most {_MOST_NAME} bytes")
        return found.decode("utf-8", "replace")


def _mesh(stream: _Stream, version: int, where: str) -> FileMesh:
    flags = int(stream.numbers("<u4", 1)[0])
    name = stream.name() if version == 4 else ""
    vertices, faces = stream.count("vertices"), stream.count("triangles")
    kind = "<f8" if flags & _DOUBLE else "<f4"
    positions = checked_positions(stream.numbers(kind, vertices, 3), where, "position")
    values: list[Floats | None] = [
        _single(stream.numbers(kind, vertices, columns), where, what) if flags & flag else None
        for flag, (what, columns) in _ATTRIBUTES.items()
    ]
    normals, uv, colors = values
    corners = check_corners(stream.numbers("<u4", 3 * faces), vertices, where)
    if flags & _FACETED:
        normals = None
    return FileMesh(positions, corners, None, normals, uv, colors, name=name)


def _single(values: NDArray[Any], where: str, what: str) -> Floats:
    with np.errstate(over="ignore"):
        found = values.astype(np.float32)
    check_finite(found, where, what)
    return freeze_in_place(found)
