"""Checkpoints: a file that keeps a session's samples until its picture is complete."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING

from daguerre.errors import DaguerreError
from daguerre.files import atomic

from . import passes

if TYPE_CHECKING:
    from .schedule import Work
    from .session import Session

#: Time between checkpoints, s.
INTERVAL_S = 60.0


@dataclass(frozen=True)
class Checkpoint:
    """Where samples are kept.

    Attributes:
        path: File, an .exr; None: they are not kept.
        interval_s: Time between two saves; 0: only when the job stops.
    """

    path: Path | None = None
    interval_s: float = INTERVAL_S

    @property
    def exists(self) -> bool:
        """Whether there is one."""
        return self.path is not None and self.path.exists()

    def save(self, session: Session) -> None:
        """Writes the sums that a session has.

        Raises:
            DaguerreError: The disk does not take them.
        """
        if self.path is not None:
            frame = replace(session.frame(truth=False, waves=False), aovs={})
            passes.write_pass(self.path, frame, passes.pass_of(session))

    def save_elsewhere(self, session: Session) -> Path | None:
        """Writes the sums to a file of the same name in a new folder for temporary files.

        Returns:
            The file; None if there is no place for it, either.
        """
        assert self.path is not None
        with suppress(OSError):
            folder = Path(mkdtemp(prefix="daguerre-"))
            try:
                replace(self, path=folder / self.path.name).save(session)
            except DaguerreError:
                folder.rmdir()
            else:
                return folder / self.path.name
        return None

    def load(self, session: Session, work: Work) -> bool:
        """Takes up the samples of the file, if there is one.

        Raises:
            MismatchError: It belongs to another picture, or not to this work.
        """
        if self.path is None or not self.path.exists():
            return False
        saved = passes.read_pass(self.path)
        passes.check_key(passes.pass_of(session), saved)
        work.check(saved)
        session.set_state(saved.state, saved.ranges, saved.round)
        return True

    def remove(self) -> None:
        """Removes the file: the picture is complete.

        Raises:
            OutputError: The folder does not allow it.
        """
        if self.path is not None:
            atomic.remove(self.path)
