"""Bytes of untrusted files, plain or deflated, in limited memory."""

from __future__ import annotations

import gzip
import io
import zlib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre import memory
from daguerre.errors import InputError
from daguerre.files.reading import check_size, opened, reading, size_of

Bytes = NDArray[np.uint8]
#: Maximum size of a file.
MAX_BYTES = 1 << 34
#: Packed data may grow by this factor, and always to ``ALWAYS`` bytes. Meshes grow by 10 at most.
GROWTH, ALWAYS = 100, 1 << 26
_PIECE = 1 << 20
_GZIP_MAGIC = b"\x1f\x8b"


def read_bytes(file: Path, most: int = MAX_BYTES) -> Bytes:
    """Reads a file, and unpacks it if it is gzipped, whatever its name is.

    Args:
        file: The file.
        most: Maximum size of the file, bytes.

    Raises:
        InputError: The file cannot be read or is too large, or gzip data are damaged or too large.
    """
    check_room(size_of(file), str(file), most)
    with opened(file) as stream, reading(file):
        data = np.fromfile(stream, np.uint8)
    if data[:2].tobytes() != _GZIP_MAGIC:
        return data
    return np.frombuffer(b"".join(_gunzipped(data, str(file), most)), np.uint8)


def check_room(size: int, where: str, most: int = MAX_BYTES) -> None:
    """Checks a size before memory of it is taken.

    Raises:
        InputError: The size is above ``most``, or above the memory that is left.
    """
    check_size(size, where, most)
    if size <= ALWAYS:
        return
    left = memory.left_bytes()
    if left is not None and size > left:
        raise InputError(
            f"{where}: wanted at most the free memory, {memory.shown(left)}, got "
            f"{memory.shown(size)}"
        )


def most_unpacked(packed: int) -> int:
    """Bytes to which packed data of honest files grow at most."""
    return max(GROWTH * packed, ALWAYS)


class Inflated:
    """A zlib stream, unpacked as far as it is read.

    Args:
        data: The stream, and perhaps more.
        where: Owner, for messages.
    """

    def __init__(self, data: Bytes, where: str) -> None:
        self._data, self._where = data.data, where
        self._stream = zlib.decompressobj()
        self._next, self._taken = 0, 0
        self._tail: bytes | memoryview = b""

    def take(self, size: int) -> bytes:
        """Returns the next bytes.

        Raises:
            InputError: The stream is damaged, ends before, or cannot hold as many; the latter is
                found before memory is taken.
        """
        limit = most_unpacked(len(self._data))
        self._taken += size
        if self._taken > limit:
            raise InputError(
                f"{self._where}: wanted at most {limit} bytes of unpacked data, got "
                f"{self._taken} from {len(self._data)} packed bytes"
            )
        check_room(size, self._where)
        parts, left = [], size
        while left:
            piece = self._piece(left)
            parts.append(piece)
            left -= len(piece)
        return b"".join(parts)

    def _piece(self, most: int) -> bytes:
        """Some bytes, at least one."""
        while True:
            if not len(self._tail) and not self._stream.eof:
                self._tail = self._data[self._next : self._next + _PIECE]
                self._next += len(self._tail)
            ended = not len(self._tail) or self._stream.eof
            try:
                piece = self._stream.decompress(self._tail, most)
            except zlib.error as error:
                raise InputError(f"{self._where}: damaged zlib stream ({error})") from None
            self._tail = self._stream.unconsumed_tail
            if piece:
                return piece
            if ended:
                raise InputError(
                    f"{self._where}: the data end too early: {most} more unpacked bytes are missing"
                )


def _gunzipped(data: Bytes, where: str, most: int) -> Iterator[bytes]:
    """Pieces of gzipped data; several members follow each other."""
    limit, total = min(most, most_unpacked(len(data))), 0
    with gzip.GzipFile(fileobj=io.BytesIO(data.data)) as stream:
        while True:
            try:
                piece = stream.read(_PIECE)
            except (OSError, EOFError, zlib.error) as error:
                raise InputError(f"{where}: damaged gzip data ({error})") from None
            total += len(piece)
            if total > limit:
                raise InputError(f"{where}: too much unpacked data: the limit is {limit} bytes")
            if not piece:
                return
            yield piece
