"""Overscan: extra pixels around the picture, for later distortion, blur or camera shake.

The picture itself (display window) keeps its size and place; the file holds more (data window). See
docs/plates.md.
"""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import MAX_RESOLUTION, number, short, whole
from daguerre.errors import UsageError, suggest

FloatArray = NDArray[np.float64]

#: Overscan that lets a later undistortion leave no holes.
UNDISTORT = "undistort"
WANTED = "pixels such as 64px, a share such as 10%, left,top,right,bottom (px), or undistort"


@dataclass(frozen=True)
class Overscan:
    """Number of extra pixels on each side of the picture."""

    left: int = 0
    top: int = 0
    right: int = 0
    bottom: int = 0

    def __bool__(self) -> bool:
        return any(astuple(self))

    def region(self, resolution: tuple[int, int]) -> tuple[int, int, int, int]:
        """Data window in pixels of the picture, (x0, y0, x1, y1), end exclusive."""
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
    value: object, resolution: tuple[int, int], where: str = "overscan"
) -> Overscan | None:
    """Parses overscan: pixels for all sides, ``"10%"``, ``"64px"``, or one number for each side.

    Args:
        value: A number, a text, (left, top, right, bottom), an ``Overscan``, or None for none.
        resolution: Width and height of the picture, px.
        where: For messages.

    Returns:
        Overscan; None for ``"undistort"``, which depends on the camera.

    Raises:
        UsageError: Another value, or a data window that is too large.
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
        raise UsageError(f"{where}: wanted {WANTED}; got {short(text)}")
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
            f"{where}: wanted {WANTED}; got {short(text)}{suggest(part, [UNDISTORT])}"
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
