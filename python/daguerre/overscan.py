"""Overscan: pixels beside the picture, for what later bends it, blurs it or moves it.

A picture with overscan keeps its size and its place, its display window; the file holds more, its
data window. See docs/plates.md.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .checks import MAX_RESOLUTION, number, short, whole
from .errors import UsageError, suggest

if TYPE_CHECKING:
    from .maps.sight import Sight

FloatArray = NDArray[np.float64]

#: Overscan that lets a later undistortion leave no holes.
UNDISTORT = "undistort"
WANTED = "pixels such as 64px, a share such as 10%, left,top,right,bottom (px), or undistort"
#: Pixels that the filters of ``daguerre post`` read around a point.
FILTER_MARGIN = 4
#: More than that many times the picture's side beside it is a mistake, or no picture any more.
MOST = 2.0


@dataclass(frozen=True)
class Overscan:
    """Pixels beside the picture, on each of its sides."""

    left: int = 0
    top: int = 0
    right: int = 0
    bottom: int = 0

    def __bool__(self) -> bool:
        return any(astuple(self))

    def region(self, resolution: tuple[int, int]) -> tuple[int, int, int, int]:
        """All pixels, (x0, y0, x1, y1) of the picture, end exclusive: the data window."""
        width, height = resolution
        return -self.left, -self.top, width + self.right, height + self.bottom

    def grown(self, resolution: tuple[int, int]) -> tuple[int, int]:
        """Size of the data window, px."""
        x0, y0, x1, y1 = self.region(resolution)
        return x1 - x0, y1 - y0

    def __str__(self) -> str:
        return ",".join(map(str, astuple(self)))


NONE = Overscan()


def check_overscan(
    value: Any, resolution: tuple[int, int], where: str = "overscan"
) -> Overscan | None:
    """Parses overscan: pixels for all sides, ``"10%"``, ``"64px"``, or one number for each side.

    Args:
        value: A number, a text, (left, top, right, bottom), an ``Overscan``, or None for none.
        resolution: Width and height of the picture, px.
        where: For messages.

    Returns:
        Overscan; None: ``"undistort"``, which the camera decides.

    Raises:
        UsageError: It is none of these; or the data window is too large.
    """
    if isinstance(value, str):
        if value.strip() == UNDISTORT:
            return None
        found = _of_text(value, resolution, where)
    elif value is None:
        found = NONE
    elif isinstance(value, Overscan):
        found = value
    else:
        sides = value if isinstance(value, tuple | list) else (value,) * 4
        if len(sides) != 4:
            raise UsageError(f"{where}: wanted {WANTED}; got {short(value)}")
        found = Overscan(*(whole(side, where, 0, MAX_RESOLUTION) for side in sides))
    _check_size(found, resolution, where)
    return found


def _of_text(text: str, resolution: tuple[int, int], where: str) -> Overscan:
    parts = [part.strip() for part in text.split(",")]
    if len(parts) not in (1, 4):
        raise UsageError(f"{where}: wanted {WANTED}; got {text!r}")
    width, height = resolution
    lengths = (width, height, width, height)
    if len(parts) == 1:
        parts *= 4
    return Overscan(*(_pixels(p, n, text, where) for p, n in zip(parts, lengths, strict=True)))


def _pixels(part: str, length: int, text: str, where: str) -> int:
    percent = part.endswith("%")
    digits = part.removesuffix("%") if percent else part.removesuffix("px")
    try:
        value = float(digits)
    except ValueError:
        raise UsageError(
            f"{where}: wanted {WANTED}; got {text!r}{suggest(part, [UNDISTORT])}"
        ) from None
    number(value, where, 0, 1e6)
    if percent:
        return math.ceil(value / 100 * length)
    return whole(int(value) if value == int(value) else value, where, 0, MAX_RESOLUTION)


def _check_size(found: Overscan, resolution: tuple[int, int], where: str) -> None:
    width, height = found.grown(resolution)
    if max(width, height) > MAX_RESOLUTION:
        raise UsageError(
            f"{where}: wanted a data window of at most {MAX_RESOLUTION} px a side, got "
            f"{width} x {height}"
        )


def to_undistort(sight: Sight, where: str = "overscan undistort") -> Overscan:
    """Finds the overscan with which undistorting leaves no holes in a picture of the same size.

    Raises:
        UsageError: It would need what the camera does not show, or a picture many times as large.
    """
    return _reach(sight, sight.bent_from_straight, where)


def note(overscan: Overscan) -> str:
    """Note on the overscan found for ``"undistort"``."""
    told = f"{overscan} px" if overscan else "none is needed"
    return f"overscan (left, top, right, bottom) to straighten the picture: {told}"


def to_redistort(sight: Sight) -> Overscan | None:
    """Finds the overscan with which an ideal picture redistorts without holes; None: no bounds."""

    def place(points: FloatArray) -> FloatArray:
        found = sight.straight_from_bent(points)
        dark = ~sight.sees(points)  # nothing is needed for what is dark
        found[dark] = np.array(sight.resolution) / 2
        return found

    try:
        return _reach(sight, place, "")
    except UsageError:
        return None


def _reach(sight: Sight, place: Any, where: str) -> Overscan:
    """How far the pixels of the display window, by a map, reach out of it."""
    width, height = sight.resolution
    # The map is smooth: its corners and edges reach farthest, but for folds within.
    x, y = (np.linspace(0, n, min(n, 256) + 1) for n in (width, height))
    at = np.stack(np.meshgrid(x, y), axis=-1)
    found = place(at.reshape(-1, 2)).reshape(at.shape)
    lost = ~np.isfinite(found).all(axis=2)
    if lost.any():
        row, column = np.argwhere(lost)[0]
        raise UsageError(
            f"{where}: impossible: the camera shows nothing of what the straight picture has at "
            f"({x[column]:.0f}, {y[row]:.0f}) px ({lost.mean():.2g} of the picture); wanted a "
            "number of pixels"
        )
    (left, top), (right, bottom) = found.min(axis=(0, 1)), found.max(axis=(0, 1))
    beside = (-left, -top, right - width, bottom - height)
    if max(beside) > MOST * max(width, height):
        raise UsageError(
            f"{where}: would take {max(beside):.0f} px beside a picture of {width} x {height}; "
            "wanted a number of pixels"
        )
    # Rounding is no distortion: a camera that bends nothing needs nothing.
    return Overscan(*(math.ceil(n) + FILTER_MARGIN if n > 0.01 else 0 for n in beside))
