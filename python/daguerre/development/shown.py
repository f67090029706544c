"""Pictures of frames for a screen, by the exposure mode of the frame."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError
from daguerre.exposure.lux_seconds import compensation, is_developed
from daguerre.frame.picture import Picture

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame


@dataclass(frozen=True)
class OnScreen:
    """A frame for a screen: developed by its exposure mode, or by a tone curve."""

    frame: Frame
    tone: str

    def bytes8(self) -> NDArray[np.uint8]:
        """Returns values of 8 bits; see :meth:`daguerre.Frame.display`."""
        if is_developed(self.frame.metadata):
            return self.developed().bytes8()
        shown = np.empty(self.frame.rgb.shape, np.uint8)
        for rows, values in self._stripes():
            shown[rows] = np.rint(values * 255)
        return shown

    def values(self) -> NDArray[np.float32]:
        """Returns values 0 to 1; see :meth:`daguerre.Frame.encoded`."""
        if is_developed(self.frame.metadata):
            return self.developed().pixels
        shown = np.empty(self.frame.rgb.shape, np.float32)
        for rows, values in self._stripes():
            shown[rows] = values
        return shown

    def developed(self) -> Picture:
        """Develops the frame, with its overscan."""
        from .channels import of_frame
        from .recipe import develop

        if self.tone != "srgb":
            raise UsageError(
                f"frame: tone {self.tone}: this frame is developed (exposure "
                f"{self.frame.metadata['exposure']}), so its tone curve is the look of develop"
            )
        return develop(of_frame(self.frame))

    def _stripes(self) -> Iterator[tuple[slice, NDArray[np.float32]]]:
        return self.frame.encoded_rows(self.tone, compensation(self.frame.metadata))


def as_png(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes a PNG with EXIF, without overscan."""
    from daguerre.pictures.png import write_png

    frame = frame.without_overscan()
    shown = OnScreen(frame, tone)
    if is_developed(frame.metadata):
        shown.developed().save(path)
    else:
        write_png(path, shown.bytes8(), frame.metadata)


def as_picture(path: str | os.PathLike[str], frame: Frame, tone: str = "srgb") -> None:
    """Writes a picture with EXIF and an ICC profile, without overscan."""
    frame = frame.without_overscan()
    shown = OnScreen(frame, tone)
    if is_developed(frame.metadata):
        shown.developed().save(path)
    else:
        Picture(shown.values(), "srgb", frame.metadata).save(path)
