"""Square markers with ids, ArUco and AprilTag, as polygons."""

from __future__ import annotations

from functools import cache
from importlib import resources

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import whole
from daguerre.errors import UsageError, suggest

from .chart import FloatArray, Patch, Rgb, grey, rectangle

#: Dictionaries by OpenCV's names: table, bits along a side, number of markers.
DICTIONARIES: dict[str, tuple[str, int, int]] = {
    f"{size}X{size}_{count}": (f"{size}X{size}", size, count)
    for size in (4, 5, 6)
    for count in (50, 100, 250, 1000)
} | {"APRILTAG_36H11": ("36H11", 6, 587)}

BLACK_LAYER, WHITE_LAYER = 2, 3


def bits(dictionary: str, number: int) -> NDArray[np.bool_]:
    """Bits of a marker without its border, shape (S, S), from its upper left; true is white."""
    table, size, _ = DICTIONARIES[dictionary]
    digits = -(-size * size // 4)
    word = _tables()[table][number * digits : (number + 1) * digits]
    flat = [(int(word, 16) >> k) & 1 for k in reversed(range(size * size))]
    return np.array(flat, bool).reshape(size, size)


def checked(dictionary: str, first: int, count: int) -> tuple[str, int]:
    """Returns a dictionary's name as in ``DICTIONARIES``, and the first id, checked.

    Args:
        dictionary: Name with or without OpenCV's ``DICT_``, in any case.
        first: Id of the first marker.
        count: Number of markers on the board.

    Raises:
        UsageError: The dictionary is unknown, or has too few markers.
    """
    name = str(dictionary).upper().removeprefix("DICT_")
    if name not in DICTIONARIES:
        raise UsageError(
            f"chart: dictionary: wanted {', '.join(DICTIONARIES)}; got {dictionary!r}"
            f"{suggest(name, DICTIONARIES)}"
        )
    known = DICTIONARIES[name][2]
    if count > known:
        raise UsageError(
            f"chart: dictionary: wanted {count} markers for the board, got {name} with {known}"
        )
    return name, whole(first, "chart: first", 0, known - count)


def corners(center: FloatArray, side: float) -> FloatArray:
    """Corners in OpenCV's order: clockwise from the upper left; shape (4, 2)."""
    return rectangle(center, (side, side))[[3, 2, 1, 0]]


def patches(
    dictionary: str, number: int, center: FloatArray, side: float, border: int, white: Rgb
) -> list[Patch]:
    """Black square with white bits on it; adjacent bits of a row are one rectangle."""
    known = bits(dictionary, number)
    cell = side / (len(known) + 2 * border)
    out = [Patch(f"marker {number}", rectangle(center, (side, side)), grey(0.0), BLACK_LAYER)]
    for row, values in enumerate(known):
        edges = np.flatnonzero(np.diff(np.r_[False, values, False].astype(int)))
        for start, end in edges.reshape(-1, 2):
            middle = np.array([(start + end) / 2, row + 0.5]) - len(known) / 2
            place = center + cell * middle * [1, -1]
            box = rectangle(place, (cell * (end - start), cell))
            out.append(Patch(f"bits {number}", box, white, WHITE_LAYER))
    return out


@cache
def _tables() -> dict[str, str]:
    text = resources.files(__package__).joinpath("markers.txt").read_text("ascii")
    out: dict[str, str] = {}
    name = ""
    for line in text.splitlines():
        if line.startswith("["):
            name = line.strip("[]")
            out[name] = ""
        elif not line.startswith("#"):
            out[name] += line
    return out
