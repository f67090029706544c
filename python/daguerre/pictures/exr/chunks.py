"""Finds the chunks of a part; checks their places, headers and lengths against the file."""

from __future__ import annotations

import struct
from threading import Lock
from typing import BinaryIO

import numpy as np

from daguerre.checks import DEFLATE_LIMIT
from daguerre.errors import InputError

from .layout import NONE, ZIP, ZIPS, Layout

#: Largest growth of a byte when unpacked, by compression; no entry: unknown.
_GROWTH = {NONE: 1, 1: 64, ZIPS: DEFLATE_LIMIT, ZIP: DEFLATE_LIMIT, 5: 2 * DEFLATE_LIMIT}


CUT = ": the file is cut off or damaged"


class Chunks:
    """Chunks of a part at full resolution, by row and column of chunks; threads may share it."""

    def __init__(self, stream: BinaryIO, layout: Layout) -> None:
        """Finds and checks all chunks.

        Raises:
            InputError: A chunk is outside of the file, has a wrong place, or is too small.
        """
        self.layout, self._stream, self._lock = layout, stream, Lock()
        self._size = stream.seek(0, 2)
        count = layout.steps * layout.across
        if layout.table + 8 * count > self._size:
            raise self._error("list of blocks", f"{count} places", "the end of the file")
        places = np.frombuffer(self._read(layout.table, 8 * count), "<u8")
        self._found = [self._checked(i, place) for i, place in enumerate(places.tolist())]

    def data(self, row: int, column: int) -> bytes:
        """Reads the packed bytes of a chunk."""
        return self._read(*self._found[row * self.layout.across + column])

    def box(self, row: int, column: int) -> tuple[int, int, int, int]:
        """Columns [x0, x1) and rows [y0, y1) of a chunk, from the corner of the data window."""
        layout = self.layout
        wide, tall = layout.tile[0] if layout.tile else layout.width, layout.step
        x, y = column * wide, row * tall
        return x, min(x + wide, layout.width), y, min(y + tall, layout.height)

    def unpacked(self, row: int, column: int) -> int:
        """Size of a chunk's unpacked pixels, bytes."""
        x0, x1, y0, y1 = self.box(row, column)
        return (x1 - x0) * (y1 - y0) * self.layout.pixel

    def _checked(self, index: int, place: int) -> tuple[int, int]:
        """Checks a chunk; returns position and length of its packed bytes."""
        layout = self.layout
        row, column = divmod(index, layout.across)
        wanted = [column, row, 0, 0] if layout.tile else [layout.box[1] + row * layout.step]
        wanted = [layout.index] * layout.multipart + wanted
        head = 4 * len(wanted) + 4
        where = f"block {column}, {row}" if layout.tile else f"rows from {wanted[-1]}"
        if not layout.data <= place <= self._size - head:
            wish = f"a place within bytes {layout.data} .. {self._size}"
            raise self._error(where, wish, f"{place}{CUT}")
        *stored, length = struct.unpack(f"<{len(wanted) + 1}i", self._read(place, head))
        if stored != wanted:
            raise self._error(where, f"a block of {wanted}", f"one of {stored}")
        full, growth = self.unpacked(row, column), _GROWTH.get(layout.compression)
        least = 1 if growth is None else -(-full // growth) - 64
        most = full if growth is not None else self._size
        if layout.compression == NONE:
            least = full
        if not max(least, 1) <= length <= most:
            raise self._error(where, f"{max(least, 1)} to {most} bytes", f"{length}")
        if place + head + length > self._size:
            wish = f"a file of at least {place + head + length} bytes"
            raise self._error(where, wish, f"{self._size}{CUT}")
        return place + head, length

    def _read(self, place: int, count: int) -> bytes:
        with self._lock:
            self._stream.seek(place)
            return self._stream.read(count)

    def _error(self, where: str, wanted: str, got: str) -> InputError:
        return InputError(f"{self.layout.path}: {where}: wanted {wanted}, got {got}")
