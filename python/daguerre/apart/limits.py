"""Limits of a helper process, and the message for the limit that ended it."""

from __future__ import annotations

import signal
from dataclasses import dataclass

from daguerre import memory

#: Words in the messages of libraries that ran out of memory.
_NO_MEMORY = ("bad_alloc", "MemoryError", "annot allocate memory", "length_error")
#: Share of the limit of memory beyond which a signal means a lack of it.
_NEARLY = 0.8


@dataclass(frozen=True)
class Limits:
    """Limits of a task.

    Attributes:
        seconds: Time, s. Waiting for a processor does not count.
        memory: Resident memory of the helper, bytes.
    """

    seconds: float
    memory: int


def too_long(limits: Limits) -> str:
    """Words for a task that took too long."""
    return f"the helper process took longer than {limits.seconds:.3g} s"


def too_much(limits: Limits) -> str:
    """Words for a task that took too much memory."""
    return f"the helper process took more than {memory.shown(limits.memory)} of memory"


def ended(code: int, peak: float, limits: Limits, words: str) -> str:
    """Message for a helper that ended before its answer.

    Args:
        code: Exit code; negative: a signal.
        peak: Largest resident memory in a sample, bytes.
        limits: Limits of the task.
        words: Last part of the helper's standard error.
    """
    if any(word in words for word in _NO_MEMORY) or (code < 0 and peak > _NEARLY * limits.memory):
        return too_much(limits)
    if code < 0:
        return f"the helper process ended by {_signal(-code)}"
    return f"the helper process ended with exit code {code}"


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
