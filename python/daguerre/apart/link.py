"""Messages between a process and its helper: a kind, and some blocks of bytes.

A message is a head (kind, number of blocks), the sizes of the blocks, and the blocks.
"""

from __future__ import annotations

import socket
import struct
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

_HEAD, _SIZE = struct.Struct("<cI"), struct.Struct("<Q")
#: Kinds of messages: a task; and from the helper, that it is ready, a text while it works, an
#: answer, an error, and a fault, the error of a bug.
TASK, READY, TOLD, ANSWER, ERROR, FAULT = b"t", b"r", b"n", b"a", b"e", b"f"
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
        views = [memoryview(block).cast("B") if len(block) else b"" for block in blocks]
        sizes = b"".join(_SIZE.pack(len(view)) for view in views)
        for view in (_HEAD.pack(kind, len(views)) + sizes, *views):
            left = memoryview(view)
            while left:
                try:
                    left = left[self._end.send(left) :]
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
        return kind, [self._exactly(size) for size in sizes]

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
