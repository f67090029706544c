"""Pixels of a picture: size, crop and pixel filter."""

from __future__ import annotations

import math
import operator
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from daguerre.checks import MAX_RESOLUTION, short, whole
from daguerre.errors import UsageError, suggest
from daguerre.units import EDGES, edges_text

if TYPE_CHECKING:
    from daguerre.camera.camera import Camera

Box = tuple[int, int, int, int]
#: Left, top, right and bottom edge, px, right and bottom exclusive; None: the picture's edge.
Crop = tuple[int | None, int | None, int | None, int | None]
CropLike = Crop | Mapping[str, int]
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


def check_crop(value: Any, where: str = "crop") -> Crop:
    """Checks edges of a region, in their order or by name, but not whether they are in the picture.

    Returns:
        Left, top, right and bottom; None: not given.
    """
    if isinstance(value, Mapping):
        for name in value:
            if name not in EDGES:
                raise UsageError(
                    f"{where}: wanted some of {', '.join(EDGES)}, got {short(name)}"
                    f"{suggest(name, EDGES)}"
                )
        value = tuple(value.get(name) for name in EDGES)
    try:
        left, top, right, bottom = (None if v is None else operator.index(v) for v in value)
    except (TypeError, ValueError):
        raise UsageError(
            f"{where}: wanted whole numbers (left, top, right, bottom), got {short(value)}"
        ) from None
    return left, top, right, bottom


def at_size(camera: Camera, old: tuple[int, int], new: tuple[int, int]) -> Camera:
    """Returns a camera for a picture of another size, px, with its focus on the same point."""
    if camera.focus_at is None:
        return camera
    x, y = camera.focus_at
    return camera.with_(focus_at=(x * new[0] / old[0], y * new[1] / old[1]))


def crop_box(crop: CropLike | None, region: Box) -> Box:
    """Pixels of a crop, with the edges of a region in place of those that are not given."""
    given = (None,) * 4 if crop is None else check_crop(crop)
    left, top, right, bottom = (
        other if edge is None else edge for edge, other in zip(given, region, strict=True)
    )
    return left, top, right, bottom


def crop_within(crop: CropLike | None, region: Box, where: str = "crop") -> Box:
    """Pixels of a crop like :func:`crop_box`, checked to lie in a region.

    Raises:
        UsageError: The crop is empty, or not inside the region.
    """
    box = crop_box(crop, region)
    x0, y0, x1, y1 = region
    left, top, right, bottom = box
    if not (x0 <= left < right <= x1 and y0 <= top < bottom <= y1):
        raise UsageError(
            f"{where}: wanted left < right within {x0}..{x1} and top < bottom within {y0}..{y1}, "
            f"got {edges_text(box)}"
        )
    return box


def parse_filter(value: object, where: str = "filter") -> tuple[str, float]:
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


def check_filter(value: object, where: str = "filter") -> str:
    """Checks a filter and returns it as text."""
    parse_filter(value, where)
    return str(value)
