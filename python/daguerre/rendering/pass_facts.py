"""Checks of the metadata of a pass file, before it is used.

A file may come from another machine, or be damaged. Each value must have the type that
:mod:`daguerre.pictures.exr.write` writes; otherwise the file is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from daguerre.camera.overscan import NONE, check_overscan
from daguerre.checks import MAX_RESOLUTION, MAX_SAMPLES
from daguerre.errors import UsageError
from daguerre.frame.cryptomatte import LAYERS, MAX_RANKS
from daguerre.pictures.exr import write as exr
from daguerre.pictures.exr.facts import are_texts, is_number


def _are_numbers(value: object, count: int) -> bool:
    return isinstance(value, list) and len(value) == count and all(map(is_number, value))


def _is_whole(value: object, low: int, high: int) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and low <= value <= high


def _is_pair(value: object) -> bool:
    return is_number(value) or _are_numbers(value, 2)


def _is_matrix(value: object) -> bool:
    return (
        isinstance(value, list) and len(value) == 4 and all(_are_numbers(row, 4) for row in value)
    )


def _is_size(value: Any) -> bool:
    return _are_numbers(value, 2) and all(_is_whole(v, 1, MAX_RESOLUTION) for v in value)


def _is_crop(value: Any) -> bool:
    if not (
        _are_numbers(value, 4) and all(_is_whole(v, -MAX_RESOLUTION, MAX_RESOLUTION) for v in value)
    ):
        return False
    x0, y0, x1, y1 = value
    return bool(x0 < x1 and y0 < y1)


def _are_mattes(value: object) -> bool:
    if not (isinstance(value, dict) and _is_whole(value.get("ranks"), 1, MAX_RANKS)):
        return False
    layers = value.get("layers")
    return (
        isinstance(layers, dict)
        and set(layers) <= set(LAYERS)
        and all(map(_is_layer, layers.values()))
    )


def _is_layer(value: object) -> bool:
    if not (isinstance(value, dict) and are_texts(value.get("names"))):
        return False
    of, most = value.get("of"), len(value["names"]) - 1
    return isinstance(of, list) and all(_is_whole(number, 0, most) for number in of)


_CHECKS: dict[str, Callable[[Any], bool]] = {
    **dict.fromkeys((*exr.FLOATS, *exr.OWN_NUMBERS), is_number),
    **dict.fromkeys((*exr.STRINGS, *exr.OWN_STRINGS), lambda value: isinstance(value, str)),
    **dict.fromkeys((*exr.VECTORS, *exr.RATIONALS), _is_pair),
    **dict.fromkeys(exr.MATRICES, _is_matrix),
    "camera": lambda value: isinstance(value, dict),
    "pupils": lambda value: isinstance(value, dict),
    "resolution": _is_size,
    "crop": _is_crop,
    "aovs": are_texts,
    "sensor_channels": are_texts,
    "mattes": _are_mattes,
    "white_balance": _is_pair,
}


def bad_fact(metadata: Mapping[str, Any]) -> str | None:
    """Name of a value with an impossible type or size; None if all are valid."""
    for name, check in _CHECKS.items():
        value = metadata.get(name)
        if value is not None and not check(value):
            return name
    size, crop = metadata.get("resolution"), metadata.get("crop")
    if not (size and crop):
        return None
    try:
        overscan = check_overscan(metadata.get("overscan"), (size[0], size[1]))
    except UsageError:
        return "overscan"
    left, top, right, bottom = (overscan or NONE).region((size[0], size[1]))
    if crop[0] < left or crop[1] < top or crop[2] > right or crop[3] > bottom:
        return "crop"
    return None


def are_ranges(value: object) -> bool:
    """Whether a value is a list of [begin, end) that rise and do not overlap."""
    if not isinstance(value, list) or not value:
        return False
    last = 0
    for pair in value:
        if not (_are_numbers(pair, 2) and all(_is_whole(v, 0, MAX_SAMPLES) for v in pair)):
            return False
        if not last <= pair[0] < pair[1]:
            return False
        last = pair[1]
    return True
