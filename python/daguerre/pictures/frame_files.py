"""Writer of developed pictures that the table of formats calls."""

from __future__ import annotations

import os

from daguerre.frame.picture import Picture

from .picture_files import write_picture


def picture(
    path: str | os.PathLike[str], shown: Picture, quality: int = 95, bits: int | None = None
) -> None:
    """Writes a developed picture."""
    space, facts = shown.colour_space, shown.metadata
    write_picture(path, shown.pixels, space, facts, quality=quality, bits=bits)
