"""Arithmetic nodes of MaterialX.

Source: MaterialX specification 1.39, "Math Nodes", "Adjustment Nodes", "Compositing Nodes",
"Conditional Nodes" and "Channel Nodes".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from daguerre.shading.channels import Numbers

from .channels import Channel, UnsupportedError, Value, broadcast
from .evaluate import Arguments, Operation

#: Weights of red, green and blue in the luminance of linear Rec.709: the defaults of MaterialX.
_LUMA = (0.2722287, 0.6740818, 0.0536895)
_LETTERS = {**{"r": 0, "g": 1, "b": 2, "a": 3}, **{"x": 0, "y": 1, "z": 2, "w": 3}}


def constant(given: Arguments) -> Value:
    """A constant value."""
    return _typed(given, given.value("value", 0.0))


def unary(function: Callable[[Any], Any], name: str = "in") -> Operation:
    """Node that applies a function to each channel."""
    return lambda given: given.context.math.each(function, given.value(name, 0.0))


def binary(method: str, a: float, b: float) -> Operation:
    """Node with the inputs in1 and in2 that applies a method of ``Arithmetic``."""

    def apply(given: Arguments) -> Value:
        function = getattr(given.context.math, method)
        found: Value = function(given.value("in1", a), given.value("in2", b))
        return found

    return apply


def each_of_two(function: Callable[[Any, Any], Any], a: float, b: float) -> Operation:
    """Node with the inputs in1 and in2 that applies a function to each channel."""
    return lambda given: given.context.math.each(
        function, given.value("in1", a), given.value("in2", b)
    )


def passed(given: Arguments) -> Value:
    """The input as it is."""
    return _typed(given, given.value("in", 0.0))


def convert(given: Arguments) -> Value:
    """Changes the number of channels."""
    return _typed(given, given.value("in", 0.0))


def mix(given: Arguments) -> Value:
    """Interpolates between two values."""
    return given.context.math.mix(
        given.value("bg", 0.0), given.value("fg", 0.0), given.value("mix", 0.0)
    )


def clamp(given: Arguments) -> Value:
    """Limits to a range."""
    return given.context.math.clamp(
        given.value("in", 0.0), given.value("low", 0.0), given.value("high", 1.0)
    )


def invert(given: Arguments) -> Value:
    """Difference from an amount."""
    return given.context.math.subtract(given.value("amount", 1.0), given.value("in", 0.0))


def remap(given: Arguments) -> Value:
    """Maps one range to another, linearly."""
    arithmetic = given.context.math
    low, high = given.value("inlow", 0.0), given.value("inhigh", 1.0)
    start, end = given.value("outlow", 0.0), given.value("outhigh", 1.0)
    share = arithmetic.divide(
        arithmetic.subtract(given.value("in", 0.0), low), arithmetic.subtract(high, low)
    )
    return arithmetic.add(arithmetic.multiply(share, arithmetic.subtract(end, start)), start)


def smoothstep(given: Arguments) -> Value:
    """Rises smoothly from 0 to 1 between two values."""
    value, low, high = given.value("in", 0.0), given.value("low", 0.0), given.value("high", 1.0)
    return given.context.math.each(_smooth, value, low, high)


def _smooth(value: Numbers, low: Numbers, high: Numbers) -> Numbers:
    share = (value - low) / np.where(high == low, 1, high - low)
    return np.where(value >= high, 1, np.where(value <= low, 0, share * share * (3 - 2 * share)))


def contrast(given: Arguments) -> Value:
    """Scales the difference from a pivot."""
    arithmetic, pivot = given.context.math, given.value("pivot", 0.5)
    difference = arithmetic.subtract(given.value("in", 0.0), pivot)
    return arithmetic.add(arithmetic.multiply(difference, given.value("amount", 1.0)), pivot)


def luminance(given: Arguments) -> Value:
    """Weighted sum of red, green and blue, in all channels."""
    found = _color(given)
    grey = given.context.math.dot(found[:3], given.value("lumacoeffs", _LUMA))
    return (*grey * 3, *found[3:])


def saturate(given: Arguments) -> Value:
    """Interpolates between grey and a colour."""
    found = _color(given)
    arithmetic = given.context.math
    grey = arithmetic.dot(found[:3], given.value("lumacoeffs", _LUMA)) * 3
    return (*arithmetic.mix(grey, found[:3], given.value("amount", 1.0)), *found[3:])


def of_three(function: Callable[..., Any]) -> Operation:
    """Node that computes a colour from the three channels of another."""

    def apply(given: Arguments) -> Value:
        found = _color(given)
        combined = given.context.math.baker.combined
        color = (combined(partial(_chosen, function, i), *found[:3]) for i in range(3))
        return (*color, *found[3:])

    return apply


def hsv_from_rgb(r: Numbers, g: Numbers, b: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Hue in turns, saturation and value (Smith 1978, "Color gamut transform pairs").

    Colours without a channel above 0 have neither hue nor saturation.
    """
    high, low = np.maximum(np.maximum(r, g), b), np.minimum(np.minimum(r, g), b)
    span = np.where(high > 0, high - low, 0)
    safe = np.where(span == 0, 1, span)
    sixths = np.where(
        high == r,
        (g - b) / safe,
        np.where(high == g, 2 + (b - r) / safe, 4 + (r - g) / safe),
    )
    hue = np.where(span == 0, 0, sixths / 6 % 1.0)
    return hue, span / np.where(span == 0, 1, high), high


