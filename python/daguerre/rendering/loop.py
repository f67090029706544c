"""Loop of a render: draws pass by pass; between passes it saves, checks for a stop, and reports."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import daguerre._core as _core
from daguerre.errors import DaguerreError

from .checkpoint import Checkpoint
from .film_parts import area
from .progress import Status
from .reporter import Control, Reporter

if TYPE_CHECKING:
    from .schedule import Work
    from .session import Session

#: Approximate length of a pass, so that stops and checkpoints need not wait.
PASS_S = 3.0
#: Largest share of the time spent on checkpoints.
SAVING = 0.05


class Loop:
    """Draws the work of a session.

    Args:
        session: Session that draws.
        work: Samples to draw.
        checkpoint: File that keeps the sums.
        reporter: Receives progress and messages.
        control: Decides when to stop.
        snapshot: Writes the picture so far under another name.
        preview: Shows the picture so far; called after each pass but the last.
    """

    def __init__(
        self,
        session: Session,
        work: Work,
        checkpoint: Checkpoint,
        reporter: Reporter,
        control: Control,
        snapshot: Callable[[], None] = lambda: None,
        preview: Callable[[], None] = lambda: None,
    ) -> None:
        self.session, self.work, self.checkpoint = session, work, checkpoint
        self.reporter, self.control = reporter, control
        self.snapshot, self.preview = snapshot, preview
        self.started = time.monotonic()
        self.drawn_here = 0.0
        self._saved = self._save_s = 0.0

    def run(self) -> bool:
        """Draws until the work is complete or the control stops it; True: complete."""
        self.started = time.monotonic()
        saved_at = self.started
        limit = 1.0
        while True:
            size = self.work.prepare(limit)
            self._report(0, 0.0)
            if not size:
                return True
            if self.control.stops:
                return False
            before = time.monotonic()
            if not self._draw(size):
                return False
            self.drawn_here += size
            seconds = max(time.monotonic() - before, 1e-9)
            limit = size * min(2.0, PASS_S / seconds)
            if self.control.snapshot():
                self._snapshot()
            if self.work.done() < self.work.total():
                self.checkpoint.load_writer()
                self.preview()
            interval = self.checkpoint.interval_s
            since = time.monotonic() - saved_at
            due = interval > 0 and since >= max(interval, self._save_s / SAVING)
            if due and self._saved < self.work.done() < self.work.total():
                began = time.monotonic()
                self.save()
                saved_at = time.monotonic()
                self._save_s = saved_at - began

    def save(self, *, rescued: bool = False) -> bool:
        """Writes the checkpoint; returns False, with a warning, if that fails."""
        if self.checkpoint.path is None:
            return False
        try:
            self.checkpoint.save(self.session)
        except DaguerreError as error:
            self.reporter.warning(f"checkpoint not saved: {error}")
            return False
        self._kept(self.checkpoint.path, rescued=rescued)
        return True

    def rescue(self) -> Path | None:
        """Saves the samples when the render ends: beside the picture, else elsewhere.

        Returns:
            The file that has all samples; None if there is none.
        """
        wanted, drawn = self.checkpoint.path, self.work.done()
        if wanted is None or self.session.torn or not drawn:
            return None
        if (drawn == self._saved and wanted.exists()) or self.save(rescued=True):
            return wanted
        path = self.checkpoint.save_elsewhere(self.session)
        if path is not None:
            self._kept(path, rescued=True)
            self.reporter.warning(f"to continue with --resume, move {path} to {wanted}")
        return path

    def _kept(self, path: Path, *, rescued: bool) -> None:
        self._saved = self.work.done()
        self.reporter.saved(path, self._saved, rescued=rescued)

    def _snapshot(self) -> None:
        """Writes a snapshot; if that fails, drawing goes on."""
        try:
            self.snapshot()
        except DaguerreError as error:
            self.reporter.warning(f"snapshot not saved: {error}")

    def _draw(self, size: float) -> bool:
        """Draws a pass in another thread, as Python runs signal handlers in the main thread."""
        fraction, given_up = 0.0, False
        result: list[bool] = []
        failure: list[BaseException] = []

        def progress(share: float) -> bool:
            nonlocal fraction
            fraction = share
            return not given_up and self.control.stops < 2

        if _core.is_ending():  # another thread would draw no more
            return self.work.draw(progress)

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
                self.control.poll()
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
        elapsed = max(time.monotonic() - self.started, 1e-9)
        done, here = self.work.done(), self.drawn_here
        # While a thread draws, the session may already count its samples as done.
        total = min((done + size * fraction) / wanted, 1.0)
        rate = (here + size * fraction) / elapsed
        left = wanted * (1 - total) / rate if rate > 0 else None
        pixels, rays = area(self.session.crop), float(self.session.counters.rays) / elapsed
        self.reporter.progress(
            Status(total, done, wanted, rate * pixels, rays, elapsed, left, **self.work.facts())
        )
