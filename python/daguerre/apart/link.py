"""Messages between a process and its helper: a kind, and some blocks of bytes.

A message is a head (kind, number of blocks), the sizes of the blocks, and the blocks in parts: runs
of blocks with at least 1 MiB, and the rest. A mark comes before each large part: its bytes follow,
or the mark carries a file of them (``shared.py``).
"""

from __future__ import annotations

import itertools
import os
import socket
import struct
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .shared import copied, mapped

_HEAD, _SIZE = struct.Struct("<cI"), struct.Struct("<Q")
#: Kinds of messages: a task; and from the helper, that it is ready, a text while it works, an
#: answer, an error, and a fault, the error of a bug. HEARD confirms a text.
TASK, READY, TOLD, ANSWER, ERROR, FAULT = b"t", b"r", b"n", b"a", b"e", b"f"
HEARD = b"h"
#: Least size of a large part, bytes, and the marks before a part: bytes in the stream, or a file.
_LARGE = 1 << 20
_BYTES, _FILE = b"b", b"f"
#: Most blocks of a message.
_MOST_BLOCKS = 1 << 24


class DamagedError(Exception):
    """A message that is damaged or too large."""


def _parts(sizes: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Range of blocks of each part: first block, and last block plus 1."""
    begin, total = 0, 0
    for number, size in enumerate(sizes):
        total += size
        if total >= _LARGE:
            yield begin, number + 1
            begin, total = number + 1, 0
    if begin < len(sizes):
        yield begin, len(sizes)


class Link:
    """One end of a connection.

    Args:
        end: The socket.
        wait: Called where a part cannot be sent (True) or received (False) yet; it may raise.
    """

    def __init__(
        self, end: socket.socket, wait: Callable[[bool], None] = lambda sends: None
    ) -> None:
        self._end, self._wait = end, wait

    def send(self, kind: bytes, blocks: Sequence[Any]) -> None:
        """Sends a message; blocks are bytes or arrays in C order.

        Raises:
            OSError: The other end is gone.
        """
        views = [memoryview(block if len(block) else b"").cast("B") for block in blocks]
        sizes = [len(view) for view in views]
        self._send(_HEAD.pack(kind, len(views)) + struct.pack(f"<{len(sizes)}Q", *sizes))
        for begin, end in _parts(sizes):
            self._send_part(views[begin:end])

    def _send_part(self, views: Sequence[memoryview]) -> None:
        large = sum(map(len, views)) >= _LARGE
        file = copied(views) if large else None
        if file is not None:
            try:
                self._send(_FILE, file)
            finally:
                os.close(file)
            return
        if large:
            self._send(_BYTES)
        for view in views:
            self._send(view)

    def _send(self, part: bytes | memoryview, file: int | None = None) -> None:
        """Sends all bytes of a part, the first with a file."""
        left = memoryview(part)
        while left:
            try:
                if file is None:
                    left = left[self._end.send(left) :]
                else:
                    left = left[socket.send_fds(self._end, [left], [file]) :]
                    file = None
            except BlockingIOError:
                self._wait(True)

    def receive(self, most: Callable[[], float]) -> tuple[bytes, list[NDArray[np.uint8]]]:
        """Receives a message: its kind, and its blocks as read-only arrays.

        Args:
            most: Returns the most bytes of a message.

        Raises:
            EOFError: The other end is gone.
            DamagedError: The bytes are no message, or the message is too large.
        """
        kind, count = _HEAD.unpack(self._exactly(_HEAD.size).tobytes())
        if count > min(_MOST_BLOCKS, most() / _SIZE.size):
            raise DamagedError(f"a message of {count} blocks")
        sizes = np.frombuffer(self._exactly(count * _SIZE.size), "<u8").tolist()
        if sum(sizes) > most():
            raise DamagedError(f"a message of {sum(sizes)} bytes")
        parts = (self._part(sizes[begin:end]) for begin, end in _parts(sizes))
        return kind, list(itertools.chain.from_iterable(parts))

    def _exactly(self, size: int) -> NDArray[np.uint8]:
        made = np.empty(size, np.uint8)
        left = made.data
        while left:
            try:
                got = self._end.recv_into(left)
            except BlockingIOError:
                self._wait(False)
                continue
            if not got:
                raise EOFError
            left = left[got:]
        made.flags.writeable = False
        return made

    def _part(self, sizes: Sequence[int]) -> list[NDArray[np.uint8]]:
        """Blocks of a part."""
        mark, files = self._mark() if sum(sizes) >= _LARGE else (_BYTES, [])
        try:
            if not mark:
                raise EOFError
            if mark == _FILE:
                return mapped(files, sizes)
        except (OSError, ValueError) as error:
            if isinstance(error, ConnectionError):
                raise
            raise DamagedError(f"a block without its bytes: {error}") from None
        finally:
            for file in files:
                os.close(file)
        return [self._exactly(size) for size in sizes]

    def _mark(self) -> tuple[bytes, list[int]]:
        while True:
            try:
                return socket.recv_fds(self._end, 1, 1, socket.MSG_CMSG_CLOEXEC)[:2]
            except BlockingIOError:
                self._wait(False)
