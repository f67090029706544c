"""Tint: the picture by exposure or by distance, beside the picture itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.frame.frame import Frame
from daguerre.rendering.session import Session

from .false_colour import REACH, false_colour, zone_colours
from .sight import depths_m, ring_offset_m

NONE, FALSE_COLOUR, DEPTH = TINTS = ("none", "false-colour", "depth")
#: Colours of surfaces before, within and behind the depth of field. They differ in all kinds of
#: colour blindness: orange and blue in hue, white in lightness.
NEAR, SHARP, FAR = (255, 150, 30), (255, 255, 255), (70, 130, 255)
#: Brightness of unsharp pixels; black pixels are lifted so far that they have a colour, too.
_DIM, _LIFT = 0.75, 0.2


@dataclass(frozen=True)
class Tint:
    """A tinted picture.

    Attributes:
        kind: ``false-colour`` or ``depth``.
        pixels: Its pixels, (H, W, 3); None: there is none.
        note: Why there is none.
    """

    kind: str
    pixels: NDArray[np.uint8] | None = None
    note: str = ""


def tint_of(
    kind: str,
    frame: Frame,
    session: Session,
    pixels: NDArray[np.uint8],
    limits: tuple[float | None, float | None],
) -> Tint | None:
    """Tints a picture.

    Args:
        kind: One of ``TINTS``.
        frame: The picture.
        session: Session that drew it.
        pixels: The picture as it is shown, (H, W, 3).
        limits: Near and far limit of the depth of field on the focus ring, m; None: infinity.
    """
    if kind == FALSE_COLOUR:
        return Tint(kind, false_colour(frame.without_overscan()))
    if kind != DEPTH:
        return None
    if session.prepared.setup.camera.tilt != (0.0, 0.0):
        return Tint(kind, note="The lens is tilted: its depth of field is a wedge, not shown here")
    far = Frame(frame.rgb, aovs={"depth": depths_m(session)}, metadata=frame.metadata)
    depth = far.without_overscan().aovs["depth"] + ring_offset_m(session)
    return Tint(kind, by_depth(pixels, depth, limits))


def joined(
    tints: Sequence[Tint | None], join: Callable[[list[NDArray[np.uint8]]], NDArray[np.uint8]]
) -> Tint | None:
    """Tint of pictures side by side; if a picture has none, the note on it."""
    found = [tint for tint in tints if tint is not None]
    pixels = [tint.pixels for tint in found if tint.pixels is not None]
    if not found or len(pixels) < len(found):
        return next((tint for tint in found if tint.pixels is None), None)
    return Tint(found[0].kind, join(pixels))


def by_depth(
    pixels: NDArray[np.uint8],
    depth: NDArray[np.float64],
    limits: tuple[float | None, float | None],
) -> NDArray[np.uint8]:
    """Tints pixels by depth, m; limits as for ``tint_of``, both None: everything is sharp."""
    near, far = (np.inf if m is None else m for m in limits)
    if limits == (None, None):
        near = 0.0
    luma = 255 * _LIFT + (1 - _LIFT) * (pixels @ np.array([0.2126, 0.7152, 0.0722]))
    part = np.where(depth < near, 0, np.where(depth > far, 2, 1))
    colours = np.array([NEAR, SHARP, FAR]) / 255 * np.array([[_DIM], [1.0], [_DIM]])
    return np.asarray(np.rint(luma[..., None] * colours[part]), np.uint8)


def legends() -> dict[str, Any]:
    """Facts for the page's legends: stops and their colours; colours of near, sharp, far."""
    zones = zip(range(-REACH, REACH + 1), zone_colours().tolist(), strict=True)
    return {FALSE_COLOUR: list(zones), DEPTH: [NEAR, SHARP, FAR]}
