"""``--preview``: shows a picture while it is drawn, in a file beside the output."""

from __future__ import annotations

from pathlib import Path

from daguerre.cli import console
from daguerre.errors import DaguerreError
from daguerre.files import atomic
from daguerre.rendering.reporter import PreviewPicture


class Preview:
    """Writes previews, until that fails.

    Attributes:
        works: Whether no preview has failed.
    """

    def __init__(self) -> None:
        self.works = True
        self._named: set[Path] = set()

    def show(self, look: PreviewPicture) -> None:
        """Writes a preview, or removes the file of a complete picture.

        A failure ends previews, but not the render.
        """
        try:
            if look.complete:
                atomic.remove(look.path)
            else:
                self._write(look)
        except (DaguerreError, OSError) as error:
            self.works = False
            console.warn(f"--preview: {error}; the preview stops")

    def _write(self, look: PreviewPicture) -> None:
        look.write(look.path)
        if look.path not in self._named:
            self._named.add(look.path)
            console.note(f"preview: {look.path}")
