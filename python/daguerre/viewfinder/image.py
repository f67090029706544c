"""Image: a drawn frame as the page shows it, and numbers about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.frame.frame import Frame
from daguerre.rendering.denoise import denoise

from .painter import Drawn
from .shot import Shot

#: JPEG quality of pictures on their way to the page.
QUALITY = 88
#: Pictures of so few pixels go as they are: a browser decodes others in a thread that may have to
#: wait for a core.
FEW = 20_000
_BINS = 128


@dataclass(frozen=True)
class Image:
    """A picture for the page.

    Attributes:
        kind: ``rgb`` or ``jpeg``.
        bytes: Its pixels, or its file.
        size: Width and height, px.
        histogram: Share of pixels in each of 128 equal steps of brightness, for red, green, blue.
    """

    kind: str
    bytes: bytes
    size: tuple[int, int]
    histogram: list[list[float]]


def image_of(drawn: Drawn, *, denoised: bool = False) -> Image:
    """Develops a picture, or those side by side, and encodes it."""
    import simplejpeg

    frame = denoise(drawn.frame) if denoised and drawn.whole else drawn.frame
    parts = [shown(panel.frame, panel.shot) for panel in drawn.panels]
    pixels = np.ascontiguousarray(np.hstack(parts)) if parts else shown(frame, drawn.shot)
    height, width = pixels.shape[:2]
    if width * height <= FEW:
        kind, data = "rgb", pixels.tobytes()
    else:
        kind, data = "jpeg", simplejpeg.encode_jpeg(pixels, quality=QUALITY, colorspace="RGB")
    return Image(kind, data, (width, height), _histogram(pixels))


def shown(frame: Frame, shot: Shot) -> NDArray[np.uint8]:
    """Pixels for display, (H, W, 3), as in a file of the command line."""
    return shot.photograph.shown(frame, shot.tone)


def _histogram(pixels: NDArray[np.uint8]) -> list[list[float]]:
    counts = [np.bincount(pixels[:, :, c].ravel() >> 1, minlength=_BINS) for c in range(3)]
    return [(n / pixels[:, :, 0].size).round(5).tolist() for n in counts]


def value_at(frame: Frame, x: int, y: int) -> dict[str, Any] | None:
    """Linear values of a pixel of the frame; None: outside."""
    if not (0 <= x < frame.width and 0 <= y < frame.height):
        return None
    return {"x": x, "y": y, "rgb": [float(v) for v in frame.rgb[y, x]]}
