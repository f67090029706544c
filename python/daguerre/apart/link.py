"""Messages between a process and its helper: a kind, and some blocks of bytes.

A message is a head (kind, number of blocks), the sizes of the blocks, and the blocks. A mark comes
before each large block: its bytes follow, or the mark carries a file of them (``shared.py``).
"""

from __future__ import annotations

import os
import socket
import struct
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .shared import copied, mapped

_HEAD, _SIZE = struct.Struct("<cI"), struct.Struct("<Q")
#: Kinds of messages: a task; and from the helper, that it is ready, a text while it works, an
#: answer, an error, and a fault, the error of a bug.
TASK, READY, TOLD, ANSWER, ERROR, FAULT = b"t", b"r", b"n", b"a", b"e", b"f"
#: Least size of a large block, bytes, and the two marks before one.
_LARGE = 1 << 20
_BYTES, _FILE = b"b", b"f"
#: Most blocks of a message.
_MOST_BLOCKS = 1 << 24


class DamagedError(Exception):
    """A message that is damaged or too large."""


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
        sizes = b"".join(_SIZE.pack(len(view)) for view in views)
        self._send(_HEAD.pack(kind, len(views)) + sizes)
        for view in views:
            if len(view) >= _LARGE:
                self._send_large(view)
            else:
                self._send(view)

    def _send_large(self, view: memoryview) -> None:
        file = copied(view)
        if file is None:
            self._send(_BYTES)
            self._send(view)
            return
        try:
            self._send(_FILE, file)
        finally:
            os.close(file)

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
            DamagedError: It is none, or too large.
        """
        kind, count = _HEAD.unpack(self._exactly(_HEAD.size).tobytes())
        if count > min(_MOST_BLOCKS, most() / _SIZE.size):
            raise DamagedError(f"a message of {count} blocks")
        sizes = np.frombuffer(self._exactly(count * _SIZE.size), "<u8").tolist()
        if sum(sizes) > most():
            raise DamagedError(f"a message of {sum(sizes)} bytes")
        return kind, [
            self._large(size) if size >= _LARGE else self._exactly(size) for size in sizes
        ]

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

    def _large(self, size: int) -> NDArray[np.uint8]:
        """A large block."""
        mark, files = self._mark()
        try:
            if not mark:
                raise EOFError
            return self._exactly(size) if mark == _BYTES else mapped(files, size)
        except (OSError, ValueError) as error:
            if isinstance(error, ConnectionError):
                raise
            raise DamagedError(f"a block without its bytes: {error}") from None
        finally:
            for file in files:
                os.close(file)

    def _mark(self) -> tuple[bytes, list[int]]:
        while True:
            try:
                return socket.recv_fds(self._end, 1, 1, socket.MSG_CMSG_CLOEXEC)[:2]
            except BlockingIOError:
                self._wait(False)
