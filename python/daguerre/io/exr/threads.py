"""Threads of the package OpenEXR: there while a file is written, since a fork would lose them.

A process that is forked has one thread. To the package those of its parent still seem to be there,
so it would wait for them for ever.
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
    """Lets the package compress on many threads, which is most of the time of writing.

    Args:
        path: The file that is written, for complaints.

    Raises:
        OutputError: This process was forked while another thread of its parent was in here.
    """
    import OpenEXR

    global _writers
    if _torn:
        raise OutputError(
            f"{path}: cannot write: this process was forked while its parent wrote an .exr; start "
            "processes by spawn or forkserver, or fork when nothing is written"
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
