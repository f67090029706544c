"""Sends pictures to tev, a viewer of linear pictures, over its network protocol.

Source: ``Ipc.h`` of https://github.com/Tom94/tev: a packet is its length (32 bits, all of it), its
type (8 bits) and its fields, little-endian; texts end with a zero byte.
"""

from __future__ import annotations

import contextlib
import socket
import struct

import numpy as np

from daguerre.errors import UsageError

from .drawn import Drawn

CREATE, UPDATE = 4, 6
PORT = 14158
CHANNELS = ("R", "G", "B")
#: Longest wait for tev, s.
_PATIENCE_S = 2.0


class Tev:
    """Connection to a tev that runs; it ends quietly when tev does.

    Args:
        address: ``HOST:PORT``, or a host alone.

    Raises:
        UsageError: Nothing listens there.
    """

    def __init__(self, address: str) -> None:
        host, _, port = address.rpartition(":") if ":" in address else (address, "", str(PORT))
        if not (host and port.isdecimal() and int(port) < 1 << 16):
            raise UsageError(f"--tev: wanted HOST:PORT, such as 127.0.0.1:{PORT}; got {address!r}")
        try:
            self._line: socket.socket | None = socket.create_connection(
                (host, int(port)), _PATIENCE_S
            )
        except OSError as error:
            raise UsageError(
                f"--tev {address}: no tev listens there ({error.strerror or error})"
            ) from None
        self._size: tuple[int, int] | None = None

    def send(self, drawn: Drawn) -> None:
        """Shows a picture at its full size."""
        if self._line is None or not drawn.whole:
            return
        frame, path = drawn.frame, drawn.shot.scene.path
        name = f"{'scene' if path is None else path.stem} (daguerre)"
        size = (frame.width, frame.height)
        try:
            if size != self._size:
                self._line.sendall(create(name, size))
            self._line.sendall(update(name, np.asarray(frame.rgb, "<f4")))
            self._size = size
        except OSError:  # tev was closed
            self.close()

    def close(self) -> None:
        """Closes the connection."""
        if self._line is not None:
            with contextlib.suppress(OSError):
                self._line.close()
            self._line = None


def create(name: str, size: tuple[int, int]) -> bytes:
    """Packet that makes a black picture."""
    return _packet(CREATE, name, struct.pack("<3i", *size, len(CHANNELS)) + _texts(*CHANNELS))


def update(name: str, rgb: np.ndarray) -> bytes:
    """Packet that fills a picture, (H, W, 3)."""
    height, width, count = rgb.shape
    body = struct.pack("<i", count) + _texts(*CHANNELS) + struct.pack("<4i", 0, 0, width, height)
    body += struct.pack(f"<{2 * count}q", *range(count), *([count] * count))  # offsets, strides
    return _packet(UPDATE, name, body + rgb.tobytes())


def _packet(kind: int, name: str, body: bytes) -> bytes:
    fields = struct.pack("<BB", kind, 0) + _texts(name) + body  # 0: does not take the focus
    return struct.pack("<I", len(fields) + 4) + fields


def _texts(*texts: str) -> bytes:
    return b"".join(text.encode() + b"\0" for text in texts)
