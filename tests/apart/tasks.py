"""Tasks for helper processes, most of which end them."""

from __future__ import annotations

import ctypes
import os
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from daguerre.apart.serving import Owned
from daguerre.errors import UsageError

Tell = Callable[[str], None]


def echo(request: Any, tell: Tell) -> Any:
    """Returns the request."""
    return request


def process(request: Any, tell: Tell) -> tuple[int, int, int]:
    """Number of the process, of its parent, and of its session."""
    return os.getpid(), os.getppid(), os.getsid(0)


def folder(request: Any, tell: Tell) -> str:
    """Name of a temporary file, which stays."""
    return tempfile.mkstemp()[1]


def passing(request: Any, tell: Tell) -> int:
    """Uses a temporary file, which goes; returns the mode of its folder."""
    with tempfile.NamedTemporaryFile() as file:
        return Path(file.name).parent.stat().st_mode & 0o777


def ones(request: int, tell: Tell) -> Any:
    """Some bytes."""
    return np.ones(request, np.uint8)


def refuse(request: str, tell: Tell) -> NoReturn:
    """Raises an error for users."""
    raise UsageError(request)


def divide(request: Any, tell: Tell) -> float:
    """Meets a bug."""
    return 1 / (0 * len(str(request)))


def crash(request: Any, tell: Tell) -> None:
    """Reads address 0."""
    ctypes.string_at(0)


def abort(request: Any, tell: Tell) -> None:
    """Aborts."""
    os.abort()


def leave(request: int, tell: Tell) -> None:
    """Ends with an exit code."""
    os._exit(request)


def sleep(request: float, tell: Tell) -> float:
    """Waits."""
    time.sleep(request)
    return request


def hold(request: int, tell: Tell) -> None:
    """Waits with the lock of Python held, as a library does; tells first."""
    tell("holds")
    ctypes.PyDLL(None).sleep(request)


def fill(request: Any, tell: Tell) -> None:
    """Takes more and more memory."""
    kept = []
    while True:
        kept.append(np.ones(1 << 20))


def leap(request: int, tell: Tell) -> int:
    """Takes much memory at once."""
    return len(np.ones(request, np.uint8))


def chatter(request: Any, tell: Tell) -> None:
    """Tells without end."""
    while True:
        tell("x")


def shout(request: Any, tell: Tell) -> None:
    """Writes without end."""
    while True:
        os.write(2, b"shout\n" * 100)


def ask_and_take(request: int, tell: Tell) -> int:
    """Tells that it needs memory, and takes it at once."""
    tell("more")
    return len(bytearray(request))


def report(request: list[str], tell: Tell) -> int:
    """Tells some texts."""
    for text in request:
        tell(text)
    return threading.active_count()


#: Names of what ``owned`` let go of, in order.
let_go: list[str] = []


class _Memory:
    """Memory that tells when it is let go of."""

    def __init__(self, name: str, size: int = 0) -> None:
        self._name, self._bytes = name, bytearray(size)

    def array(self) -> Any:
        """An array that keeps this memory."""
        held = (ctypes.c_char * len(self._bytes)).from_buffer(self._bytes)
        held.memory = self  # type: ignore[attr-defined]
        return np.frombuffer(held, np.uint8)

    def __del__(self) -> None:
        let_go.append(self._name)


def owned(request: Any, tell: Tell) -> Owned:
    """Large arrays in memory of an owner."""
    return Owned([_Memory("array", 1 << 20).array() for _ in range(3)], _Memory("owner"))
