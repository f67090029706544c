"""Functions on the interval from 0 on which they increase, and their inverse."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
SAMPLES = 4097
NEWTON = 12


class Monotone:
    """Function f with f(0) = 0, from 0 to where it stops increasing or ends; NaN beyond.

    A lens shows no direction twice, so a distortion formula that folds is beyond its fitted range.
    """

    def __init__(self, function: Callable[[FloatArray], FloatArray], samples: FloatArray) -> None:
        """Finds the end of the interval.

        Args:
            function: Elementwise function.
            samples: Points from 0 upward, shape (N,); none beyond the last is evaluated.
        """
        self._function = function
        with np.errstate(all="ignore"):
            values = function(samples)
            rising = np.isfinite(values[1:]) & (np.diff(values) > 0)
        count = len(samples) if rising.all() else int(np.argmin(rising)) + 1
        self.limit = float(samples[-1])
        if count < len(samples):  # it turns before or behind the last sample at which it has risen
            self.limit = self._end(float(samples[max(count - 2, 0)]), float(samples[count]))
        self._x = np.append(samples[samples < self.limit], self.limit)
        self._y = function(self._x)
        self.value_limit = float(self._y[-1])

    def __call__(self, x: FloatArray) -> FloatArray:
        """Returns f(x); NaN beyond the end."""
        with np.errstate(all="ignore"):
            return np.where(x <= self.limit, self._function(x), np.nan)

    def inverse(self, y: FloatArray) -> FloatArray:
        """Returns x with f(x) = y, by Newton's method from a table; NaN beyond the end."""
        known = y <= self.value_limit
        goal = np.where(known, y, 0.0)
        x = np.interp(goal, self._y, self._x)
        for _ in range(NEWTON):
            miss = self._function(x) - goal
            if np.abs(miss).max(initial=0) < 1e-14:
                break
            with np.errstate(all="ignore"):
                step = miss / self._slope(x)
            x = np.clip(x - np.where(np.isfinite(step), step, 0), 0, self.limit)
        return np.where(known, x, np.nan)

    def _slope(self, x: FloatArray) -> FloatArray:
        h = 1e-6 * (1 + x)
        low, high = np.maximum(x - h, 0), np.minimum(x + h, self.limit)
        return np.asarray((self._function(high) - self._function(low)) / (high - low))

    def _end(self, low: float, high: float) -> float:
        """Position of the maximum, between a point before and a point behind it."""
        width = high - low
        for _ in range(40):
            middle = 0.5 * (low + high)
            near = np.array([middle - 1e-5 * width, middle + 1e-5 * width])
            with np.errstate(all="ignore"):
                a, b = self._function(near)
            low, high = (middle, high) if np.isfinite(a) and b > a else (low, middle)
        return low
