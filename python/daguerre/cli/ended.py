"""SIGTERM and SIGHUP: they end a command with a word, as Ctrl-C does.

While a picture is drawn, :mod:`.signals` handles them.
"""

from __future__ import annotations

import signal
from types import FrameType

#: Names of the signals that the process got.
_got: list[str] = []


def by_signals() -> None:
    """Lets the signals end the command; a signal that is ignored, as by nohup, stays ignored."""
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)  # Windows has no SIGHUP
        if number is not None and signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, _end)


def told() -> str:
    """Names the signal that interrupted the command."""
    return f"interrupted by {_got[-1]}" if _got else "interrupted"


def _end(number: int, frame: FrameType | None) -> None:
    signal.signal(number, signal.SIG_DFL)  # a second one ends the process at once
    _got.append(signal.Signals(number).name)
    raise KeyboardInterrupt
