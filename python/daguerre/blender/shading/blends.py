"""Blend modes of colours.

Source: Blender 5.0 Manual, "Color Blend Modes".
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.shading.channels import Numbers
from daguerre.shading.math_nodes import hsv_from_rgb, rgb_from_hsv

from .math_nodes import divided

Rgb = tuple[Numbers, Numbers, Numbers]


def _screen(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    return 1 - (1 - t + t * (1 - b)) * (1 - a)


def _overlay(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    dark, light = a * (1 - t + 2 * t * b), 1 - (1 - t + 2 * t * (1 - b)) * (1 - a)
    return np.where(a < 0.5, dark, light)


def _dodge(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    rest = 1 - t * b
    bright = np.where(rest <= 0, 1.0, np.minimum(divided(a, rest), 1))
    return np.where(a == 0, 0.0, bright)


def _burn(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    rest = 1 - t + t * b
    return np.where(rest <= 0, 0.0, np.clip(1 - divided(1 - a, rest), 0, 1))


def _soft_light(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    screen = 1 - (1 - b) * (1 - a)
    return (1 - t) * a + t * ((1 - a) * b * a + a * screen)


def _divide(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    return np.where(b != 0, (1 - t) * a + t * divided(a, b), a)


def _exclude(t: Numbers, a: Numbers, b: Numbers) -> Numbers:
    return np.maximum((1 - t) * a + t * (a + b - 2 * a * b), 0)


#: Functions of the factor and of one channel of both colours; Mix and Multiply keep pictures.
CHANNELS: dict[str, Callable[[Any, Any, Any], Any]] = {
    "ADD": lambda t, a, b: a + t * b,
    "SUBTRACT": lambda t, a, b: a - t * b,
    "DIVIDE": _divide,
    "SCREEN": _screen,
    "OVERLAY": _overlay,
    "SOFT_LIGHT": _soft_light,
    "LINEAR_LIGHT": lambda t, a, b: a + t * (2 * b - 1),
    "DIFFERENCE": lambda t, a, b: (1 - t) * a + t * np.abs(a - b),
    "EXCLUSION": _exclude,
    "DARKEN": lambda t, a, b: (1 - t) * a + t * np.minimum(a, b),
    "LIGHTEN": lambda t, a, b: (1 - t) * a + t * np.maximum(a, b),
    "DODGE": _dodge,
    "BURN": _burn,
}


def _mixed(t: Numbers, a: Rgb, b: Rgb, where: NDArray[np.bool_] | np.bool_ | bool) -> Rgb:
    """Interpolates from one colour to another where a test holds."""
    r, g, s = (np.where(where, p + t * (q - p), p) for p, q in zip(a, b, strict=True))
    return r, g, s


def _hue(t: Numbers, a: Rgb, b: Rgb) -> Rgb:
    _, saturation, value = hsv_from_rgb(*a)
    hue, other, _ = hsv_from_rgb(*b)
    return _mixed(t, a, rgb_from_hsv(hue, saturation, value), other != 0)


def _saturation(t: Numbers, a: Rgb, b: Rgb) -> Rgb:
    hue, saturation, value = hsv_from_rgb(*a)
    other = (1 - t) * saturation + t * hsv_from_rgb(*b)[1]
    return _mixed(1.0, a, rgb_from_hsv(hue, other, value), saturation != 0)


def _color(t: Numbers, a: Rgb, b: Rgb) -> Rgb:
    hue, saturation, _ = hsv_from_rgb(*b)
    return _mixed(t, a, rgb_from_hsv(hue, saturation, hsv_from_rgb(*a)[2]), saturation != 0)


def _value(t: Numbers, a: Rgb, b: Rgb) -> Rgb:
    hue, saturation, value = hsv_from_rgb(*a)
    return rgb_from_hsv(hue, saturation, (1 - t) * value + t * hsv_from_rgb(*b)[2])


#: Functions of the factor and of both colours.
COLORS: dict[str, Callable[[Any, Rgb, Rgb], Rgb]] = {
    "HUE": _hue,
    "SATURATION": _saturation,
    "COLOR": _color,
    "VALUE": _value,
}
