# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws one picture to its end, while its caller's thread asks whether to stop."""

import threading
from collections.abc import Callable
from typing import Protocol, TypeVar

from daguerre import memory
from daguerre.frame.frame import Frame
from daguerre.rendering import Cancelled, CancelToken, Control, Reporter, Status
from daguerre.rendering.checkpoint import Checkpoint
from daguerre.rendering.loop import Loop
from daguerre.rendering.schedule import work_of
from daguerre.rendering.session import Session

from . import denoising
from .translation import Shot

#: Time between two questions whether to stop, s.
POLL_S = 0.05
#: Time that a step which was told to stop gets to do so, s; after it nobody waits for it.
GRACE_S = 0.5

T = TypeVar("T")
Frames = Callable[[Frame], None]


class Engine(Protocol):
    """The part of Blender's ``RenderEngine`` that follows and stops a picture."""

    def test_break(self) -> bool:
        """Whether the user cancelled."""

    def update_progress(self, progress: float) -> None:
        """Shows the share that is done."""

    def update_stats(self, stats: str, info: str) -> None:
        """Shows two texts in the status bar."""

    def update_memory_stats(self, memory_used: float = 0, memory_peak: float = 0) -> None:
        """Shows memory, MB."""


class Watch(Reporter, Control):
    """Tells Blender how a picture goes, and stops it if the user cancels."""

    def __init__(self, engine: Engine) -> None:
        self.engine, self.peak, self.fraction = engine, 0.0, 0.0

    def poll(self) -> None:
        """Stops at once if the user cancelled."""
        if self.engine.test_break():
            self.stops = 2

    def progress(self, status: Status) -> None:
        """Shows samples, time left and memory."""
        self.fraction = max(self.fraction, status.fraction)  # an estimate, which may fall
        self.engine.update_progress(self.fraction)
        used = memory.own_bytes()
        self.peak = max(self.peak, used)
        self.engine.update_memory_stats(memory_used=used / 1e6, memory_peak=self.peak / 1e6)
        self.engine.update_stats("", " | ".join([*texts(status), f"Mem {memory.shown(used)}"]))


def texts(status: Status) -> list[str]:
    """Samples, noise and time left as text."""
    left = [] if status.left_s is None else [f"Remaining {clock(status.left_s)}"]
    return [*left, *status.words[: 1 + (status.noise_wanted is not None)]]


def clock(seconds: float) -> str:
    """Time as Blender writes it, such as 01:02.5 or 2:03:04."""
    minutes, rest = divmod(seconds, 60)
    hours, minutes = divmod(int(minutes), 60)
    return f"{hours}:{minutes:02}:{int(rest):02}" if hours else f"{minutes:02}:{rest:04.1f}"


def cancellable(step: Callable[[], T], cancelled: Callable[[], bool]) -> T:
    """Runs a long step in another thread, and asks meanwhile whether to stop.

    Raises:
        Cancelled: ``cancelled`` said so.
    """
    token, found, failed = CancelToken(), list[T](), list[BaseException]()

    def run() -> None:
        try:
            with token:
                found.append(step())
        except BaseException as error:  # the caller's thread raises it
            failed.append(error)

    thread = threading.Thread(target=run, name="daguerre step", daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(POLL_S)
        if cancelled():
            token.cancel()
            thread.join(GRACE_S)
            token.throw_if_cancelled()
    if failed:
        raise failed[0]
    return found[0]


class Drawing:
    """One picture.

    Args:
        engine: Engine of Blender that shows it.
        shot: The picture.
        show: Called with each frame on the way.
        open: Makes the session of the picture; default: as it is.
    """

    def __init__(
        self, engine: Engine, shot: Shot, show: Frames, open: Callable[[], Session] | None = None
    ) -> None:
        self.engine, self.shot, self.show = engine, shot, show
        self._open = open or (lambda: Session(shot.scene, shot.camera, settings=shot.settings))
        self.watch = Watch(engine)

    def run(self, *, denoises: bool) -> Frame:
        """Draws the picture and returns its last frame.

        Raises:
            Cancelled: The user cancelled.
            DaguerreError: The picture cannot be drawn.
        """
        self.engine.update_stats("", "Setting up")
        session = self._long(self._open)
        self._draw(session)
        if denoises:
            self.engine.update_stats("", "Denoising")
        return self._long(lambda: _finished(session, denoises=denoises))

    def _long(self, step: Callable[[], T]) -> T:
        return cancellable(step, self.engine.test_break)

    def _draw(self, session: Session) -> None:
        sampling = session.settings.sampling
        work = work_of(session, (0, sampling.most), sampling.noise)

        def preview() -> None:
            self.show(session.frame(truth=False, waves=False))

        loop = Loop(session, work, Checkpoint(), self.watch, self.watch, preview=preview)
        if not loop.run():
            raise Cancelled


def _finished(session: Session, *, denoises: bool) -> Frame:
    frame = session.frame()
    if not denoises:
        return frame
    from daguerre.rendering.denoise import denoise, denoised

    blenders = denoising.of_blender()
    return denoise(frame) if blenders is None else denoised(frame, blenders)


def check_denoiser() -> None:
    """Checks, before anything is drawn, that there is a denoiser.

    Raises:
        UsageError: There is none.
    """
    from daguerre.rendering.denoise import check_available

    if denoising.of_blender() is None:
        check_available()
