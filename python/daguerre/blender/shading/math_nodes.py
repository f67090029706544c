"""Nodes of numbers and vectors: Math, Vector Math, Map Range, Clamp, and channels.

Source: Blender 5.0 Manual, "Converter Nodes" and "Utilities"; smooth minimum: Quilez, "smooth
minimum" (cubic).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.shading.channels import Channel, Numbers, UnsupportedError, Value
from daguerre.shading.evaluate import Arguments

from .sockets import Sockets

_LEAST = 1e-5


def _where(test: NDArray[np.bool_] | np.bool_ | bool, value: Callable[[], Any]) -> Numbers:
    """Value where a test holds, else 0."""
    with np.errstate(all="ignore"):
        return np.where(test, value(), 0.0)


def divided(a: Numbers, b: Numbers) -> Numbers:
    """Quotient; 0 where the divisor is 0."""
    return _where(b != 0, lambda: a / b)


def power(a: Numbers, b: Numbers) -> Numbers:
    """Power; 0 where a negative base has an exponent that is not whole."""
    return _where((a >= 0) | (b == np.floor(b)), lambda: np.power(a, b))


def modulo(a: Numbers, b: Numbers) -> Numbers:
    """Remainder with the sign of the dividend."""
    return _where(b != 0, lambda: np.fmod(a, b))


def wrapped(a: Numbers, high: Numbers, low: Numbers) -> Numbers:
    """Wraps a number into the range [low, high)."""
    span = high - low
    return np.where(span != 0, a - span * np.floor(divided(a - low, span)), low)


def snapped(a: Numbers, step: Numbers) -> Numbers:
    """Multiple of a step at or below a number."""
    return np.floor(divided(a, step)) * step


def _ping_pong(a: Numbers, b: Numbers) -> Numbers:
    turns = divided(a - b, 2 * b)
    return _where(b != 0, lambda: np.abs((turns - np.floor(turns)) * 2 * b - b))


def _smooth_minimum(a: Numbers, b: Numbers, width: Numbers) -> Numbers:
    share = _where(width != 0, lambda: np.maximum(width - np.abs(a - b), 0) / width)
    return np.minimum(a, b) - share**3 * width / 6


def _logarithm(a: Numbers, base: Numbers) -> Numbers:
    return _where((a > 0) & (base > 0), lambda: divided(np.log(a), np.log(base)))


#: Functions of numbers by operation, with the number of their arguments.
_MATH: dict[str, tuple[int, Callable[..., Any]]] = {
    "DIVIDE": (2, divided),
    "POWER": (2, power),
    "LOGARITHM": (2, _logarithm),
    "SQRT": (1, lambda a: np.sqrt(np.maximum(a, 0))),
    "INVERSE_SQRT": (1, lambda a: _where(a > 0, lambda: 1 / np.sqrt(a))),
    "ABSOLUTE": (1, np.abs),
    "EXPONENT": (1, np.exp),
    "MINIMUM": (2, np.minimum),
    "MAXIMUM": (2, np.maximum),
    "LESS_THAN": (2, lambda a, b: np.where(a < b, 1.0, 0.0)),
    "GREATER_THAN": (2, lambda a, b: np.where(a > b, 1.0, 0.0)),
    "SIGN": (1, np.sign),
    "COMPARE": (
        3,
        lambda a, b, c: np.where((a == b) | (np.abs(a - b) <= np.maximum(c, _LEAST)), 1.0, 0.0),
    ),
    "SMOOTH_MIN": (3, _smooth_minimum),
    "SMOOTH_MAX": (3, lambda a, b, c: -_smooth_minimum(-a, -b, c)),
    "ROUND": (1, lambda a: np.floor(a + 0.5)),
    "FLOOR": (1, np.floor),
    "CEIL": (1, np.ceil),
    "TRUNC": (1, np.trunc),
    "FRACT": (1, lambda a: a - np.floor(a)),
    "MODULO": (2, modulo),
    "FLOORED_MODULO": (2, lambda a, b: _where(b != 0, lambda: a - np.floor(a / b) * b)),
    "WRAP": (3, wrapped),
    "SNAP": (2, snapped),
    "PINGPONG": (2, _ping_pong),
    "SINE": (1, np.sin),
    "COSINE": (1, np.cos),
    "TANGENT": (1, np.tan),
    "ARCSINE": (1, lambda a: np.arcsin(np.clip(a, -1, 1))),
    "ARCCOSINE": (1, lambda a: np.arccos(np.clip(a, -1, 1))),
    "ARCTANGENT": (1, np.arctan),
    "ARCTAN2": (2, np.arctan2),
    "SINH": (1, np.sinh),
    "COSH": (1, np.cosh),
    "TANH": (1, np.tanh),
    "RADIANS": (1, np.radians),
    "DEGREES": (1, np.degrees),
}
#: Operations that keep a picture as it is, or coordinates affine.
_AFFINE = {"ADD": "add", "SUBTRACT": "subtract", "MULTIPLY": "multiply", "DIVIDE": "divide"}
#: Operations of vectors that work on each channel, with the names of the operations of numbers.
_EACH = {
    **{name: name for name in ("POWER", "SIGN", "ABSOLUTE", "MINIMUM", "MAXIMUM", "FLOOR")},
    **{name: name for name in ("CEIL", "MODULO", "WRAP", "SNAP", "SINE", "COSINE", "TANGENT")},
    **{"FRACTION": "FRACT", "ROUND": "ROUND"},
}


def math(given: Arguments) -> Value:
    """Math."""
    sockets, operation = Sockets(given), given.text(".operation")
    names = ("Value", "Value_001", "Value_002")
    if operation in _AFFINE:
        method = getattr(sockets.math, _AFFINE[operation])
        found: Value = method(sockets.one(names[0]), sockets.one(names[1]))
    elif operation == "MULTIPLY_ADD":
        a, b, c = (sockets.one(name) for name in names)
        found = sockets.math.add(sockets.math.multiply(a, b), c)
    elif operation in _MATH:
        count, function = _MATH[operation]
        found = sockets.math.each(function, *(sockets.one(name) for name in names[:count]))
    else:
        raise UnsupportedError(f"Math: {operation}")
    return sockets.math.fraction(found) if sockets.flag("use_clamp") else found


def vector_math(given: Arguments) -> Mapping[str, Value]:
    """Vector Math: a vector, or a number."""
    sockets, operation = Sockets(given), given.text(".operation")
    a, b = sockets.value("Vector"), sockets.value("Vector_001")
    arithmetic = sockets.math
    if operation in ("DOT_PRODUCT", "LENGTH", "DISTANCE"):
        if operation == "DOT_PRODUCT":
            return {"Value": arithmetic.dot(a, b)}
        difference = a if operation == "LENGTH" else arithmetic.subtract(a, b)
        return {"Value": arithmetic.each(np.sqrt, arithmetic.dot(difference, difference))}
    return {"Vector": _vector(sockets, operation, a, b)}


def _vector(sockets: Sockets, operation: str, a: Value, b: Value) -> Value:
    arithmetic = sockets.math
    if operation in _AFFINE:
        found: Value = getattr(arithmetic, _AFFINE[operation])(a, b)
        return found
    if operation == "MULTIPLY_ADD":
        return arithmetic.add(arithmetic.multiply(a, b), sockets.value("Vector_002"))
    if operation == "SCALE":
        return arithmetic.multiply(a, sockets.one("Scale"))
    if operation == "NORMALIZE":
        return arithmetic.divide(a, arithmetic.each(np.sqrt, arithmetic.dot(a, a)))
    if operation == "CROSS_PRODUCT":
        return _crossed(sockets, a, b)
    if operation == "PROJECT":
        return arithmetic.multiply(b, arithmetic.divide(arithmetic.dot(a, b), arithmetic.dot(b, b)))
    if operation == "REFLECT":
        length = arithmetic.each(np.sqrt, arithmetic.dot(b, b))
        normal = arithmetic.divide(b, length)
        twice = arithmetic.multiply(arithmetic.dot(a, normal), (2.0,))
        return arithmetic.subtract(a, arithmetic.multiply(normal, twice))
    if operation in ("REFRACT", "FACEFORWARD"):
        return _bent(sockets, operation, a, b)
    if operation not in _EACH:
        raise UnsupportedError(f"Vector Math: {operation}")
    count, function = _MATH[_EACH[operation]]
    return arithmetic.each(function, *(a, b, sockets.value("Vector_002"))[:count])


def _bent(sockets: Sockets, operation: str, a: Value, b: Value) -> Value:
    """Refract: a vector by Snell's law at a normal. Faceforward: one turned against another."""
    arithmetic = sockets.math
    if operation == "FACEFORWARD":
        facing = arithmetic.dot(sockets.value("Vector_002"), b)
        side = arithmetic.each(lambda d: np.where(d < 0, 1.0, -1.0), facing)
        return arithmetic.multiply(a, side)
    eta = sockets.one("Scale")
    normal = arithmetic.divide(b, arithmetic.each(np.sqrt, arithmetic.dot(b, b)))
    cosine = arithmetic.dot(a, normal)
    rest = arithmetic.each(lambda n, c: 1 - n * n * (1 - c * c), eta, cosine)
    along = arithmetic.each(lambda n, c, k: n * c + np.sqrt(np.maximum(k, 0)), eta, cosine, rest)
    found = arithmetic.subtract(arithmetic.multiply(a, eta), arithmetic.multiply(normal, along))
    passes = arithmetic.each(lambda k: np.where(k >= 0, 1.0, 0.0), rest)
    return arithmetic.multiply(found, passes)


