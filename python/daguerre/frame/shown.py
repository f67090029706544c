"""Pictures that show themselves: in a notebook, else in the desktop's viewer of images."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any


class Shown:
    """Base of pictures that have ``save``, or override ``_repr_png_``."""

    def show(self) -> None:
        """Shows the picture: in a notebook in its cell, else in the desktop's viewer of images.

        Raises:
            OutputError: There is no desktop, or no viewer for its pictures.
        """
        if not _show_in_notebook(self):
            from .viewer import open_picture

            open_picture(self._repr_png_)

    def _shown(self) -> Any:
        """Picture for a screen, which has ``save``."""
        return self

    def _repr_png_(self) -> bytes:
        """The picture as a PNG file, for notebooks."""
        from tempfile import TemporaryDirectory  # imported late: needed in notebooks alone

        with TemporaryDirectory() as folder:
            path = Path(folder) / "picture.png"
            self._shown().save(path)
            return path.read_bytes()


def _show_in_notebook(picture: Shown) -> bool:
    """Shows a picture in the running cell of a notebook; False: there is no notebook."""
    ipython: Any = sys.modules.get("IPython")  # a kernel has loaded it
    shell = None if ipython is None else ipython.get_ipython()
    if not hasattr(shell, "kernel"):
        return False
    from IPython.display import display

    display(picture)  # type: ignore[no-untyped-call]
    return True
