"""Pixels of a picture: size, crop and pixel filter."""

from __future__ import annotations

import math
import operator
from typing import Any

from daguerre.checks import MAX_RESOLUTION, short, whole
from daguerre.errors import UsageError, suggest

Box = tuple[int, int, int, int]
FILTERS = ("box", "gaussian", "blackman_harris", "mitchell", "tent")
LEAST_RADIUS, MOST_RADIUS = 0.25, 16.0  # px


def check_resolution(value: Any, where: str = "resolution") -> tuple[int, int]:
    """Checks width and height, px."""
    try:
        width, height = value
    except (TypeError, ValueError):
        raise UsageError(f"{where}: wanted (width, height) in px, got {short(value)}") from None
    bounds = f"1 .. {MAX_RESOLUTION} px a side"
    sides = [whole(v, where, 1, MAX_RESOLUTION, bounds) for v in (width, height)]
    return sides[0], sides[1]


def check_crop(value: Any, where: str = "crop") -> Box:
    """Checks corners (x0, y0, x1, y1) of a region, but not whether they are in the picture."""
    try:
        x0, y0, x1, y1 = (operator.index(v) for v in value)
    except (TypeError, ValueError):
        raise UsageError(
            f"{where}: wanted whole numbers (x0, y0, x1, y1), got {short(value)}"
        ) from None
    return x0, y0, x1, y1


def crop_within(crop: Box | None, region: Box) -> Box:
    """Checks that a crop lies in the region of picture and overscan; None: all of it.

    Raises:
        UsageError: It lies outside, or is empty.
    """
    if crop is None:
        return region
    left, top, right, bottom = region
    x0, y0, x1, y1 = crop
    if not (left <= x0 < x1 <= right and top <= y0 < y1 <= bottom):
        within = f"{right}x{bottom}" if left == top == 0 else f"({left}, {top}, {right}, {bottom})"
        raise UsageError(
            f"crop: wanted (x0, y0, x1, y1) with x0 < x1 and y0 < y1 within {within}, "
            f"got ({x0}, {y0}, {x1}, {y1})"
        )
    return crop


def parse_filter(value: Any, where: str = "filter") -> tuple[str, float]:
    """Parses a filter such as ``gaussian`` or ``gaussian:1.5``: name, radius (px; 0: default)."""
    kind, _, radius = str(value).replace("-", "_").partition(":")
    if kind not in FILTERS:
        raise UsageError(
            f"{where}: wanted {', '.join(FILTERS)}, got {short(kind)}{suggest(kind, FILTERS)}"
        )
    try:
        number = float(radius) if radius else 0.0
    except ValueError:
        number = math.nan
    if radius and not LEAST_RADIUS <= number <= MOST_RADIUS:
        raise UsageError(
            f"{where}: radius: wanted {LEAST_RADIUS:g} .. {MOST_RADIUS:g} px, got {short(radius)}"
        )
    return kind, number


def check_filter(value: Any, where: str = "filter") -> str:
    """Checks a filter and returns it as text."""
    parse_filter(value, where)
    return str(value)
