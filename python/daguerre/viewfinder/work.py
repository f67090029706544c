"""Work on a request: its rungs, each with more and more samples, until it rests.

A request for the same light in another brightness does not end the work: the present picture is
developed anew, and the samples under way count for it, too.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import zip_longest
from typing import Any, NamedTuple, Protocol

from daguerre.frame.frame import Frame
from daguerre.rendering.rounds import rounds
from daguerre.rendering.session import Session

from .drawn import Drawn, Panel, PictureRequest
from .ghosts import Layer
from .rungs import Rung, rung_of
from .shot import Shot
from .stage import Stage

#: Time between two pictures at full size, s, if samples are that fast.
LONGEST_S = 1.0


class _Frames(NamedTuple):
    """Linear values of a picture.

    Attributes:
        frame: The picture.
        sharp: The same larger, if that shows ghosts sharper.
    """

    frame: Frame
    sharp: Frame | None


class Do(Protocol):
    """Does a step of work; ``Work.expose`` may be called while it lasts."""

    def __call__(self, step: Callable[[], Any]) -> Any:
        """Returns the result of the step."""


class Work:
    """Work on a request.

    Attributes:
        request: The request, or a later request for the same light.
        drawn: Newest picture of the request; None: not drawn yet.
    """

    def __init__(self, request: PictureRequest) -> None:
        self.request = request
        self.drawn: Drawn | None = None
        self._index = 0
        self._rung: Rung | None = None
        self._sessions: list[Session] = []
        self._layers: list[Layer | None] = []  # of live ghosts

    def expose(self, request: PictureRequest) -> bool:
        """Goes on for another request if that asks for the same light; returns whether it does."""
        if not request.shows_as(self.request):
            return False
        if self._rung is None:  # the first rung is being set up
            fits = request.is_lit_as(self.request)
        else:
            rung = rung_of(request, self._index)
            if fits := rung.is_lit_as(self._rung):
                _expose(self._sessions, self._layers, rung)
                self._rung = rung
                self.drawn = self.drawn and self._exposed(self.drawn, request)
        self.request = request if fits else self.request
        return fits

    def pictures(self, do: Do) -> Iterator[Drawn]:
        """Draws until nothing better follows."""
        for index in itertools.count():
            self._set_up(index, do)
            assert self._rung is not None
            steps = _steps(self._rung, self._sessions)
            while (step := do(partial(next, steps, None))) is not None:
                plain = [session.frame(truth=False) for session in self._sessions]
                views = list(map(_with_ghosts, plain, self._layers))
                samples, rests = step
                self.drawn = self._drawn(self.request, views, samples, rests)
                yield self.drawn
                if rests:
                    return

    def _set_up(self, index: int, do: Do) -> None:
        """Sets up a rung as the newest request has it."""
        request = self.request

        def make() -> tuple[Rung, list[Session], list[Layer | None]]:
            rung = rung_of(request, index)
            sessions = [_session(request.stage, shot, rung.last) for shot in rung.shots]
            return rung, sessions, self._layers_of(rung, request.stage)

        rung, sessions, layers = do(make)
        if self.request is not request:  # another brightness was asked for meanwhile
            rung = rung_of(self.request, index)
        _expose(sessions, layers, rung)
        self._index, self._rung, self._sessions, self._layers = index, rung, sessions, layers

    def _layers_of(self, rung: Rung, stage: Stage) -> list[Layer | None]:
        """Layer of live ghosts of each shot; reuses the previous rung's layers if they fit."""
        before = () if self._rung is None else self._rung.ghosts
        pairs = zip_longest(rung.ghosts, before[: len(rung.ghosts)])
        if rung.ghosts and all(old and new.is_lit_as(old) for new, old in pairs):
            return self._layers
        layers = [stage.layers.draw(_session(stage, shot)) for shot in rung.ghosts]
        return layers or [None] * len(rung.shots)

    def _drawn(
        self, request: PictureRequest, views: list[_Frames], samples: int, rests: bool
    ) -> Drawn:
        assert self._rung is not None
        rung, main = self._rung, self._rung.main
        parts = zip(rung.names, rung.shots, self._sessions, views, strict=False)
        return Drawn(
            request,
            rung.shots[main],
            self._sessions[main],
            views[main].frame,
            samples,
            rests,
            whole=rung.last and not request.models,
            panels=tuple(
                Panel(name, shot, session, view.frame, view.sharp)
                for name, shot, session, view in parts
            ),
            sharp=views[main].sharp,
            note=rung.note,
        )

    def _exposed(self, drawn: Drawn, request: PictureRequest) -> Drawn:
        """Returns a picture of the rung with the brightness of another request."""
        before = [_Frames(one.frame, one.sharp) for one in drawn.panels or (drawn,)]
        views = list(map(_exposed, self._sessions, self._layers, before))
        return self._drawn(request, views, drawn.samples, drawn.rests)


def _exposed(session: Session, layer: Layer | None, view: _Frames) -> _Frames:
    sharp = view.sharp
    larger = None if layer is None or sharp is None else layer.session.exposed(sharp)
    return _Frames(session.exposed(view.frame), larger)


def _with_ghosts(frame: Frame, layer: Layer | None) -> _Frames:
    if layer is None:
        return _Frames(frame, None)
    return _Frames(layer.added(frame), layer.sharp(frame))


def _session(stage: Stage, shot: Shot, last: bool = False) -> Session:
    """Session of a shot, maybe of the last rung; keeps the built scene for the next shot."""
    session = Session(
        shot.scene,
        shot.camera,
        settings=shot.settings,
        built=stage.built,
        origin=None if last else stage.origin(shot),
    )
    stage.built = session.built
    session.metering = _metering(shot)
    return session


def _metering(shot: Shot) -> Any:
    return {} if shot.chosen is None else shot.chosen.facts


def _expose(sessions: list[Session], layers: list[Layer | None], rung: Rung) -> None:
    for session, shot in zip(sessions, rung.shots, strict=True):
        session.expose(shot.camera, _metering(shot))
    for layer, shot in zip(layers, rung.ghosts, strict=False):
        if layer is not None:
            layer.session.expose(shot.camera, _metering(shot))


def _steps(rung: Rung, sessions: list[Session]) -> Iterator[tuple[int, bool]]:
    """Draws a rung step by step; yields the samples so far, and whether nothing better follows."""
    if rung.last:
        yield from _refined(sessions)
        return
    for session in sessions:
        session.draw(0, 1)
    yield 1, False


def _refined(sessions: list[Session]) -> Iterator[tuple[int, bool]]:
    """Draws sessions to their end, in turn."""
    sampling = sessions[0].settings.sampling
    if (noise := sampling.noise) is not None:
        for _ in zip_longest(*(rounds(one, noise, sampling.most) for one in sessions)):
            yield _fewest(sessions), False
        yield _fewest(sessions), True
        return
    begin, per_sample = 0, 0.0
    while begin < sampling.most:
        fits = int(LONGEST_S / per_sample) if per_sample > 0 else 1
        end = min(max(1, 2 * begin), begin + max(1, fits), sampling.most)
        started = time.monotonic()
        for session in sessions:
            session.draw(begin, end)
        per_sample = (time.monotonic() - started) / (end - begin)
        yield end, end == sampling.most
        begin = end


def _fewest(sessions: list[Session]) -> int:
    """Smallest number of samples of a pixel."""
    return min(int(session.sample_counts().min()) for session in sessions)
