"""``--preview``: shows a picture while it is drawn, in the terminal if it can, else in a file."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from daguerre.cli import console
from daguerre.errors import DaguerreError
from daguerre.files import atomic
from daguerre.rendering.reporter import PreviewPicture

from .protocols import Pixels
from .screen import Screen
from .terminal import Way, way_of


class Preview:
    """Shows previews, until that fails.

    Args:
        in_terminal: Whether to query the terminal for picture support.

    Attributes:
        way: Picture protocol of the terminal; None: previews go to a file.
    """

    def __init__(self, *, in_terminal: bool) -> None:
        self.way: Way | None = None
        if in_terminal:
            self.way = way_of(sys.stdin, sys.stderr, os.environ)
        self.works = True
        self._told: set[Path] = set()

    def show(self, look: PreviewPicture, screen: Screen | None) -> None:
        """Shows a preview; a failure ends previews, but not the render.

        Args:
            look: The preview.
            screen: Terminal to show it; None: a file, until the picture is complete.
        """
        try:
            if screen is not None:
                screen.picture(_pixels(look))
            elif look.complete:
                atomic.remove(look.path)
            else:
                self._write(look)
        except (DaguerreError, OSError) as error:
            self.works = False
            console.warn(f"--preview: {error}; the preview stops")

    def _write(self, look: PreviewPicture) -> None:
        look.write(look.path)
        if look.path not in self._told:
            self._told.add(look.path)
            console.note(f"preview: {look.path}")


def _pixels(look: PreviewPicture) -> Pixels:
    """Pixels of the picture as in a file, (H, W, 3)."""
    import OpenImageIO as oiio

    with TemporaryDirectory() as folder:
        path = Path(folder) / "preview.png"
        look.write(path)
        pixels = np.asarray(oiio.ImageBuf(str(path)).get_pixels(oiio.UINT8), np.uint8)
    return np.ascontiguousarray(pixels[:, :, :3])
