"""Signals of a render: Ctrl-C, SIGTERM, SIGHUP stop it (twice: at once); SIGUSR1: a snapshot."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any

from daguerre.rendering.reporter import Control

from . import console


class Signals(Control):
    """Stops a job, or requests a snapshot, when the process gets a signal."""

    def __init__(self) -> None:
        self.stops = 0
        self._answered = self._snapshot = False

    def poll(self) -> None:
        """Prints a note at the first signal to stop."""
        if self.stops and not self._answered:
            self._answered = True
            console.note("stopping after this pass; Ctrl-C again stops at once")

    def snapshot(self) -> bool:
        """Whether SIGUSR1 came since the last call."""
        wanted, self._snapshot = self._snapshot, False
        return wanted

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Handles the signals while a picture is drawn."""
        before: dict[int, Any] = {}
        # Handlers can be set in the main thread only; elsewhere the caller keeps its own.
        with suppress(ValueError):
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                if number == signal.SIGHUP and signal.getsignal(number) == signal.SIG_IGN:
                    continue  # started with nohup: it shall outlive the terminal
                before[number] = signal.signal(number, self._stop)
            before[signal.SIGUSR1] = signal.signal(signal.SIGUSR1, self._ask)
        try:
            yield
        finally:
            for which, handler in before.items():
                signal.signal(which, handler)

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self.stops += 1

    def _ask(self, number: int, frame: FrameType | None) -> None:
        self._snapshot = True
