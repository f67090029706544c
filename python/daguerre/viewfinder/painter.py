"""Painter: draws the newest wish, first small and grainy, then better until it rests."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from daguerre.frame.frame import Frame
from daguerre.rendering import Cancelled, CancelToken
from daguerre.rendering.rounds import rounds
from daguerre.rendering.session import Session

from .dials import Dials
from .shot import Shot
from .stage import Stage

#: Divisors of the picture's size, before the whole picture with 1, 2, 4, ... samples.
LADDER = (6, 3)
#: Models of the lens that are compared, side by side, and the divisor of their pictures' size.
MODELS = ("pinhole", "thin", "exact")
BESIDE = 3
#: Samples of the steps of a comparison.
_STEPS = (1, 4, 16, 64)
#: By how much threads that draw are nicer than the rest.
NICE = 10
#: Time between two pictures at full size, s, if samples are that fast.
LONGEST_S = 1.0


@dataclass(frozen=True)
class Wish:
    """A picture that someone waits for.

    Attributes:
        number: Number of the turn that made it; a higher one is newer.
        stage: Scene, camera and settings.
        dials: Positions of the dials.
        shot: The picture that they ask for.
        models: Whether it compares models of the lens.
    """

    number: int
    stage: Stage
    dials: Dials
    shot: Shot
    models: bool = False


@dataclass(frozen=True)
class Panel:
    """One of several pictures side by side: the model of its lens, its shot and its frame."""

    model: str
    shot: Shot
    frame: Frame


@dataclass(frozen=True)
class Drawn:
    """A picture of a wish, on its way to rest.

    Attributes:
        wish: The wish.
        shot: Scene, camera and settings, at the size of this picture.
        session: Session that drew it.
        frame: Its linear values.
        samples: Samples per pixel.
        rests: Whether nothing better follows.
        whole: Whether it has its full size.
        panels: Pictures to show instead, side by side; empty: this one.
    """

    wish: Wish
    shot: Shot
    session: Session
    frame: Frame
    samples: int
    rests: bool
    whole: bool = True
    panels: tuple[Panel, ...] = ()


class Painter:
    """A thread that draws wishes; the newest one ends the work on those before.

    Args:
        show: Called in the painter's thread with each picture.
        fail: Called there with a wish that cannot be drawn, and the reason.
    """

    def __init__(
        self,
        show: Callable[[Drawn], None],
        fail: Callable[[Wish, Exception], None],
    ) -> None:
        self._show, self._fail = show, fail
        self._changed = threading.Condition()
        self._wish: Wish | None = None
        self._token = CancelToken()
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="viewfinder painter", daemon=True)
        self._thread.start()

    def wish(self, wish: Wish) -> None:
        """Asks for a picture, instead of all before."""
        with self._changed:
            self._wish = wish
            self._token.cancel()
            self._changed.notify()

    def rest(self) -> None:
        """Ends the work on the wish, and draws nothing until the next one."""
        with self._changed:
            self._wish = None
            self._token.cancel()

    def close(self) -> None:
        """Ends the thread and waits for it."""
        with self._changed:
            self._closed = True
            self._token.cancel()
            self._changed.notify()
        self._thread.join()

    def _next(self) -> Wish | None:
        """Waits for a wish; None: the painter was closed."""
        with self._changed:
            while self._wish is None and not self._closed:
                self._changed.wait()
            self._token = CancelToken()
            wish, self._wish = self._wish, None
            return None if self._closed else wish

    def _run(self) -> None:
        _yield_to_others()
        while (wish := self._next()) is not None:
            try:
                with self._token:
                    for drawn in self._pictures(wish):
                        self._token.throw_if_cancelled()
                        self._show(drawn)
            except Cancelled:
                pass
            except Exception as error:  # whatever it is, the next wish is drawn
                self._fail(wish, error)

    def _pictures(self, wish: Wish) -> Iterator[Drawn]:
        stage = wish.stage
        if wish.models:
            yield from _compared(wish, stage.exposed(wish.shot))
            return
        quick = stage.exposed(wish.shot, fresh=False)
        for divisor in LADDER:
            small = quick.smaller(divisor)
            if small.settings.film.resolution != quick.settings.film.resolution:
                session = _session(wish, small)
                session.draw(0, 1)
                frame = session.frame(truth=False)
                yield Drawn(wish, small, session, frame, 1, rests=False, whole=False)
        shot = stage.exposed(wish.shot)
        session = _session(wish, shot)
        for samples, rests in _refined(session):
            frame = session.frame(truth=False)
            yield Drawn(wish, shot, session, frame, samples, rests=rests)


def _yield_to_others() -> None:
    """Lets the server and the browser go first: threads that draw inherit this one's priority."""
    if hasattr(os, "setpriority"):  # on Linux of this thread alone, elsewhere of the process
        now = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, 0, now + NICE)


def _session(wish: Wish, shot: Shot) -> Session:
    """Session of a shot; the built scene is kept for the next one."""
    stage = wish.stage
    session = Session(shot.scene, shot.camera, settings=shot.settings, built=stage.built)
    stage.built = session.built
    if shot.chosen is not None:
        session.metering = shot.chosen.facts
    return session


def _compared(wish: Wish, shot: Shot) -> Iterator[Drawn]:
    """Draws small pictures by each model of the lens, with more and more samples."""
    most = shot.settings.sampling.most
    steps = [step for step in _STEPS if step < most] + [most]
    shots = [shot.by_model(model, BESIDE, most) for model in MODELS]
    sessions = [_session(wish, one) for one in shots]
    begin = 0
    for end in steps:
        for session in sessions:
            session.draw(begin, end)
        begin = end
        frames = [session.frame(truth=False) for session in sessions]
        panels = tuple(map(Panel, MODELS, shots, frames))
        yield Drawn(
            wish, shots[-1], sessions[-1], frames[-1], end,
            rests=end == most, whole=False, panels=panels,
        )  # fmt: skip


def _refined(session: Session) -> Iterator[tuple[int, bool]]:
    """Draws a session to its end; yields the samples so far, and whether they are all."""
    sampling = session.settings.sampling
    if sampling.noise is not None:
        for _ in rounds(session, sampling.noise, sampling.most):
            yield int(session.sample_counts().min()), False
        yield int(session.sample_counts().min()), True
        return
    begin, per_sample = 0, 0.0
    while begin < sampling.most:
        fits = int(LONGEST_S / per_sample) if per_sample > 0 else 1
        end = min(max(1, 2 * begin), begin + max(1, fits), sampling.most)
        started = time.monotonic()
        session.draw(begin, end)
        per_sample = (time.monotonic() - started) / (end - begin)
        yield end, end == sampling.most
        begin = end
