"""Reads the pixels of any part of an OpenEXR file, in bands of rows.

This code reads plain and deflated pixels (NONE, ZIPS, ZIP), which are all that Daguerre writes;
:mod:`daguerre.pictures.exr.apart` has other compressions unpacked by another process.
"""

from __future__ import annotations

import os
from collections.abc import Collection
from concurrent.futures import ThreadPoolExecutor
from tempfile import TemporaryDirectory
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.files.reading import opened
from daguerre.memory import free_bytes, shown

from .apart import plain_copy
from .chunks import Chunks
from .layout import BYTES, NONE, ZIP, ZIPS, Layout, read_layouts
from .unpack import inflated

Planes = dict[str, NDArray[Any]]
OURS = (NONE, ZIPS, ZIP)
_SMALL = 1 << 20  # bytes; below this, neither threads nor a check of free memory pay


class PartReader:
    """Reader of the pixels of a part; ``rows`` reads some of them, in any order.

    Attributes:
        path: The file.
        layout: Layout of the part in the file.
        channels: Numpy type names by channel, in the order of the file.
        width: Columns, px.
        height: Rows, px.
    """

    def __init__(self, layout: Layout) -> None:
        """Opens a file.

        Raises:
            InputError: The file cannot be read, is truncated, or does not fit its header.
        """
        self.path, self.layout, self.channels = layout.path, layout, layout.channels
        self.width, self.height = layout.width, layout.height
        self._folder: TemporaryDirectory[str] | None = None
        self._copy: PartReader | None = None
        self._kept: tuple[int, list[NDArray[np.uint8]]] = (-1, [])
        self._stream: BinaryIO = opened(layout.path)
        try:
            self._chunks = Chunks(self._stream, layout)
        except BaseException:
            self._stream.close()
            raise

    def rows(self, begin: int, end: int, names: Collection[str] | None = None) -> Planes:
        """Reads rows [begin, end), counted from the top of the data window, by channel.

        Args:
            begin: First row.
            end: Row past the last.
            names: Channels to read; None: all.

        Raises:
            InputError: These rows are damaged, or there is too little memory.
        """
        if self.layout.compression not in OURS:
            return self._plain().rows(begin, end, names)
        wanted = {n: t for n, t in self.channels.items() if names is None or n in names}
        size = (end - begin) * self.width * sum(BYTES[dtype] for dtype in wanted.values())
        self.check_memory(size)
        planes: Planes = {n: np.empty((end - begin, self.width), t) for n, t in wanted.items()}
        step = self.layout.step
        steps = range(begin // step, -(-end // step))
        last = self._kept

        def put(row: int) -> None:
            nonlocal last
            blocks = self._blocks(row)
            for column, block in enumerate(blocks):
                self._put(planes, (begin, end), row, column, block)
            if row == steps[-1] and end % step:  # the next band begins in this block
                last = row, blocks

        if self.layout.compression == NONE or len(steps) == 1 or size < _SMALL:
            for row in steps:
                put(row)
        else:
            with ThreadPoolExecutor(min(os.cpu_count() or 1, 8, len(steps))) as pool:
                list(pool.map(put, steps))
        self._kept = last
        return planes

    def check_memory(self, size: int) -> None:
        """Checks that ``size`` bytes fit into free memory.

        Raises:
            InputError: The bytes do not fit.
        """
        if size < _SMALL:
            return
        free = free_bytes()
        if free is not None and size > free:
            raise InputError(
                f"{self.path}: pixels: wanted at most the free memory, {shown(free)}, got "
                f"{shown(size)}"
            )

    def close(self) -> None:
        """Closes the file and removes temporary files."""
        self._stream.close()
        if self._copy is not None:
            self._copy.close()
        if self._folder is not None:
            self._folder.cleanup()

    def __del__(self) -> None:
        """Closes the file for readers that live as long as an object made from them."""
        if hasattr(self, "_stream"):
            self.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _blocks(self, row: int) -> list[NDArray[np.uint8]]:
        """Returns the unpacked chunks of a row of chunks."""
        at, kept = self._kept
        if at == row:
            return kept
        return [self._block(row, column) for column in range(self.layout.across)]

    def _block(self, row: int, column: int) -> NDArray[np.uint8]:
        data, size = self._chunks.data(row, column), self._chunks.unpacked(row, column)
        try:
            if self.layout.compression != NONE:
                return inflated(data, size)
            if len(data) != size:  # the file was truncated while it was read
                raise ValueError(f"wanted {size} bytes of pixels, got {len(data)}")
        except ValueError as error:
            _, _, y0, y1 = self._chunks.box(row, column)
            raise InputError(f"{self.path}: rows {y0} .. {y1 - 1}: {error}") from None
        return np.frombuffer(data, np.uint8)

    def _put(
        self, planes: Planes, rows: tuple[int, int], row: int, column: int, block: NDArray[np.uint8]
    ) -> None:
        """Copies a chunk's pixels into planes; each row stores channel after channel."""
        x0, x1, y0, y1 = self._chunks.box(row, column)
        top, bottom = max(y0, rows[0]), min(y1, rows[1])
        lines = block.reshape(y1 - y0, -1)[top - y0 : bottom - y0]
        at = 0
        for name, dtype in self.channels.items():
            width = (x1 - x0) * BYTES[dtype]
            if name in planes:
                found = lines[:, at : at + width].view(dtype)
                planes[name][top - rows[0] : bottom - rows[0], x0:x1] = found
            at += width

    def _plain(self) -> PartReader:
        """Returns a reader of the same pixels, unpacked by another process."""
        if self._copy is None:
            self.check_memory(self.layout.size)
            self._folder = TemporaryDirectory(prefix="daguerre-", ignore_cleanup_errors=True)
            path = plain_copy(self.layout, self._folder)
            layout = read_layouts(path, 0)[0]
            same = (layout.channels, layout.box) == (self.channels, self.layout.box)
            if not (same and layout.compression == NONE):
                raise InputError(
                    f"{self.path}: cannot be decoded: the decoded copy differs from the file"
                )
            self._copy = PartReader(layout)
        return self._copy