def _crossed(sockets: Sockets, a: Value, b: Value) -> Value:
    combined = sockets.math.baker.combined

    def component(i: int, j: int) -> Channel:
        return combined(lambda p, q, r, s: p * q - r * s, a[i], b[j], a[j], b[i])

    return component(1, 2), component(2, 0), component(0, 1)


def clamp(given: Arguments) -> Value:
    """Clamp: between two limits; in the mode of ranges in any order."""
    sockets = Sockets(given)
    low, high = sockets.one("Min"), sockets.one("Max")
    if sockets.text("clamp_type") == "RANGE":
        each = sockets.math.each
        low, high = each(np.minimum, low, high), each(np.maximum, low, high)
    return sockets.math.clamp(sockets.one("Value"), low, high)


def map_range(given: Arguments) -> Mapping[str, Value]:
    """Map Range of a number or a vector."""
    sockets = Sockets(given)
    if sockets.text("data_type") == "FLOAT_VECTOR":
        names, size, output = ("From_Min", "From_Max", "To_Min", "To_Max"), 3, "Vector"
        values = [sockets.value("Vector")]
        values += [sockets.value(f"{name}_FLOAT3") for name in names]
        steps = sockets.value("Steps_FLOAT3")
    else:
        names, size, output = ("From Min", "From Max", "To Min", "To Max"), 1, "Result"
        values = [sockets.value(name, size) for name in ("Value", *names)]
        steps = sockets.one("Steps")
    how = sockets.text("interpolation_type", "LINEAR")
    function = partial(_remapped, how, sockets.flag("clamp"))
    return {output: sockets.math.each(function, *values, steps)}


