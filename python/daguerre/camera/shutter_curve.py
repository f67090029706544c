"""Measured shutters: a table of time and opening, as text."""

from __future__ import annotations

import math
import re
from pathlib import Path

from daguerre.errors import InputError
from daguerre.files.text_lines import text_of

#: Points of a curve.
MAX_POINTS = 4096

_MAX_BYTES = 1 << 20


def read_curve(path: Path) -> list[tuple[float, float]]:
    """Reads points (fraction of the time, opening) from a file with two columns.

    Commas, semicolons or blanks separate the columns. Lines with # are comments, and the first line
    may hold names. Times are in any unit: the exposure begins at the first and ends at the last.
    Openings are in any unit: the largest is fully open.

    Raises:
        InputError: The file cannot be read, or is not such a table; the message names the line.
    """
    try:
        lines = text_of(path, "utf-8-sig", _MAX_BYTES).splitlines()
    except InputError as error:
        raise InputError(f"--shutter-curve: {error} (wanted box, trapezoid:E or a file)") from None
    points: list[tuple[float, float]] = []
    named = False
    for i, line in enumerate(lines, 1):
        words = [word for word in re.split(r"[,;\s]+", line.partition("#")[0].strip()) if word]
        if not words:
            continue
        numbers = _numbers(words)
        if numbers is None:
            if points or named:
                raise InputError(f"{path}: line {i}: wanted time and opening, got {line[:60]!r}")
            named = True
            continue
        if points and numbers[0] < points[-1][0]:
            raise InputError(
                f"{path}: line {i}: times must not decrease, got {numbers[0]:g} "
                f"after {points[-1][0]:g}"
            )
        points.append(numbers)
        if len(points) > MAX_POINTS:
            raise InputError(f"{path}: wanted at most {MAX_POINTS} points")
    return _over_the_exposure(path, points)


def _over_the_exposure(path: Path, points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    if len(points) < 2 or not points[-1][0] > points[0][0]:
        raise InputError(f"{path}: wanted at least two points at different times")
    begin, end = points[0][0], points[-1][0]
    return [(min(1.0, (t - begin) / (end - begin)), opening) for t, opening in points]


def _numbers(words: list[str]) -> tuple[float, float] | None:
    if len(words) != 2:
        return None
    try:
        time, opening = float(words[0]), float(words[1])
    except ValueError:
        return None
    return (time, opening) if math.isfinite(time) and math.isfinite(opening) else None
