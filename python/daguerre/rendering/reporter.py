"""Reporter and control: interfaces through which a front end follows and stops a job."""

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
    """A complete picture with written files.

    Attributes:
        session: Session that drew it.
        frame: The picture.
        paths: Its files.
        samples: Samples per pixel; their mean if they differ.
        drawn: Samples per pixel that this run drew.
        seconds: Time since drawing began, s.
        setup_s: Time of the set-up before that, s.
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
    """A picture that was stopped before it was complete.

    Attributes:
        samples: Samples per pixel drawn.
        total: Samples per pixel that a complete picture has.
        checkpoint: File that keeps samples; None: no such file.
        saved: Whether the checkpoint has all samples drawn.
    """

    samples: float
    total: float
    checkpoint: Path | None
    saved: bool


@dataclass(frozen=True)
class PreviewPicture:
    """A preview of a picture that is being drawn.

    Attributes:
        frame: Frame of the samples so far.
        path: File for previews, beside the output.
        write: Function that writes the preview to a display file, atomically.
        complete: Whether it is the final picture.
    """

    frame: Frame
    path: Path
    write: Callable[[Path], None]
    complete: bool = False


class Reporter:
    """Receives the messages of a job; this one ignores them, front ends override it."""

    @property
    def previews(self) -> bool:
        """Whether it shows previews."""
        return False

    def drawing(self, facts: Mapping[str, Any]) -> AbstractContextManager[Any]:
        """Context for drawing a picture; ``facts`` may have ``frame`` and ``camera``."""
        return nullcontext()

    def progress(self, status: Status) -> None:
        """Shows the progress of the picture; called several times a second."""

    def preview(self, look: PreviewPicture) -> None:
        """Shows previews of a picture, and finally the complete picture."""

    def note(self, text: str) -> None:
        """Reports a note."""

    def warning(self, text: str) -> None:
        """Reports a warning: a result that the user probably does not want."""

    def saved(self, path: Path, samples: float, *, rescued: bool = False) -> None:
        """Reports a saved checkpoint; ``rescued``: saved because the picture was not written."""

    def finished(self, result: Finished) -> None:
        """Reports a complete picture."""

    def stopped(self, result: Stopped) -> None:
        """Reports a picture that the control stopped."""


class Control:
    """Decides when to stop; this one never does.

    Attributes:
        stops: 0: go on; 1: stop after the pass that is being drawn; 2: stop at once.
    """

    stops: int = 0

    def poll(self) -> None:
        """Updates the state; called several times a second in the thread that runs the job."""

    def snapshot(self) -> bool:
        """Whether to write a snapshot of the samples so far; each request counts once."""
        return False

    def watching(self) -> AbstractContextManager[Any]:
        """Context of the drawing of a picture."""
        return nullcontext()
