"""Pictures of frames for a screen, by the exposure mode of the frame."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import UsageError
from daguerre.exposure.lux_seconds import compensation, is_developed

if TYPE_CHECKING:
    from daguerre.frame.frame import Frame


def display(frame: Frame, tone: str) -> NDArray[np.uint8]:
    """Returns values of 8 bits; see :meth:`daguerre.Frame.display`."""
    if is_developed(frame.metadata):
        return np.rint(_developed(frame, tone) * 255).astype(np.uint8)
    shown = np.empty(frame.rgb.shape, np.uint8)
    for rows, values in _stripes(frame, tone):
        shown[rows] = np.rint(values * 255)
    return shown


def encoded(frame: Frame, tone: str) -> NDArray[np.float32]:
    """Returns values 0 to 1; see :meth:`daguerre.Frame.encoded`."""
    if is_developed(frame.metadata):
        return _developed(frame, tone)
    shown = np.empty(frame.rgb.shape, np.float32)
    for rows, values in _stripes(frame, tone):
        shown[rows] = values
    return shown


def _stripes(frame: Frame, tone: str) -> Iterator[tuple[slice, NDArray[np.float32]]]:
    return frame.encoded_rows(tone, compensation(frame.metadata))


def _developed(frame: Frame, tone: str) -> NDArray[np.float32]:
    from .recipe import develop

    if tone != "srgb":
        raise UsageError(
            f"frame: tone {tone}: this frame is developed (exposure "
            f"{frame.metadata['exposure']}), so its tone curve is the look of develop"
        )
    return np.asarray(develop(frame).pixels)
