"""Requests, and the pictures that are drawn for them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from daguerre.camera.exposure_mode import RETAKEN
from daguerre.frame.frame import Frame
from daguerre.rendering.session import Session

from .dials import Dials
from .shot import Shot
from .stage import Stage


@dataclass(frozen=True)
class PictureRequest:
    """A picture that a page waits for.

    Attributes:
        number: Number of the turn that asked for the picture; a higher number is newer.
        stage: Scene, camera and settings.
        dials: Positions of the dials.
        shot: The shot at those positions.
        models: Whether the picture compares models of the lens.
        beside: Dial that differs in a second picture, and its text; None: no second picture.
    """

    number: int
    stage: Stage
    dials: Dials
    shot: Shot
    models: bool = False
    beside: Mapping[str, str] | None = None

    def is_lit_as(self, other: PictureRequest) -> bool:
        """Whether the samples of another request are certainly samples of this request, too."""
        same = self.shows_as(other) and self.shot.is_lit_as(other.shot)
        return same and self._is_lit and other._is_lit

    def shows_as(self, other: PictureRequest) -> bool:
        """Whether it shows the same stage, with the same pictures beside each other."""
        return self.stage is other.stage and self.asks[1:] == other.asks[1:]

    @property
    def asks(self) -> tuple[Dials, bool, Mapping[str, str] | None]:
        """All that a page can ask for: dials, models, and the dial of a second picture."""
        return self.dials, self.models, self.beside

    @property
    def _is_lit(self) -> bool:
        """Whether its light is known, as no meter chooses the time or the stop."""
        return self.shot.camera.exposure in RETAKEN


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
    """A picture of a request, with more samples or pixels to come until it rests.

    Attributes:
        request: The request.
        shot: Scene, camera and settings, at the size of this picture.
        session: Session that drew the picture.
        frame: Linear values.
        samples: Samples per pixel.
        rests: Whether no better picture follows.
        whole: Whether the picture has its full size.
        panels: Pictures to show side by side instead; empty: this picture.
        sharp: The frame upsampled, with sharp ghosts; None: no such frame.
        note: Why the second picture that was asked for is missing.
    """

    request: PictureRequest
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
