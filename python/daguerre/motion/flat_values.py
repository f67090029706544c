"""Flattens values to numbers and a rest, to measure how far two values differ."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
# A larger array is a picture, not a parameter, and does not change.
_MAX_ARRAY = 64
_ROUNDING = 1e-4


@dataclass
class Flat:
    """Flattened value.

    Attributes:
        value: The value itself.
        numbers: All its finite numbers.
        groups: Groups of numbers with a common scale, such as the three of a colour.
        rest: Names, flags and infinities, which cannot be interpolated.
    """

    value: Any
    numbers: FloatArray
    groups: list[int] = field(default_factory=list)
    rest: list[Any] = field(default_factory=list)


def flat(value: object) -> Flat:
    """Flattens a number, tuple, array or dataclass."""
    numbers: list[float] = []
    taken = Flat(value, np.zeros(0))
    _take(value, numbers, taken)
    taken.numbers = np.array(numbers)
    return taken


def _take(value: object, numbers: list[float], into: Flat) -> None:
    if isinstance(value, np.ndarray) and value.size <= _MAX_ARRAY and value.dtype.kind in "iuf":
        if value.shape == (4, 4):  # rotation and position have separate scales
            _add(value[:3, :3].ravel().tolist(), numbers, into)
            _add(value[:3, 3].tolist(), numbers, into)
        else:
            _add(value.ravel().tolist(), numbers, into)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        _add([value], numbers, into)
    elif isinstance(value, tuple | list):
        if all(isinstance(v, int | float) and not isinstance(v, bool) for v in value):
            _add(list(value), numbers, into)
        else:
            for item in value:
                _take(item, numbers, into)
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        for part in vars(value).values():
            _take(part, numbers, into)
    else:
        into.rest.append(id(value) if isinstance(value, np.ndarray) else value)


def _add(values: list[float], numbers: list[float], into: Flat) -> None:
    group = into.groups[-1] + 1 if into.groups else 0
    for value in values:
        if math.isfinite(value):
            numbers.append(value)
            into.groups.append(group)
        else:
            into.rest.append(value)


def changes(values: list[Flat]) -> FloatArray:
    """Largest change within the group of each number over all values, one row.

    It is at least ``_ROUNDING`` of the group's largest number, so that rounding is not motion.
    """
    rows = np.array([v.numbers for v in values if len(v.numbers) == len(values[0].numbers)])
    if not rows.size:
        return np.zeros(len(values[0].numbers))
    groups = values[0].groups
    most = np.zeros(groups[-1] + 1)
    np.maximum.at(most, groups, np.ptp(rows, axis=0))
    np.maximum.at(most, groups, _ROUNDING * np.abs(rows).max(axis=0))
    return most[groups]
