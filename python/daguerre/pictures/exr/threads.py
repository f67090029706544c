"""Runs the threads of the package OpenEXR only while a file is written, as a fork loses them.

A forked process has one thread. The package would still count its parent's threads, and wait for
them for ever.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from daguerre.errors import OutputError

_changing = threading.Lock()
_writers = 0
_torn = False


@contextmanager
def threads(path: str | os.PathLike[str]) -> Iterator[None]:
    """Lets the package compress on several threads, as compression takes most of the time.

    Args:
        path: The file that is written, for messages.

    Raises:
        OutputError: This process was forked while another thread of its parent wrote an .exr.
    """
    import OpenEXR

    global _writers
    if _torn:
        raise OutputError(
            f"{path}: cannot write: this process was forked while its parent wrote an .exr; start "
            "processes by spawn or forkserver, or fork while no .exr is written"
        )
    with _changing:
        _writers += 1
        OpenEXR.set_global_thread_count(min(os.cpu_count() or 1, 8))
    try:
        yield
    finally:
        with _changing:
            _writers -= 1
            if not _writers:
                OpenEXR.set_global_thread_count(0)


def _in_child() -> None:
    global _changing, _torn
    _torn = _torn or _writers > 0 or _changing.locked()
    _changing = threading.Lock()


os.register_at_fork(after_in_child=_in_child)
