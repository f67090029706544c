"""Arithmetic on values, channel by channel: exact for numbers, per texel for pictures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from .bake import Baker
from .channels import (
    Channel,
    Coordinate,
    Texel,
    UnsupportedError,
    Value,
    broadcast,
    scaled,
    shifted,
)
from .channels import same as same_value


class Arithmetic:
    """Operations between values; single channels are repeated to the size of the other operands."""

    def __init__(self, baker: Baker) -> None:
        self.baker = baker

    def each(self, function: Callable[..., Any], *values: Value) -> Value:
        """Applies a function of numbers to each channel."""
        return self._zipped(lambda *c: self.baker.combined(function, *c), *values)

    def add(self, a: Value, b: Value) -> Value:
        """Sum."""
        return self._zipped(self._sum, a, b)

    def subtract(self, a: Value, b: Value) -> Value:
        """Difference."""
        return self.add(a, self.multiply(b, (-1.0,)))

    def multiply(self, a: Value, b: Value) -> Value:
        """Product."""
        return self._zipped(self._product, a, b)

    def divide(self, a: Value, b: Value) -> Value:
        """Quotient; 0 where the divisor is 0."""
        return self._zipped(self._quotient, a, b)

    def mix(self, background: Value, foreground: Value, share: Value) -> Value:
        """Interpolates from the background to the foreground."""
        return self._zipped(self._mixed, background, foreground, share)

    def dot(self, a: Value, b: Value) -> Value:
        """Scalar product."""
        total: Value = (0.0,)
        for product in self.multiply(a, b):
            total = self.add(total, (product,))
        return total

    def clamp(self, value: Value, low: Value, high: Value) -> Value:
        """Limits to a range."""
        return self._zipped(self._clamped, value, low, high)

    def fraction(self, value: Value) -> Value:
        """Limits to 0 .. 1."""
        return self.clamp(value, (0.0,), (1.0,))

    def power(self, value: Value, exponent: Value) -> Value:
        """Power; 1 as the exponent changes nothing."""
        if exponent == (1.0,) * len(exponent):
            return broadcast(value, max(len(value), len(exponent)))
        return self.each(np.power, value, exponent)

    @staticmethod
    def _zipped(function: Callable[..., Channel], *values: Value) -> Value:
        size = max(len(value) for value in values)
        rows = zip(*(broadcast(value, size) for value in values), strict=True)
        return tuple(function(*channels) for channels in rows)

    def _sum(self, a: Channel, b: Channel) -> Channel:
        if isinstance(b, float):
            return shifted(a, b)
        if isinstance(a, float):
            return shifted(b, a)
        if isinstance(a, Coordinate) and isinstance(b, Coordinate) and a.primvar == b.primvar:
            return Coordinate(a.primvar, a.a + b.a, a.b + b.b, a.c + b.c)
        if isinstance(a, Texel) and isinstance(b, Texel) and _same_texel(a, b):
            return replace(a, scale=a.scale + b.scale, bias=a.bias + b.bias)
        return self.baker.combined(np.add, a, b)

    def _product(self, a: Channel, b: Channel) -> Channel:
        if isinstance(b, float):
            return scaled(a, b)
        if isinstance(a, float):
            return scaled(b, a)
        return self.baker.combined(np.multiply, a, b)

    def _quotient(self, a: Channel, b: Channel) -> Channel:
        if isinstance(b, float):
            return scaled(a, 1.0 / b) if b else 0.0
        return self.baker.combined(np.divide, a, b)

    def _mixed(self, background: Channel, foreground: Channel, share: Channel) -> Channel:
        if same_value((background,), (foreground,)) or share == 0.0:
            return background
        if share == 1.0:
            return foreground
        if isinstance(share, float):
            return self._sum(scaled(background, 1.0 - share), scaled(foreground, share))
        if isinstance(background, float) and isinstance(foreground, float):
            return shifted(scaled(share, foreground - background), background)
        return self.baker.combined(lambda b, f, s: b + s * (f - b), background, foreground, share)

    def _clamped(self, value: Channel, low: Channel, high: Channel) -> Channel:
        if isinstance(value, Texel) and isinstance(low, float) and isinstance(high, float):
            ends = value.bias, value.bias + value.scale
            if value.plane.pixels.dtype == np.uint8 and low <= min(ends) and max(ends) <= high:
                return value
        if isinstance(value, Coordinate) and self.baker.canvas is None:
            raise UnsupportedError("limits on texture coordinates")
        return self.baker.combined(
            lambda v, a, b: np.minimum(np.maximum(v, a), b), value, low, high
        )


def _same_texel(a: Texel, b: Texel) -> bool:
    return a.mapping == b.mapping and a.plane.key == b.plane.key
