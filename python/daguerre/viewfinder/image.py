"""Image: a drawn frame as the page shows it, and numbers about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.frame.frame import Frame

from .drawn import Drawn, Panel
from .readings import limits_of
from .shot import Shot
from .tint import DEPTH, NONE, Tint, joined, tint_of

#: JPEG quality of pictures on their way to the page.
QUALITY = 88
#: Quality of tinted pictures, in which people read colours.
TINT_QUALITY = 95
#: Pictures of at most so many pixels are sent uncompressed: a browser decodes a JPEG in a thread
#: that may have to wait for a core.
FEW = 40_000
_BINS = 128
#: Pixels across a block of JPEG.
_BLOCK = 8


@dataclass(frozen=True)
class Image:
    """A picture for the page.

    Attributes:
        kind: ``rgb`` or ``jpeg``.
        bytes: Pixels, or a JPEG file.
        size: Width and height, px.
        histogram: Share of pixels in each of 128 equal steps of brightness, for red, green, blue.
        tint: Kind and note of a tint, with its bytes after the picture's bytes; None: no tint.
        part: Width of each of several pictures side by side, px; each begins with a block of JPEG.
            The histogram shows the picture at the dials.
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
) -> Image:
    """Develops a picture, or those side by side, and encodes it.

    Args:
        drawn: The picture.
        clean: Its denoised frame, to show instead; the histogram stays as drawn.
        tint: How to tint it, too; see ``tint_of``.
    """
    alone = Panel("", drawn.shot, drawn.session, clean or drawn.frame, drawn.sharp)
    panels = drawn.panels or (alone,)
    frames = _frames(panels, tint)
    parts = [shown(frame, one.shot) for frame, one in zip(frames, panels, strict=True)]
    pixels = side_by_side(parts)
    height, width = pixels.shape[:2]
    kind, data = encoded(pixels, QUALITY)
    tints = [_tinted(tint, panel, part) for panel, part in zip(panels, parts, strict=True)]
    head, more = _told(joined(tints, side_by_side))
    own = parts[drawn.main] if clean is None else shown(drawn.frame, drawn.shot)
    return Image(kind, data + more, (width, height), _histogram(own), head, parts[0].shape[1])


def _frames(panels: Sequence[Panel], tint: str) -> list[Frame]:
    """Frames to show, of one size; a tint needs the pixels of the session."""
    sharp = [panel.sharp for panel in panels if panel.sharp is not None]
    if tint == NONE and len(sharp) == len(panels):
        return sharp
    return [panel.frame for panel in panels]


def _tinted(kind: str, panel: Panel, pixels: NDArray[np.uint8]) -> Tint | None:
    """Tint of one picture, by its own limits of the depth of field."""
    limits = limits_of(panel.session) if kind == DEPTH else (None, None)
    return tint_of(kind, panel.frame, panel.session, pixels, limits)


def side_by_side(parts: list[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Pictures in a row, each widened to whole blocks of JPEG: none bleeds into the next."""
    if len(parts) == 1:
        return parts[0]
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
