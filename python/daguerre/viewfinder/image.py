"""Image: a drawn frame as the page shows it, and numbers about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.frame.frame import Frame

from .drawn import Drawn
from .shot import Shot
from .tint import NONE, Tint, tint_of

#: JPEG quality of pictures on their way to the page.
QUALITY = 88
#: That of tinted ones, whose colours are read.
TINT_QUALITY = 95
#: Pictures of so few pixels go as they are: a browser decodes others in a thread that may have to
#: wait for a core.
FEW = 40_000
_BINS = 128
#: Pixels across a block of JPEG.
_BLOCK = 8


@dataclass(frozen=True)
class Image:
    """A picture for the page.

    Attributes:
        kind: ``rgb`` or ``jpeg``.
        bytes: Its pixels, or its file.
        size: Width and height, px.
        histogram: Share of pixels in each of 128 equal steps of brightness, for red, green, blue.
        tint: Kind and note of a tint; ``bytes`` of it follow those of the picture; None: none.
        part: Width of one of several pictures side by side, px; each begins with a block of JPEG.
    """

    kind: str
    bytes: bytes
    size: tuple[int, int]
    histogram: list[list[float]]
    tint: dict[str, Any] | None
    part: int


def image_of(
    drawn: Drawn,
    *,
    clean: Frame | None = None,
    tint: str = NONE,
    limits: tuple[float | None, float | None] = (None, None),
) -> Image:
    """Develops a picture, or those side by side, and encodes it.

    Args:
        drawn: The picture.
        clean: Its denoised frame, to show instead; the histogram stays as drawn.
        tint: How to tint it, too; see ``tint_of``, also for ``limits``.
        limits: Limits of the depth of field.
    """
    frame = drawn.frame if clean is None else clean
    parts = [shown(panel.frame, panel.shot) for panel in drawn.panels]
    pixels = side_by_side(parts) if parts else shown(frame, drawn.shot)
    height, width = pixels.shape[:2]
    kind, data = encoded(pixels, QUALITY)
    if parts and tint != NONE:
        tinted: Tint | None = Tint(tint, note="Pictures side by side are not tinted")
    else:
        tinted = tint_of(tint, frame, drawn.session, pixels, limits)
    head, more = _told(tinted)
    noisy = pixels if clean is None else shown(drawn.frame, drawn.shot)
    part = parts[0].shape[1] if parts else width
    return Image(kind, data + more, (width, height), _histogram(noisy), head, part)


def side_by_side(parts: list[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Pictures in a row, each widened to whole blocks of JPEG: none bleeds into the next."""
    more = -parts[0].shape[1] % _BLOCK
    padded = [np.pad(part, ((0, 0), (0, more), (0, 0)), mode="edge") for part in parts]
    return np.ascontiguousarray(np.hstack(padded))


def _told(tint: Tint | None) -> tuple[dict[str, Any] | None, bytes]:
    """Head and bytes of a tint."""
    if tint is None:
        return None, b""
    data = b"" if tint.pixels is None else encoded(tint.pixels, TINT_QUALITY)[1]
    return {"kind": tint.kind, "note": tint.note, "bytes": len(data)}, data


def encoded(pixels: NDArray[np.uint8], quality: int) -> tuple[str, bytes]:
    """Kind and bytes of pixels on their way to the page."""
    import simplejpeg

    if pixels.shape[0] * pixels.shape[1] <= FEW:
        return "rgb", pixels.tobytes()
    return "jpeg", simplejpeg.encode_jpeg(pixels, quality=quality, colorspace="RGB")


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
