"""Begins a helper process; run as a program, with the numbers of its socket and of its pipe.

Only the standard library is imported before the parent's paths of modules are known.
"""

from __future__ import annotations

import contextlib
import fcntl
import json
import os
import resource
import select
import socket
import struct
import sys
from pathlib import Path


def _end_with_parent(life: int) -> None:
    """Ends this process when the other end of a pipe closes, whatever a library does then.

    The kernel sends SIGIO, for which nothing is set up. Source: fcntl(2), O_ASYNC.
    """
    fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(life, fcntl.F_SETFL, fcntl.fcntl(life, fcntl.F_GETFL) | os.O_ASYNC)
    poll = select.poll()
    poll.register(life, 0)
    if poll.poll(0):  # it had closed before
        os._exit(1)


def _exactly(end: socket.socket, size: int) -> bytes:
    found = b""
    while len(found) < size:
        piece = end.recv(size - len(found))
        if not piece:
            os._exit(1)
        found += piece
    return found


def main() -> None:
    """Sets this process up, and serves."""
    end = socket.socket(fileno=int(sys.argv[1]))
    _end_with_parent(int(sys.argv[2]))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(OSError):  # the kernel ends this process first if memory ends
        Path("/proc/self/oom_score_adj").write_text("1000")
    struct.unpack("<cI", _exactly(end, 5))
    (size,) = struct.unpack("<Q", _exactly(end, 8))
    paths = json.loads(_exactly(end, size))
    sys.path[:] = [*paths, *(path for path in sys.path if path not in paths)]
    from daguerre.apart.serving import serve

    serve(end)


if __name__ == "__main__":
    main()