def rgb_from_hsv(h: Numbers, s: Numbers, v: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Red, green and blue of hue (in turns), saturation and value; undoes ``hsv_from_rgb``."""
    r, g, b = (
        v * (1 - s * np.clip(np.minimum(k, 4 - k), 0, 1))
        for k in ((start + 6 * h) % 6 for start in (5, 3, 1))
    )
    return r, g, b


def _chosen(function: Callable[..., Any], index: int, *channels: object) -> Any:
    return function(*channels)[index]


def dot_product(given: Arguments) -> Value:
    """Scalar product."""
    return given.context.math.dot(given.value("in1", 0.0), given.value("in2", 0.0))


def magnitude(given: Arguments) -> Value:
    """Length of a vector."""
    found = given.value("in", 0.0)
    arithmetic = given.context.math
    return arithmetic.each(np.sqrt, arithmetic.dot(found, found))


def normalize(given: Arguments) -> Value:
    """Vector of length 1."""
    return given.context.math.divide(given.value("in", 0.0), magnitude(given))


def combine(given: Arguments) -> Value:
    """Joins the channels of two to four inputs; missing inputs fill the rest with 0."""
    names = ("in1", "in2", "in3", "in4")[: int(given.node.kind[-1])]
    parts = [given.given(name) for name in names]
    missing = sum(part is None for part in parts)
    rest = given.size - sum(len(part) for part in parts if part is not None)
    zeros = (0.0,) * max(rest // max(missing, 1), 1)
    found = [zeros if part is None else part for part in parts]
    return _typed(given, tuple(channel for part in found for channel in part))


def separate(given: Arguments) -> Mapping[str, Value]:
    """Each channel by its letters."""
    found = broadcast(given.value("in", 0.0), int(given.node.kind[-1]))
    names = {}
    for letter, index in _LETTERS.items():
        if index < len(found):
            names["out" + letter] = (found[index],)
    return names


def extract(given: Arguments) -> Value:
    """One channel by its number; all of a missing value are 0."""
    found, index = given.given("in") or (0.0,) * 4, int(given.number("index", 0.0))
    if not 0 <= index < len(found):
        raise UnsupportedError(f"extract: channel {index} of {len(found)}")
    return (found[index],)


def swizzle(given: Arguments) -> Value:
    """Channels by letters; the digits 0 and 1 are constants."""
    found, chosen = given.value("in", 0.0), list[Channel]()
    for letter in given.text("channels"):
        index = _LETTERS.get(letter, len(found))
        if letter in "01":
            chosen.append(float(letter))
        elif index < len(found):
            chosen.append(found[index])
        else:
            raise UnsupportedError(f"swizzle: channel {letter!r} of {len(found)}")
    return _typed(given, tuple(chosen) or (0.0,))


def compared(test: Callable[[Any, Any], Any], first: float = 1.0) -> Operation:
    """Node that chooses in1 where a test of value1 and value2 holds, else in2."""

    def apply(given: Arguments) -> Value:
        a, b = given.value("value1", first), given.value("value2", 0.0)
        yes, no = given.value("in1", 0.0), given.value("in2", 0.0)
        size = max(len(yes), len(no))
        share = given.context.math.each(lambda x, y: np.where(test(x, y), 1.0, 0.0), a, b)
        return given.context.math.mix(broadcast(no, size), broadcast(yes, size), share)

    return apply


def switch(given: Arguments) -> Value:
    """One of the inputs in1 to in10 by its number; 0 beyond the last."""
    index = int(min(max(given.number("which", 0.0), 0.0), 10.0))
    return _typed(given, given.value(f"in{index + 1}", 0.0) if index < 10 else (0.0,))


def _color(given: Arguments) -> Value:
    """Input of a colour, with opacity if the node has it."""
    return broadcast(given.value("in", 0.0), 4 if given.size == 4 else 3)


def _typed(given: Arguments, value: Value) -> Value:
    """Value with as many channels as the output; a number is repeated, in opacity too."""
    return broadcast(value, given.size) if given.size else value
