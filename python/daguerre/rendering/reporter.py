"""Reporter and control: how a job tells what it does, and is told to stop, by any front end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .progress import Status

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame

    from .session import Session


@dataclass(frozen=True)
class Finished:
    """A picture that is in its files.

    Attributes:
        session: Session that drew it.
        frame: The picture.
        paths: Its files.
        samples: Samples per pixel; a mean where they differ.
        drawn: Samples per pixel that this run drew.
        seconds: Time since drawing began.
        setup_s: Time before that.
    """

    session: Session
    frame: Frame
    paths: tuple[Path, ...]
    samples: float
    drawn: float
    seconds: float
    setup_s: float


@dataclass(frozen=True)
class Stopped:
    """A picture that is not complete.

    Attributes:
        samples: Samples per pixel that were drawn.
        total: Samples per pixel that were wanted.
        checkpoint: File that keeps samples; None: there is none.
        saved: Whether it has all that were drawn.
    """

    samples: float
    total: float
    checkpoint: Path | None
    saved: bool


@dataclass(frozen=True)
class Look:
    """A picture in the making.

    Attributes:
        frame: The samples so far.
        path: File for it beside the output.
        write: Writes it to a file for the eye, whole or not at all.
        complete: Whether it is the picture itself.
    """

    frame: Frame
    path: Path
    write: Callable[[Path], None]
    complete: bool = False


class Reporter:
    """Says nothing; front ends say what they like."""

    @property
    def previews(self) -> bool:
        """Whether it shows pictures that are not complete."""
        return False

    def drawing(self, facts: Mapping[str, Any]) -> AbstractContextManager[Any]:
        """Surrounds the drawing of a picture, named by its ``frame`` and ``camera`` if several."""
        return nullcontext()

    def progress(self, status: Status) -> None:
        """Shows how far the picture is; called several times a second."""

    def preview(self, look: Look) -> None:
        """Shows a picture that is not complete, and at the end the one that is."""

    def note(self, text: str) -> None:
        """Says what is good to know."""

    def warning(self, text: str) -> None:
        """Says what is probably not wanted."""

    def saved(self, path: Path, samples: float, *, rescued: bool = False) -> None:
        """Tells of a checkpoint; ``rescued``: because the picture could not be written."""

    def finished(self, result: Finished) -> None:
        """Tells of a picture that is complete."""

    def stopped(self, result: Stopped) -> None:
        """Tells of a picture that is not, because the control stopped it."""


class Control:
    """Decides when to stop; this one never does.

    Attributes:
        stops: 0: go on; 1: stop after the pass that is being drawn; 2: stop at once.
    """

    stops: int = 0

    def poll(self) -> None:
        """Looks around; called several times a second in the thread that runs the job."""

    def snapshot(self) -> bool:
        """Whether a picture of the samples so far is wanted, once."""
        return False

    def watching(self) -> AbstractContextManager[Any]:
        """Surrounds the drawing of a picture."""
        return nullcontext()
