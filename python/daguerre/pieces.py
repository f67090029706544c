"""A value over an interval, cut at its breaks and halved until what lies between keys fits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar

from .motion import Dynamic

T = TypeVar("T")
#: Whether ``value`` is near enough to what lies at ``s`` (0 .. 1) between ``a`` and ``b``.
Fits = Callable[[T, T, float, T], bool]

#: Keys of one value, and how often a piece between two breaks is halved at most.
MAX_KEYS = 4096
MAX_BREAKS = MAX_KEYS // 4
_MAX_HALVINGS = 10
_MAX_SAMPLES = 64
QUARTERS = (0.25, 0.5, 0.75)
#: Where to look first: uneven, so that what repeats does not look as if it stood still.
FIRST = (0.137, 0.25, 0.418, 0.5, 0.75, 0.873)


def samples(dynamic: Dynamic, open_s: float, close_s: float) -> list[tuple[float, Any]]:
    """Some times of an interval, ends and breaks among them, and the values there."""
    between = (open_s + s * (close_s - open_s) for s in FIRST)
    some = some_breaks(dynamic, open_s, close_s, _MAX_SAMPLES)
    return [(t, dynamic.at(t)) for t in sorted({open_s, close_s, *some, *between})]


def some_breaks(dynamic: Dynamic, open_s: float, close_s: float, most: int) -> list[float]:
    """The breaks inside of an interval; of more than ``most`` every second, third, ..."""
    breaks = dynamic.breaks(open_s, close_s)
    return [float(t) for t in breaks[:: max(1, math.ceil(len(breaks) / most))]]


class Pieces(Generic[T]):
    """Looks at a value at as few times as it takes.

    Args:
        value: At a time, s.
        dynamic: Has the breaks.
        open_s: Begin of the interval, s.
        close_s: Its end.
    """

    def __init__(
        self, value: Callable[[float], T], dynamic: Dynamic, open_s: float, close_s: float
    ) -> None:
        self._cuts = [open_s, *some_breaks(dynamic, open_s, close_s, MAX_BREAKS)]
        if close_s > open_s:
            self._cuts.append(close_s)
        self._value = value
        self._known: dict[float, T] = {}

    def first(self) -> list[T]:
        """Enough values to see whether something changes, and how much."""
        times = list(self._cuts)
        for begin, end in self._spans():
            times += [self._before(end), *(begin + s * (end - begin) for s in FIRST)]
        return [self._at(t) for t in times]

    def keys(self, fits: Fits[T]) -> list[tuple[float, T]]:
        """Times that do not fall, two equal ones where the value jumps, and the values there."""
        keys = [(self._cuts[0], self._at(self._cuts[0]))]
        halvings = min(_MAX_HALVINGS, int(math.log2(MAX_KEYS / len(self._cuts))))
        for begin, end in self._spans():
            before, start = keys[-1][1], self._at(begin)
            if not fits(before, before, 0.0, start):
                keys.append((begin, start))
            stop = end, self._at(self._before(end))
            self._halve((begin, start), stop, fits, FIRST, halvings, keys)
        return keys

    def _spans(self) -> list[tuple[float, float]]:
        return list(zip(self._cuts, self._cuts[1:], strict=False))

    def _before(self, time: float) -> float:
        """The last moment before a break, where the value may jump; the end is none."""
        return time if time == self._cuts[-1] else math.nextafter(time, -math.inf)

    def _at(self, time: float) -> T:
        if time not in self._known:
            self._known[time] = self._value(time)
        return self._known[time]

    def _halve(
        self,
        a: tuple[float, T],
        b: tuple[float, T],
        fits: Fits[T],
        checks: Sequence[float],
        left: int,
        keys: list[tuple[float, T]],
    ) -> None:
        width = b[0] - a[0]
        if left == 0 or all(fits(a[1], b[1], s, self._at(a[0] + s * width)) for s in checks):
            keys.append(b)
            return
        middle = a[0] + 0.5 * width
        half = middle, self._at(middle)
        self._halve(a, half, fits, QUARTERS, left - 1, keys)
        self._halve(half, b, fits, QUARTERS, left - 1, keys)
