"""Reads, encodes and checks the chunks of PNG files.

Source: PNG specification, 3rd edition, 5.3 (chunk layout) and 5.5 (checksums).
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import BinaryIO, NamedTuple

SIGNATURE_BYTES = 8


class Chunk(NamedTuple):
    """One chunk; ``at``: position of its data in the file, bytes."""

    kind: bytes
    data: bytes
    at: int
    intact: bool


def chunks(file: BinaryIO) -> Iterator[Chunk]:
    """Reads chunks in order; a truncated chunk is not ``intact``."""
    file.seek(SIGNATURE_BYTES)
    while len(head := file.read(8)) == 8:
        kind, at = head[4:], file.tell()
        data = file.read(int.from_bytes(head[:4], "big"))
        yield Chunk(kind, data, at, file.read(4) == checksum(kind, data))


def is_complete(file: BinaryIO) -> bool:
    """Whether all checksums fit and the file ends with IEND."""
    for chunk in chunks(file):
        if not chunk.intact:
            return False
        if chunk.kind == b"IEND":
            return not file.read(1)
    return False


def encoded(kind: bytes, data: bytes) -> bytes:
    """Encodes a chunk: length, kind, data and checksum."""
    return len(data).to_bytes(4, "big") + kind + data + checksum(kind, data)


def checksum(kind: bytes, data: bytes) -> bytes:
    """The CRC of a chunk, 4 bytes."""
    return zlib.crc32(data, zlib.crc32(kind)).to_bytes(4, "big")
