"""A pipe that tells whether anyone opened it to read."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class Pipe:
    """A named pipe; a reader of it gets an end of file at once, and is remembered.

    Attributes:
        opened: Whether there was a reader.
    """

    def __init__(self, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        os.mkfifo(path)
        self.path, self.opened = path, False
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()

    def _watch(self) -> None:
        while not self._done.wait(0.02):
            try:
                os.close(os.open(self.path, os.O_WRONLY | os.O_NONBLOCK))
                self.opened = True
            except OSError:  # no reader
                pass

    def close(self) -> None:
        """Ends the watch."""
        self._done.set()
        self._thread.join()


@contextmanager
def watched(path: Path) -> Iterator[Pipe]:
    """Makes a pipe and watches it."""
    pipe = Pipe(path)
    try:
        yield pipe
    finally:
        pipe.close()
