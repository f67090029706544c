"""Reports uses of a reader to its limits: files, and bytes of decoded pictures."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

#: Receives the name of a file before it is read, or the bytes of a picture after decoding.
Listener = Callable[[str | int], None]
_listener: Listener | None = None


@contextmanager
def heard_by(listener: Listener) -> Iterator[None]:
    """Lets a listener hear all uses of this process, from any thread."""
    global _listener
    before, _listener = _listener, listener
    try:
        yield
    finally:
        _listener = before


def opens(path: str | os.PathLike[str]) -> None:
    """Reports that a file is about to be read."""
    if _listener is not None:
        _listener(os.fspath(path))


def decoded(count: int) -> None:
    """Reports the bytes of a decoded picture."""
    if _listener is not None:
        _listener(count)
