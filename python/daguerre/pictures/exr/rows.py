"""Writes OpenEXR in bands of rows, so that a picture need not fit into memory.

Scanline blocks are plain or deflated (https://openexr.com/en/latest/OpenEXRFileLayout.html;
predictor and interleaving: OpenEXR Technical Introduction).
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Self

import numpy as np

from daguerre.errors import OutputError

from .header import ExrChannel, ExrHeader, header_bytes
from .layout import COMPRESSIONS, NONE, ZIP
from .parts import Planes

DEFLATE_LEVEL = 4  # OpenEXR's own default


class ExrWriter:
    """Writes a scanline file row by row, with the attributes of a source file."""

    def __init__(self, path: Path, source: ExrHeader, attributes: Mapping[str, str] = {}) -> None:
        """Opens a file.

        Args:
            path: File; use :func:`daguerre.files.atomic.atomic_path` for an atomic write.
            source: Header with attributes to keep; attributes of pixel packing are replaced.
            attributes: Text attributes to add.
        """
        packed = source.facts.get("compression", NONE)
        self._compression = NONE if packed == NONE else ZIP
        self._block = COMPRESSIONS[self._compression][1]
        kept = dict(source.attributes)
        for name in ("tiles", "chunkCount", "type", "version", "maxSamplesPerPixel"):
            kept.pop(name, None)
        kept["compression"] = ("compression", struct.pack("<B", self._compression))
        kept["lineOrder"] = ("lineOrder", b"\0")
        kept |= {name: ("string", text.encode()) for name, text in attributes.items()}
        self._channels = source.channels
        _, y0, _, y1 = source.facts["dataWindow"]
        self._top, self._height, self._next = y0, y1 - y0 + 1, 0
        self._waiting: list[Planes] = []
        self._offsets: list[int] = []
        self._pool = ThreadPoolExecutor(min(os.cpu_count() or 1, 8))
        self._path = path
        self._stream = path.open("wb")
        self._stream.write(header_bytes([kept]))
        self._table = self._stream.tell()
        self._stream.write(bytes(8 * self._blocks(self._height)))

    def write(self, planes: Planes) -> None:
        """Writes the next rows, by channel, in the types of the file.

        Raises:
            OutputError: The disk is full, or not available.
        """
        self._waiting.append(planes)
        rows = sum(len(next(iter(p.values()))) for p in self._waiting)
        complete = rows - rows % self._block
        if self._next + rows == self._height:
            complete = rows
        if complete == 0:
            return
        names = [c.name for c in self._channels]
        joined = {n: np.concatenate([p[n] for p in self._waiting]) for n in names}
        self._waiting = [{n: joined[n][complete:] for n in names}] if complete < rows else []
        starts = range(0, complete, self._block)
        cut = [{n: joined[n][a : min(a + self._block, complete)] for n in names} for a in starts]
        try:
            packed = self._pool.map(self._packed, cut)
            for start, data in zip(starts, packed, strict=True):
                self._offsets.append(self._stream.tell())
                y = self._top + self._next + start
                self._stream.write(struct.pack("<ii", y, len(data)) + data)
        except OSError as error:
            raise OutputError(f"{self._path}: cannot write: {error.strerror or error}") from error
        self._next += complete

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        self._pool.shutdown()
        with self._stream:
            if kind is None:
                assert self._next == self._height, "rows are missing"
                self._stream.seek(self._table)
                self._stream.write(struct.pack(f"<{len(self._offsets)}Q", *self._offsets))

    def _blocks(self, rows: int) -> int:
        return -(-rows // self._block)

    def _packed(self, planes: Planes) -> bytes:
        return packed(planes, self._channels, self._compression)


def packed(planes: Planes, channels: Sequence[ExrChannel], compression: int) -> bytes:
    """Packs a block of rows; each row stores channel after channel."""
    count = len(next(iter(planes.values())))
    lines = [
        np.ascontiguousarray(planes[c.name], np.dtype(c.dtype).newbyteorder("<"))
        .reshape(count, -1)
        .view(np.uint8)
        for c in channels
    ]
    plain = np.concatenate(lines, axis=1).reshape(-1)
    if compression == NONE:
        return plain.tobytes()
    halves = np.concatenate([plain[0::2], plain[1::2]])
    halves[1:] = halves[1:] - halves[:-1] + np.uint8(128)
    deflated = zlib.compress(halves.data, DEFLATE_LEVEL)  # libdeflate crashes without memory
    return deflated if len(deflated) < plain.nbytes else plain.tobytes()
