"""Draws a picture pass by pass; between passes it saves, answers signals and reports."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any, Self

from daguerre.cli import console
from daguerre.errors import DaguerreError

from . import passes as pass_files
from .progress import Silent, Status

if TYPE_CHECKING:
    from .schedule import Work
    from .session import Session

#: A pass lasts about this long, so that Ctrl-C and checkpoints need not wait.
PASS_S = 3.0


class Signals:
    """Ctrl-C, SIGTERM, SIGHUP: stop, twice: at once; SIGUSR1: snapshot."""

    def __init__(self) -> None:
        self.stops = 0
        self.answered = False
        self.snapshot = False
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        # Handlers can be set in the main thread only; elsewhere the caller keeps its own.
        with suppress(ValueError):
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                if number == signal.SIGHUP and signal.getsignal(number) == signal.SIG_IGN:
                    continue  # started with nohup: it shall outlive the terminal
                self._before[number] = signal.signal(number, self._stop)
            self._before[signal.SIGUSR1] = signal.signal(signal.SIGUSR1, self._snapshot)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        tb: TracebackType | None,
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _stop(self, number: int, frame: FrameType | None) -> None:
        self.stops += 1

    def _snapshot(self, number: int, frame: FrameType | None) -> None:
        self.snapshot = True


class Loop:
    """Draws the work of a session.

    Args:
        session: The session that draws.
        work: Samples or rounds to draw.
        checkpoint: Where the sums are kept until the picture is complete.
        interval_s: Time between checkpoints; 0: only when interrupted.
        reporter: How progress is shown.
        snapshot: Writes what is there so far under another name.
    """

    def __init__(
        self,
        session: Session,
        work: Work,
        checkpoint: Path,
        interval_s: float,
        reporter: Silent,
        snapshot: Callable[[], None],
    ) -> None:
        self.session = session
        self.work = work
        self.checkpoint = checkpoint
        self.interval_s = interval_s
        self.reporter = reporter
        self.snapshot = snapshot
        self.started = time.monotonic()
        self.drawn_here = 0.0

    def resume(self) -> bool:
        """Takes up the checkpoint, if there is one.

        Raises:
            MismatchError: It is of another picture, or not of this work.
        """
        if not self.checkpoint.exists():
            return False
        saved = pass_files.read_pass(self.checkpoint)
        pass_files.check_key(pass_files.pass_of(self.session), saved)
        self.work.check(saved)
        self.session.set_state(saved.state, saved.ranges, saved.round)
        return True

    def run(self, signals: Signals) -> bool:
        """Draws until all is there, or until a signal asks to stop; True: complete."""
        self.started = time.monotonic()
        saved_at = self.started
        limit = 1.0
        while True:
            size = self.work.prepare(limit)
            self._report(0, 0.0)
            if not size:
                return True
            if signals.stops:
                return False
            before = time.monotonic()
            if not self._draw(size, signals):
                return False
            self.drawn_here += size
            seconds = max(time.monotonic() - before, 1e-9)
            limit = size * min(2.0, PASS_S / seconds)
            if signals.snapshot:
                signals.snapshot = False
                self.snapshot()
            due = self.interval_s > 0 and time.monotonic() - saved_at >= self.interval_s
            if due and self.work.done() < self.work.total():
                self.save()
                saved_at = time.monotonic()

    def save(self) -> bool:
        """Writes the checkpoint; False, with a warning, if that fails: the render goes on."""
        frame = replace(self.session.frame(truth=False, waves=False), aovs={})
        try:
            pass_files.write_pass(self.checkpoint, frame, pass_files.pass_of(self.session))
        except DaguerreError as error:
            console.warn(f"checkpoint not saved: {error}")
            return False
        self.reporter.event("checkpoint", path=str(self.checkpoint), samples=self.work.done())
        return True

    def _draw(self, size: float, signals: Signals) -> bool:
        """One pass, in a thread of its own: Python runs signal handlers in the main thread only."""
        fraction, given_up = 0.0, False
        result: list[bool] = []
        failure: list[BaseException] = []

        def progress(share: float) -> bool:
            nonlocal fraction
            fraction = share
            return not given_up and signals.stops < 2

        def work() -> None:
            try:
                result.append(self.work.draw(progress))
            except BaseException as error:
                failure.append(error)

        thread = threading.Thread(target=work, name="draw", daemon=True)
        thread.start()
        try:
            while thread.is_alive():
                thread.join(0.1)
                if signals.stops and not signals.answered:
                    signals.answered = True
                    console.note("stopping after this pass; Ctrl-C again stops at once")
                self._report(size, fraction)
        finally:
            # Python must not end while the core draws.
            given_up = True
            thread.join()
        if failure:
            raise failure[0]
        return result[0]

    def _report(self, size: float, fraction: float) -> None:
        wanted = self.work.total()
        pixels = frame_pixels(self.session)
        elapsed = max(time.monotonic() - self.started, 1e-9)
        done, here = self.work.done(), self.drawn_here
        # While a thread draws, the session may already count its samples as done.
        total = min((done + size * fraction) / wanted, 1.0)
        rate = (here + size * fraction) / elapsed
        left = wanted * (1 - total) / rate if rate > 0 else None
        rays = float(self.session.counters.rays) / elapsed
        self.reporter.update(
            Status(total, done, wanted, rate * pixels, rays, elapsed, left, **self.work.facts())
        )


def frame_pixels(session: Session) -> int:
    """Pixels that are drawn."""
    x0, y0, x1, y1 = session.crop or (0, 0, session.width, session.height)
    return int((x1 - x0) * (y1 - y0))
