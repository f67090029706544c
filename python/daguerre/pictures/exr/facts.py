"""Converts attributes of a file to metadata, and checks their types.

Other programs may write ``expTime`` as a text, or wrong places of bad samples. Attributes of other
types than the standard or Daguerre give them are left out.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import numpy as np

from daguerre.color.illuminants import white_xy
from daguerre.errors import UsageError

from . import write as exr


def read_facts(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Returns metadata with the names of ``Frame.metadata``, from standard and own attributes."""
    standard: tuple[tuple[tuple[str, ...], Callable[[Any], bool]], ...] = (
        (exr.FLOATS, is_number),
        (exr.STRINGS, _is_text),
        (exr.VECTORS, _are_two),
        (exr.RATIONALS, _is_fraction),
    )
    found: dict[str, Any] = {
        name: attributes[name]
        for names, fits in standard
        for name in names
        if fits(attributes.get(name))
    }
    for name in exr.MATRICES:
        if _are_sixteen(attributes.get(name)):
            found[name] = np.array(attributes[name], np.float64).reshape(4, 4)
    own = {
        name.removeprefix("daguerre:"): value
        for name, value in attributes.items()
        if name.startswith("daguerre:")
    }
    typed = ((name, _own(name, value)) for name, value in own.items())
    return found | {name: value for name, value in typed if value is not None}


def _own(name: str, value: object) -> Any:
    """Decodes an own attribute: JSON, or a long integer stored as text; None: wrong type."""
    if name in exr.OWN_NUMBERS:
        number = _whole(value) if isinstance(value, str) else value
        return number if is_number(number) else None
    if name in exr.OWN_STRINGS:
        return value if isinstance(value, str) else None
    if name not in _JSON:
        return value
    try:
        parsed = json.loads(value) if isinstance(value, str) else None
    except (ValueError, RecursionError):
        return None
    return parsed if _JSON[name](parsed) else None


def _whole(text: str) -> int | None:
    try:
        return int(text) if len(text) < 40 else None
    except ValueError:
        return None


def is_number(value: object) -> bool:
    """Whether a value is a number, and not True or False."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_fraction(value: object) -> bool:
    return isinstance(value, Fraction)


def _are_two(value: object) -> bool:
    return isinstance(value, tuple) and len(value) == 2


def _are_sixteen(value: object) -> bool:
    return isinstance(value, tuple) and len(value) == 16


def _are_places(value: object) -> bool:
    """Whether a value is a list of [column, row, sample]."""
    return isinstance(value, list) and all(
        isinstance(place, list) and len(place) == 3 and all(map(is_number, place))
        for place in value
    )


def are_texts(value: object) -> bool:
    """Whether a value is a list of texts."""
    return isinstance(value, list) and all(map(_is_text, value))


def _is_balance(value: object) -> bool:
    """Whether a value is a white: K, or x, y."""
    try:
        white_xy(value)
    except UsageError:
        return False
    return value is not None


def _is_place(value: object) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(map(is_number, value))


def _is_object(value: object) -> bool:
    return isinstance(value, dict)


def _is_there(value: object) -> bool:
    return value is not None


_JSON: dict[str, Callable[[Any], bool]] = {
    **dict.fromkeys((*exr.OWN_JSON, "camera"), _is_there),
    "bad_sample_places": _are_places,
    "sensor_channels": are_texts,
    "world_origin": _is_place,
    "white_balance": _is_balance,
    "camera": _is_object,
}
