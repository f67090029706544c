"""Nodes of colours: Mix, curves, ramps, and adjustments.

Source: Blender 5.0 Manual, "Color Nodes" and "Converter Nodes"; weights of a grey of Rec.709.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from daguerre.shading.channels import Channel, Numbers, UnsupportedError, Value, broadcast
from daguerre.shading.evaluate import Arguments
from daguerre.shading.math_nodes import hsv_from_rgb, rgb_from_hsv

from . import blends
from .sockets import Sockets

_GREY = (0.2126, 0.7152, 0.0722)


def grey(given: Arguments) -> Value:
    """Number of a colour: its luminance."""
    return given.context.math.dot(broadcast(given.value("in", 0.0), 3), _GREY)


def rgb_to_bw(given: Arguments) -> Value:
    """RGB to BW."""
    return given.context.math.dot(Sockets(given).value("Color"), _GREY)


def mix(given: Arguments) -> Mapping[str, Value]:
    """Mix of numbers, vectors or colours."""
    sockets = Sockets(given)
    kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(sockets.text("data_type"))
    if kind is None:
        raise UnsupportedError(f"Mix: {sockets.text('data_type')}")
    size = 1 if kind == "Float" else 3
    a, b = sockets.value(f"A_{kind}", size), sockets.value(f"B_{kind}", size)
    each = kind == "Vector" and sockets.text("factor_mode") == "NON_UNIFORM"
    share = sockets.value("Factor_Vector") if each else sockets.one("Factor_Float")
    if sockets.flag("clamp_factor"):
        share = sockets.math.fraction(share)
    if kind != "Color":
        return {f"Result_{kind}": sockets.math.mix(a, b, share)}
    found = blended(sockets, sockets.text("blend_type", "MIX"), share, (a, b))
    clamped = sockets.flag("clamp_result")
    return {"Result_Color": sockets.math.fraction(found) if clamped else found}


def mix_rgb(given: Arguments) -> Value:
    """Mix RGB, of older files."""
    sockets = Sockets(given)
    share = sockets.math.fraction(sockets.one("Fac"))
    pair = sockets.value("Color1"), sockets.value("Color2")
    found = blended(sockets, sockets.text("blend_type", "MIX"), share, pair)
    return sockets.math.fraction(found) if sockets.flag("use_clamp") else found


def blended(sockets: Sockets, mode: str, share: Value, pair: tuple[Value, Value]) -> Value:
    """Two colours in a blend mode."""
    arithmetic, (a, b) = sockets.math, pair
    if mode == "MIX":
        return arithmetic.mix(a, b, share)
    if mode == "MULTIPLY":
        return arithmetic.mix(a, arithmetic.multiply(a, b), share)
    if mode in blends.CHANNELS:
        return arithmetic.each(blends.CHANNELS[mode], broadcast(share, 3), a, b)
    if mode not in blends.COLORS:
        raise UnsupportedError(f"Mix: {mode}")
    function = blends.COLORS[mode]
    combined = arithmetic.baker.combined

    def channel(index: int) -> Channel:
        return combined(lambda t, *c: function(t, c[:3], c[3:])[index], share[0], *a, *b)

    return channel(0), channel(1), channel(2)


def invert(given: Arguments) -> Value:
    """Invert Color."""
    sockets = Sockets(given)
    color = sockets.value("Color")
    return sockets.math.mix(color, sockets.math.subtract((1.0,), color), sockets.one("Fac"))


def gamma(given: Arguments) -> Value:
    """Gamma; colours at and below 0 stay."""
    sockets = Sockets(given)
    return sockets.math.each(_raised, sockets.value("Color"), sockets.one("Gamma"))


def _raised(color: Numbers, exponent: Numbers) -> Numbers:
    return np.where(color > 0, np.power(np.maximum(color, 0), exponent), color)


def brightness(given: Arguments) -> Value:
    """Brightness/Contrast."""
    sockets = Sockets(given)
    return sockets.math.each(
        lambda color, bright, contrast: np.maximum(
            (1 + contrast) * color + bright - contrast / 2, 0
        ),
        sockets.value("Color"),
        sockets.one("Bright"),
        sockets.one("Contrast"),
    )


def hue_saturation(given: Arguments) -> Value:
    """Hue/Saturation/Value."""
    sockets = Sockets(given)
    settings = [sockets.one(name)[0] for name in ("Hue", "Saturation", "Value", "Fac")]
    color = sockets.value("Color")
    combined = sockets.math.baker.combined
    r, g, b = (combined(partial(_adjusted, i), *settings, *color) for i in range(3))
    return r, g, b


def _adjusted(index: int, *arguments: Numbers) -> Numbers:
    turn, saturate, scale, share, *color = arguments
    hue, saturation, value = hsv_from_rgb(*color)
    hue = (hue + turn + 0.5) % 1.0
    changed = rgb_from_hsv(hue, np.clip(saturation * saturate, 0, 1), value * scale)[index]
    return np.maximum(color[index] + share * (changed - color[index]), 0)


def color_ramp(given: Arguments) -> Mapping[str, Value]:
    """Color Ramp."""
    sockets = Sockets(given)
    share = sockets.math.fraction(sockets.one("Fac"))
    r, g, b, a = (_looked_up(sockets, share, name)[0] for name in "rgba")
    return {"Color": (r, g, b), "Alpha": (a,)}


def curves(given: Arguments) -> Value:
    """RGB Curves and Vector Curves."""
    sockets = Sockets(given)
    name = "Color" if given.node.kind == "ShaderNodeRGBCurve" else "Vector"
    found = sockets.value(name)
    r, g, b = (_looked_up(sockets, (found[i],), c)[0] for i, c in enumerate("rgb"))
    return sockets.math.mix(found, (r, g, b), sockets.one("Fac"))


def float_curve(given: Arguments) -> Value:
    """Float Curve."""
    sockets = Sockets(given)
    found = sockets.one("Value")
    return sockets.math.mix(found, _looked_up(sockets, found, "r"), sockets.one("Factor"))


def _looked_up(sockets: Sockets, value: Value, name: str) -> Value:
    """Value of a curve, linear between the rows of its table."""
    x, y = np.array(sockets.table("x")), np.array(sockets.table(name))
    return sockets.math.each(lambda v: np.interp(v, x, y), value)


def separate_color(given: Arguments) -> Mapping[str, Value]:
    """Separate Color into red, green and blue, or the channels of another model."""
    sockets = Sockets(given)
    found = sockets.value("Color")
    mode = sockets.text("mode", "RGB")
    if mode != "RGB":
        found = _of_three(sockets, {"HSV": hsv_from_rgb, "HSL": _hsl_from_rgb}[mode], found)
    return {"Red": found[:1], "Green": found[1:2], "Blue": found[2:]}


def combine_color(given: Arguments) -> Value:
    """Combine Color."""
    sockets = Sockets(given)
    found = sockets.one("Red") + sockets.one("Green") + sockets.one("Blue")
    mode = sockets.text("mode", "RGB")
    if mode == "RGB":
        return found
    return _of_three(sockets, {"HSV": rgb_from_hsv, "HSL": _rgb_from_hsl}[mode], found)


def _of_three(sockets: Sockets, function: Callable[..., Any], value: Value) -> Value:
    combined = sockets.math.baker.combined

    def channel(index: int) -> Channel:
        return combined(lambda *c: function(*c)[index], *value)

    return channel(0), channel(1), channel(2)


def _hsl_from_rgb(r: Numbers, g: Numbers, b: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Hue in turns, saturation and lightness."""
    hue, _, high = hsv_from_rgb(r, g, b)
    low = np.minimum(np.minimum(r, g), b)
    light = (high + low) / 2
    rest = np.where(light > 0.5, 2 - high - low, high + low)
    return hue, np.where(rest == 0, 0, (high - low) / np.where(rest == 0, 1, rest)), light


def _rgb_from_hsl(
    hue: Numbers, saturation: Numbers, light: Numbers
) -> tuple[Numbers, Numbers, Numbers]:
    """Red, green and blue; undoes ``_hsl_from_rgb``."""
    chroma = (1 - np.abs(2 * light - 1)) * saturation
    r, g, b = ((pure - 0.5) * chroma + light for pure in rgb_from_hsv(hue, 1.0, 1.0))
    return r, g, b
