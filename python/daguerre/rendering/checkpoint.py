"""Checkpoints: files that keep the samples of a session until its picture is complete."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from daguerre.errors import DaguerreError
from daguerre.files import atomic, in_use

if TYPE_CHECKING:
    from .schedule import Work
    from .session import Session

#: Time between checkpoints, s.
INTERVAL_S = 60.0


@dataclass(frozen=True)
class Checkpoint:
    """File that keeps samples.

    Attributes:
        path: File, an .exr; None: samples are not kept.
        interval_s: Time between two saves, s; 0: save only when the job stops.
    """

    path: Path | None = None
    interval_s: float = INTERVAL_S

    @property
    def exists(self) -> bool:
        """Whether the file exists."""
        return self.path is not None and self.path.exists()

    def load_writer(self) -> None:
        """Imports the writer of the file early, as memory may be short after hours of drawing."""
        if self.path is not None:
            from . import passes  # noqa: F401

    def save(self, session: Session) -> None:
        """Writes the sums of a session.

        Raises:
            DaguerreError: The file cannot be written.
        """
        if self.path is not None:
            from . import passes

            frame = replace(session.frame(truth=False, waves=False), aovs={})
            passes.write_pass(self.path, frame, passes.pass_of(session))

    def save_elsewhere(self, session: Session) -> Path | None:
        """Writes the sums to a file of the same name in a new temporary folder.

        Returns:
            The file; None if that fails, too.
        """
        assert self.path is not None
        with suppress(OSError):
            from tempfile import mkdtemp

            folder = Path(mkdtemp(prefix="daguerre-"))
            try:
                replace(self, path=folder / self.path.name).save(session)
            except DaguerreError:
                folder.rmdir()
            else:
                return folder / self.path.name
        return None

    def load(self, session: Session, work: Work) -> bool:
        """Loads the samples of the file, if it exists.

        Raises:
            MismatchError: The file belongs to another picture, or to other samples.
        """
        if self.path is None or not self.path.exists():
            return False
        from . import passes

        with in_use.in_place():
            saved = passes.read_pass(self.path)
        passes.check_key(passes.pass_of(session), saved)
        work.check(saved)
        session.set_state(saved.state, saved.ranges, saved.round)
        return True

    def remove(self) -> None:
        """Removes the file when the picture is complete.

        Raises:
            OutputError: The file cannot be removed.
        """
        if self.path is not None:
            atomic.remove(self.path)
