"""Ends the threads of OpenImageIO before a fork and restarts them after it.

A fork loses them, and the forked process would wait for them at its end.
``core/bind/unlocked.cpp`` does the same for oneTBB.
"""

from __future__ import annotations

import os
import sys

_threads = 0


def _before() -> None:
    global _threads
    if library := sys.modules.get("OpenImageIO"):
        _threads = library.get_int_attribute("threads")
        library.attribute("threads", 1)


def _after() -> None:
    global _threads
    if _threads:
        sys.modules["OpenImageIO"].attribute("threads", _threads)
    _threads = 0


os.register_at_fork(before=_before, after_in_parent=_after, after_in_child=_after)
