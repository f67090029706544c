"""Pictures sent to tev, read back as its protocol says."""

from __future__ import annotations

import socket
import struct
from pathlib import Path

import numpy as np
import pytest

from daguerre.errors import UsageError
from daguerre.viewfinder.stage import Stage
from daguerre.viewfinder.tev import CREATE, UPDATE, Tev

from .test_painter import Seen, stage  # noqa: F401


def packet(line: socket.socket) -> tuple[int, bytes]:
    """Type and fields of the next packet."""
    (length,) = struct.unpack("<I", _exactly(line, 4))
    found = _exactly(line, length - 4)
    return found[0], found[1:]


def _exactly(line: socket.socket, count: int) -> bytes:
    parts = b""
    while len(parts) < count:
        more = line.recv(count - len(parts))
        assert more, "tev's client closed the line"
        parts += more
    return parts


def test_tev_gets_the_whole_picture(stage: Stage) -> None:  # noqa: F811
    with socket.create_server(("127.0.0.1", 0)) as listening:
        tev = Tev(f"127.0.0.1:{listening.getsockname()[1]}")
        line, _ = listening.accept()
        line.settimeout(30)
        seen = Seen(stage)
        seen.request(1)
        pictures = seen.until_rest(1)
        seen.painter.close()
        for drawn in pictures:
            tev.send(drawn)
        kind, fields = packet(line)
        assert kind == CREATE
        assert fields == b"\0scene (daguerre)\0" + struct.pack("<3i", 120, 80, 3) + b"R\0G\0B\0"
        for drawn in [drawn for drawn in pictures if drawn.whole]:
            kind, fields = packet(line)
            assert kind == UPDATE
            start = len(b"\0scene (daguerre)\0") + 4 + 6
            place = struct.unpack_from("<4i6q", fields, start)
            assert place == (0, 0, 120, 80, 0, 1, 2, 3, 3, 3)
            values = np.frombuffer(fields, "<f4", offset=start + 16 + 48).reshape(80, 120, 3)
            assert np.array_equal(values, drawn.frame.rgb)
        line.close()
        for _ in range(50):  # tev is gone: nothing more is sent, and nothing fails
            tev.send(pictures[-1])
        tev.close()


@pytest.mark.parametrize("address", ["", "host:", ":14158", "host:port", "host:99999", "a:b:c"])
def test_a_wrong_address_is_refused(address: str) -> None:
    with pytest.raises(UsageError, match="--tev"):
        Tev(address)


def test_where_nothing_listens(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
    with pytest.raises(UsageError, match="no tev listens there"):
        Tev(f"127.0.0.1:{port}")
