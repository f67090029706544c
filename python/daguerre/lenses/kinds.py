"""Kinds of lenses, as photographers speak of them, from the numbers of the library's index."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from daguerre.units import SENSORS

from .index import Entry
from .words import words_of

#: Angles of view over the diagonal, degrees: 37 mm, 59 mm and 69 mm on 36 x 24 mm.
_WIDE, _NORMAL, _TELE = 60.0, 40.0, 35.0
#: The same for 21 mm, and for 280 mm.
_ULTRA_WIDE, _SUPER_TELE = 90.0, 9.0
#: The same for 140 mm to 81 mm.
_PORTRAIT = (17.5, 30.0)
#: Least diameter of an entrance pupil, mm, as of 50 mm f/1.5. It sets the blur of a far background
#: for a subject of a given size, whatever the format.
_BLUR_MM = 33.0


@dataclass(frozen=True)
class Kind:
    """A kind of lens.

    Attributes:
        words: Words for it; the first is its name.
        holds: Whether a lens is of this kind.
    """

    words: tuple[str, ...]
    holds: Callable[[Entry], bool]


def kinds_of(entry: Entry) -> list[Kind]:
    """Kinds of a lens."""
    return [kind for kind in KINDS if kind.holds(entry)]


def diagonal_mm(entry: Entry) -> float | None:
    """Diagonal of a lens's format; None: its format is unknown."""
    sides = [float(side) for side in entry.format.split("x") if side]
    return math.hypot(*sides) if sides else None


def _angles(entry: Entry) -> tuple[float, float] | None:
    """Narrowest and widest angle over the diagonal, degrees; None: there is no such angle."""
    diagonal = diagonal_mm(entry)
    if diagonal is None or _is("anamorphic")(entry):
        return None
    ends = (entry.efl_long_mm or entry.efl_mm, entry.efl_mm)
    narrow, wide = (2 * math.degrees(math.atan(diagonal / 2 / focal)) for focal in ends)
    return narrow, wide


def _is(word: str) -> Callable[[Entry], bool]:
    """A test of the index's own words for a lens."""
    return lambda entry: any(word == own.text for own in words_of(f"{entry.type} {entry.title}"))


def _seen(name: str, holds: Callable[[float, float], bool]) -> Callable[[Entry], bool]:
    """A test of the angles; where the format is unknown, of the index's words."""

    def test(entry: Entry) -> bool:
        angles = _angles(entry)
        return _is(name)(entry) if angles is None else holds(*angles)

    return test


def _is_zoom(entry: Entry) -> bool:
    return entry.efl_long_mm is not None


def _is_portrait(entry: Entry) -> bool:
    angles = _angles(entry)
    if angles is None or _is_zoom(entry) or entry.f_number > 2.9:
        return _is("portrait")(entry)
    return _PORTRAIT[0] <= angles[0] <= _PORTRAIT[1]


def _blurs(entry: Entry) -> bool:
    return (entry.efl_long_mm or entry.efl_mm) / entry.f_number >= _BLUR_MM


def _has_format(*names: str) -> Callable[[Entry], bool]:
    def test(entry: Entry) -> bool:
        diagonal = diagonal_mm(entry)
        sizes = [math.hypot(*SENSORS[name]) for name in names]
        return diagonal is not None and any(abs(diagonal / size - 1) < 0.05 for size in sizes)

    return test


def _diagonal_within(low: float, high: float) -> Callable[[Entry], bool]:
    return lambda entry: low <= (diagonal_mm(entry) or 0.0) < high


#: Kinds by their angle of view.
BY_ANGLE = [
    Kind(("wide", "wideangle", "angle"), _seen("wide", lambda _, wide: wide >= _WIDE)),
    Kind(("ultrawide", "ultra"), _seen("ultra", lambda _, wide: wide >= _ULTRA_WIDE)),
    Kind(
        ("normal", "standard"),
        _seen("normal", lambda narrow, wide: narrow <= _WIDE and wide >= _NORMAL),
    ),
    Kind(
        ("tele", "telephoto", "telelens"),
        _seen("telephoto", lambda narrow, _: narrow <= _TELE),
    ),
    Kind(("supertele", "super"), _seen("supertele", lambda narrow, _: narrow <= _SUPER_TELE)),
]
#: All kinds.
KINDS = [
    Kind(("zoom",), _is_zoom),
    Kind(("prime", "fixed"), lambda entry: not _is_zoom(entry)),
    *BY_ANGLE,
    Kind(("fisheye", "fish", "eye"), _is("fisheye")),
    Kind(("macro", "micro", "closeup"), _is("macro")),
    Kind(("anamorphic", "anamorphot", "scope"), _is("anamorphic")),
    Kind(("soft", "softfocus"), _is("soft")),
    Kind(("portrait",), _is_portrait),
    Kind(("fast", "lowlight"), lambda entry: entry.f_number < 1.6 or _is("fast")(entry)),
    Kind(("bokeh", "blur"), _blurs),
    Kind(("cine", "cinema", "movie"), _is("cine")),
    Kind(("fullframe", "full", "frame", "ff"), _has_format("ff")),
    Kind(("apsc", "aps", "c"), _has_format("apsc", "apsc-canon")),
    Kind(("mft", "micro", "four", "thirds"), _has_format("mft")),
    Kind(("s35",), _has_format("s35")),
    Kind(("medium", "format"), _diagonal_within(50, 120)),
    Kind(("large", "format"), _diagonal_within(120, math.inf)),
]
