"""Writers of frames and pictures that the table of formats calls."""

from __future__ import annotations

import os

from daguerre.frame.frame import Frame
from daguerre.frame.picture import Picture

from .exr.write import write_exr
from .picture_files import write_picture
from .png import write_png


def as_exr(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes all data of a frame; ``tone`` has no effect on linear files."""
    write_exr(path, frame)


def as_png(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes a display picture with EXIF, without overscan."""
    write_png(path, frame.without_overscan(), tone)


def as_picture(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes a display picture with EXIF and an ICC profile, without overscan."""
    shown = frame.without_overscan()
    picture(path, Picture(shown.encoded(tone), "srgb", shown.metadata))


def picture(
    path: str | os.PathLike[str], shown: Picture, quality: int = 95, bits: int | None = None
) -> None:
    """Writes a developed picture."""
    space, facts = shown.colour_space, shown.metadata
    write_picture(path, shown.pixels, space, facts, quality=quality, bits=bits)
