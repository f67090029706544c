"""Pictures of frames for a screen, by the exposure mode of the frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError
from daguerre.exposure.lux_seconds import compensation, is_developed
from daguerre.frame.picture import Picture

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame


def display(frame: Frame, tone: str) -> NDArray[np.uint8]:
    """Returns values of 8 bits; see :meth:`daguerre.Frame.display`."""
    if is_developed(frame.metadata):
        return _developed(frame, tone).bytes8()
    shown = np.empty(frame.rgb.shape, np.uint8)
    for rows, values in _stripes(frame, tone):
        shown[rows] = np.rint(values * 255)
    return shown


def encoded(frame: Frame, tone: str) -> NDArray[np.float32]:
    """Returns values 0 to 1; see :meth:`daguerre.Frame.encoded`."""
    if is_developed(frame.metadata):
        return _developed(frame, tone).pixels
    shown = np.empty(frame.rgb.shape, np.float32)
    for rows, values in _stripes(frame, tone):
        shown[rows] = values
    return shown


def as_png(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes a PNG with EXIF, without overscan."""
    from daguerre.pictures.png import write_png

    frame = frame.without_overscan()
    if is_developed(frame.metadata):
        _developed(frame, tone).save(path)
    else:
        write_png(path, display(frame, tone), frame.metadata)


def as_picture(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes a picture with EXIF and an ICC profile, without overscan."""
    frame = frame.without_overscan()
    if is_developed(frame.metadata):
        _developed(frame, tone).save(path)
    else:
        Picture(encoded(frame, tone), "srgb", frame.metadata).save(path)


def png_bytes(frame: Frame) -> bytes:
    """Returns the file of :func:`as_png` as bytes, for notebooks."""
    from tempfile import TemporaryDirectory

    with TemporaryDirectory() as folder:
        path = Path(folder) / "frame.png"
        as_png(path, frame)
        return path.read_bytes()


def _stripes(frame: Frame, tone: str) -> Iterator[tuple[slice, NDArray[np.float32]]]:
    return frame.encoded_rows(tone, compensation(frame.metadata))


def _developed(frame: Frame, tone: str) -> Picture:
    """The developed frame, with its overscan."""
    from .channels import of_frame
    from .recipe import develop

    if tone != "srgb":
        raise UsageError(
            f"frame: tone {tone}: this frame is developed (exposure "
            f"{frame.metadata['exposure']}), so its tone curve is the look of develop"
        )
    return develop(of_frame(frame))