def _remapped(how: str, clamped: bool, *arguments: Numbers) -> Numbers:
    value, low, high, start, end, steps = arguments
    share = divided(value - low, high - low)
    if how == "STEPPED":
        share = _where(steps > 0, lambda: np.floor(share * (steps + 1)) / steps)
    elif how == "SMOOTHSTEP":
        share = np.clip(share, 0, 1)
        share = share * share * (3 - 2 * share)
    elif how == "SMOOTHERSTEP":
        share = np.clip(share, 0, 1)
        share = share**3 * (share * (share * 6 - 15) + 10)
    found = np.where(high != low, start + share * (end - start), 0.0)
    if clamped and how in ("LINEAR", "STEPPED"):
        found = np.clip(found, np.minimum(start, end), np.maximum(start, end))
    return found


def separate_xyz(given: Arguments) -> Mapping[str, Value]:
    """Separate XYZ."""
    found = Sockets(given).value("Vector")
    return {name: (channel,) for name, channel in zip("XYZ", found, strict=True)}


def combine_xyz(given: Arguments) -> Value:
    """Combine XYZ."""
    sockets = Sockets(given)
    return sockets.one("X") + sockets.one("Y") + sockets.one("Z")


def mean(given: Arguments) -> Value:
    """Number of a vector: the mean of its channels."""
    arithmetic = given.context.math
    return arithmetic.multiply(arithmetic.dot(given.value("in", 0.0), (1.0, 1.0, 1.0)), (1 / 3,))


def constant(given: Arguments) -> Value:
    """Value and RGB."""
    return given.value(".value", 0.0)
