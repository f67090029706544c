"""Begins a helper process; run as a program, with the numbers of its socket and of its pipe.

Only the standard library is imported before the parent's paths of modules are known.
"""

from __future__ import annotations

import contextlib
import fcntl
import importlib
import json
import os
import resource
import select
import shutil
import socket
import struct
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path


class Parent:
    """Connection to the parent process: a pipe that closes when the parent ends.

    Args:
        life: Reading end of the pipe.
    """

    def __init__(self, life: int) -> None:
        self._life = life
        fcntl.fcntl(life, fcntl.F_SETOWN, os.getpid())

    @contextlib.contextmanager
    def needed(self) -> Iterator[None]:
        """Ends this process with the parent, even while a library runs.

        The kernel sends SIGIO, which has no handler and so ends the process. Source: fcntl(2),
        O_ASYNC.
        """
        flags = fcntl.fcntl(self._life, fcntl.F_GETFL)
        fcntl.fcntl(self._life, fcntl.F_SETFL, flags | os.O_ASYNC)
        poll = select.poll()
        poll.register(self._life, 0)
        if poll.poll(0):  # the parent was gone before
            os._exit(1)
        yield
        with contextlib.suppress(OSError):  # there is no folder, or it has files
            Path(os.environ["TMPDIR"]).rmdir()
        fcntl.fcntl(self._life, fcntl.F_SETFL, flags)


def _exactly(end: socket.socket, size: int) -> bytes:
    found = b""
    while len(found) < size:
        piece = end.recv(size - len(found))
        if not piece:
            os._exit(1)
        found += piece
    return found


def _folder() -> str:
    """The folder of temporary files, made on first use and removed after the task.

    A killed helper leaves a folder behind only if its task was using it.
    """
    name = os.environ["TMPDIR"]
    Path(name).mkdir(mode=0o700, exist_ok=True)
    return name


def main() -> None:
    """Sets this process up, and serves."""
    end, parent = socket.socket(fileno=int(sys.argv[1])), Parent(int(sys.argv[2]))
    with parent.needed():
        _set_up(end)
    from daguerre.apart.serving import serve

    serve(end, parent.needed)
    shutil.rmtree(os.environ["TMPDIR"], ignore_errors=True)  # the parent may be gone
    os._exit(0)  # libraries' own ends may be slow


def _set_up(end: socket.socket) -> None:
    """Limits this process, and takes the parent's paths of modules and its folder's name."""
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    with contextlib.suppress(OSError):  # the kernel ends this process first if memory ends
        Path("/proc/self/oom_score_adj").write_text("1000")
    struct.unpack("<cI", _exactly(end, 5))
    (size,) = struct.unpack("<Q", _exactly(end, 8))
    paths = json.loads(_exactly(end, size))
    sys.path[:] = [*paths, *(path for path in sys.path if path not in paths)]
    tempfile.gettempdir = _folder
    importlib.import_module("daguerre.apart.serving")


if __name__ == "__main__":
    main()
