"""Background: work that lets the server and the browser go first.

Threads inherit the priority of the thread that starts them, and the core keeps those that draw for
the whole process: all that draws before the painter must run here, too.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from daguerre.rendering import CancelToken

#: By how much threads that draw are nicer than the rest.
NICE = 10
#: Whether the system can make them so; on Linux one thread alone, elsewhere the whole process.
_CAN = hasattr(os, "setpriority")
_BEFORE = os.getpriority(os.PRIO_PROCESS, 0) if _CAN else 0
T = TypeVar("T")


def in_background(work: Callable[[], T]) -> T:
    """Does work in a thread of its own and waits for it; an interrupt cancels it."""
    token = CancelToken()
    with background_thread("viewfinder opening") as hand:
        try:
            return hand.submit(under, token, work).result()
        except BaseException:
            token.cancel()
            raise


def background_thread(name: str, nice: int = NICE) -> ThreadPoolExecutor:
    """Makes an executor with one thread that is nicer than the rest."""
    return ThreadPoolExecutor(1, name, _yield_to_others, (nice,))


def under(token: CancelToken, step: Callable[[], T]) -> T:
    """Does a step that a token can cancel."""
    with token:
        return step()


def _yield_to_others(nice: int) -> None:
    if _CAN:
        os.setpriority(os.PRIO_PROCESS, 0, _BEFORE + nice)
