"""Samples a value over an interval: cuts at breaks, halves until interpolation fits."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, Generic, TypeVar

import numpy as np

from .values import Dynamic

T = TypeVar("T")
#: Check of an interpolation: values a and b, s (0 .. 1), and the true value at s between them.
Check = tuple[T, T, float, T]
#: Function that returns which checks are within tolerance.
Fits = Callable[[list[Check[T]]], Sequence[bool]]

#: Maximum number of keys of one value, and of halvings of a piece between two breaks.
MAX_KEYS = 4096
MAX_BREAKS = MAX_KEYS // 4
_MAX_HALVINGS = 10
_MAX_SAMPLES = 64
QUARTERS = (0.25, 0.5, 0.75)
#: Positions of the first samples: uneven, so that periodic motion does not look constant.
FIRST = (0.137, 0.25, 0.418, 0.5, 0.75, 0.873)


def samples(dynamic: Dynamic, open_s: float, close_s: float) -> list[tuple[float, Any]]:
    """Samples an interval at its ends, breaks and times between; returns times and values."""
    between = (open_s + s * (close_s - open_s) for s in FIRST)
    some = some_breaks(dynamic, open_s, close_s, _MAX_SAMPLES)
    return [(t, dynamic.at(t)) for t in sorted({open_s, close_s, *some, *between})]


def some_breaks(dynamic: Dynamic, open_s: float, close_s: float, most: int) -> list[float]:
    """Breaks inside an interval; if there are more than ``most``, every second, third, ..."""
    if most == 0:
        return []
    found = np.asarray(dynamic.breaks(open_s, close_s), np.float64)
    # A set, as np.unique imports np.ma, in each program that has anything that moves.
    inside = sorted(set(found[(open_s < found) & (found < close_s)].tolist()))
    return inside[:: max(1, math.ceil(len(inside) / most))]


class Subdivision(Generic[T]):
    """Samples a value until the interpolation error is within tolerance.

    If the value has a method ``many`` (times (T,) to T values), it evaluates many times at once.

    Args:
        dynamic: The value.
        taken: Function of the value to sample, such as a row of numbers.
        open_s: Begin of the interval, s.
        close_s: End of the interval, s.
        most_breaks: Maximum number of breaks to look at.
    """

    def __init__(
        self,
        dynamic: Dynamic,
        taken: Callable[[Any], T],
        open_s: float,
        close_s: float,
        most_breaks: int = MAX_BREAKS,
    ) -> None:
        self._cuts = [open_s, *some_breaks(dynamic, open_s, close_s, most_breaks)]
        if close_s > open_s:
            self._cuts.append(close_s)
        # Last moment before each break inside, where the value may jump.
        self._before = {t: math.nextafter(t, -math.inf) for t in self._cuts[1:-1]}
        self._dynamic, self._taken = dynamic, taken
        self._known: dict[float, T] = {}

    def first(self) -> list[T]:
        """Samples that show whether the value changes, and by how much."""
        inside = [a + s * (b - a) for a, b in pairwise(self._cuts) for s in FIRST]
        times = [*self._cuts, *self._before.values(), *inside]
        self._look(times)
        return [self._known[t] for t in times]

    def keys(self, fits: Fits[T]) -> list[tuple[float, T]]:
        """Returns keys in rising order of time; a jump has two keys at the same time."""
        inner = list(self._before)
        held = fits([(self._left_of(t), self._left_of(t), 0.0, self._known[t]) for t in inner])
        jumps = {t for t, fit in zip(inner, held, strict=True) if not fit}
        keys: list[tuple[float, T]] = []
        for time in sorted({*self._cuts, *self._halved(fits)}):
            keys.append((time, self._left_of(time)))
            if time in jumps:
                keys.append((time, self._known[time]))
        return keys

    def _halved(self, fits: Fits[T]) -> list[float]:
        """Times between the cuts at which keys are needed."""
        active, found = list(pairwise(self._cuts)), []
        checks: Sequence[float] = FIRST
        for _ in range(min(_MAX_HALVINGS, int(math.log2(MAX_KEYS / len(self._cuts))))):
            spans = [(a, a + 0.5 * (b - a), b) for a, b in self._failing(active, checks, fits)]
            found += [middle for _, middle, _ in spans]
            active = [half for a, middle, b in spans for half in ((a, middle), (middle, b))]
            checks = QUARTERS
        return found

    def _failing(
        self, spans: list[tuple[float, float]], checks: Sequence[float], fits: Fits[T]
    ) -> list[tuple[float, float]]:
        """Spans in which interpolation between the ends does not fit."""
        inside = [(a, b, s, a + s * (b - a)) for a, b in spans for s in checks]
        self._look([time for *_, time in inside])
        listed = [(self._known[a], self._left_of(b), s, self._known[t]) for a, b, s, t in inside]
        fit = list(fits(listed))
        step = len(checks)
        return [span for i, span in enumerate(spans) if not all(fit[i * step : (i + 1) * step])]

    def _left_of(self, time: float) -> T:
        return self._known[self._before.get(time, time)]

    def _look(self, times: Sequence[float]) -> None:
        """Evaluates the value at times that are not sampled yet."""
        new = [t for t in dict.fromkeys(times) if t not in self._known]
        many = getattr(self._dynamic, "many", None)
        values = map(self._dynamic.at, new) if many is None or not new else many(np.array(new))
        self._known |= {t: self._taken(v) for t, v in zip(new, values, strict=True)}
