"""Wishes, and the pictures that are drawn for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from daguerre.camera.exposure_mode import RETAKEN, split_mode
from daguerre.frame.frame import Frame
from daguerre.rendering.session import Session

from .dials import Dials
from .shot import Shot
from .stage import Stage


@dataclass(frozen=True)
class Wish:
    """A picture that someone waits for.

    Attributes:
        number: Number of the turn that made it; a higher one is newer.
        stage: Scene, camera and settings.
        dials: Positions of the dials.
        shot: The picture that they ask for.
        models: Whether it compares models of the lens.
        beside: Dial that differs in a second picture, and its text; None: there is one picture.
    """

    number: int
    stage: Stage
    dials: Dials
    shot: Shot
    models: bool = False
    beside: Mapping[str, str] | None = None

    def is_lit_as(self, other: Wish) -> bool:
        """Whether the samples of another wish certainly show this one, too."""
        same = self.shows_as(other) and self.shot.is_lit_as(other.shot)
        return same and self._is_lit and other._is_lit

    def shows_as(self, other: Wish) -> bool:
        """Whether it shows the same stage, with the same pictures beside each other."""
        return self.stage is other.stage and self.asks[1:] == other.asks[1:]

    @property
    def asks(self) -> tuple[Dials, bool, Mapping[str, str] | None]:
        """All that a page can ask of it: dials, models, and what is beside it."""
        return self.dials, self.models, self.beside

    @property
    def _is_lit(self) -> bool:
        """Whether its light is known, as no meter chooses the time or the stop."""
        return split_mode(self.shot.camera.exposure)[0] in RETAKEN


@dataclass(frozen=True)
class Panel:
    """One of several pictures side by side.

    Attributes:
        name: Its name.
        shot: Its shot.
        session: Session that drew it.
        frame: Its linear values.
        sharp: The same larger, to be shown with sharp ghosts; None: there is no such frame.
    """

    name: str
    shot: Shot
    session: Session
    frame: Frame
    sharp: Frame | None = None


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
        sharp: The frame larger, to be shown with sharp ghosts; None: there is no such frame.
        note: Why there is no picture beside it, though one was asked for.
    """

    wish: Wish
    shot: Shot
    session: Session
    frame: Frame
    samples: int
    rests: bool
    whole: bool = True
    panels: tuple[Panel, ...] = ()
    sharp: Frame | None = None
    note: str = ""

    @property
    def main(self) -> int:
        """Number of the panel that the dials show."""
        frames = [panel.frame for panel in self.panels] or [self.frame]
        return next(i for i, frame in enumerate(frames) if frame is self.frame)

    @property
    def is_one(self) -> bool:
        """Whether it is shown alone, at its full size."""
        return self.whole and not self.panels
