"""Wishes, and the pictures that are drawn for them."""

from __future__ import annotations

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
    """

    number: int
    stage: Stage
    dials: Dials
    shot: Shot
    models: bool = False

    def is_lit_as(self, other: Wish) -> bool:
        """Whether the samples of another wish certainly show this one, too."""
        same = self.stage is other.stage and self.models == other.models
        return same and self.shot.is_lit_as(other.shot) and self._is_lit and other._is_lit

    @property
    def _is_lit(self) -> bool:
        """Whether its light is known, as no meter chooses the time or the stop."""
        return split_mode(self.shot.camera.exposure)[0] in RETAKEN


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
