"""Nodes of texture coordinates and of primvars.

Source: OpenUSD, "UsdPreviewSurface Specification"; MaterialX specification 1.39, "Geometric
Nodes", and the graphs of ``place2d`` and ``tiledimage`` in its standard library.
"""

from __future__ import annotations

import math

from daguerre.files.json_item import short
from daguerre.io.materialx.graph import SIZES

from .channels import Value, VertexColor, broadcast, coordinates, fit
from .evaluate import Arguments

_COLORS = ("displayColor",)
_OPACITIES = ("displayOpacity",)


def texture_coordinates(given: Arguments) -> Value:
    """MaterialX texcoord: set 0 is ``st``, the others are ``st1``, ``st2``, ..."""
    index = int(given.number("index", 0.0))
    return coordinates(f"st{index}" if index else "st")


def geometry_color(given: Arguments) -> Value:
    """MaterialX geomcolor: the colours of the vertices."""
    return _primvar(given, "displayColor", (0.0,) * (given.size or 3))


def usd_primvar(given: Arguments) -> Value:
    """UsdPrimvarReader of any type."""
    kind = given.node.kind.rsplit("_", 1)[-1]
    size = _USD_SIZES.get(kind, 0) or given.size or 1
    fallback = broadcast(given.value("fallback", 0.0), size)
    return _primvar(given, given.text("varname"), fallback)


def geometry_property(given: Arguments) -> Value:
    """MaterialX geompropvalue."""
    default = broadcast(given.value("default", 0.0), given.size or 1)
    return _primvar(given, given.text("geomprop"), default)


def usd_transform(given: Arguments) -> Value:
    """UsdTransform2d: scales, rotates counter-clockwise, then translates."""
    arithmetic = given.context.math
    scaled = arithmetic.multiply(
        fit(given.value("in", (0.0, 0.0)), 2), given.numbers("scale", (1.0, 1.0))
    )
    turned = _turned(given, scaled, -given.number("rotation", 0.0))
    return arithmetic.add(turned, given.numbers("translation", (0.0, 0.0)))


def place(given: Arguments) -> Value:
    """MaterialX place2d."""
    return placed(given, given.value("texcoord", coordinates("st")), (0.0, 0.0))


def rotate(given: Arguments) -> Value:
    """MaterialX rotate2d: turns clockwise, by degrees."""
    return _turned(given, given.value("in", (0.0, 0.0)), given.number("amount", 0.0))


def placed(given: Arguments, uv: Value, pivot: tuple[float, float], order: float = 0.0) -> Value:
    """Coordinates after place2d: about the pivot, in one of two orders."""
    arithmetic = given.context.math
    middle = given.numbers("pivot", pivot)
    scale, offset = given.numbers("scale", (1.0, 1.0)), given.numbers("offset", (0.0, 0.0))
    degrees = given.number("rotate", 0.0)
    uv = arithmetic.subtract(fit(uv, 2), middle)
    if given.number("operationorder", order) == 0.0:
        uv = _turned(given, arithmetic.divide(uv, scale), degrees)
        uv = arithmetic.subtract(uv, offset)
    else:
        uv = _turned(given, arithmetic.subtract(uv, offset), degrees)
        uv = arithmetic.divide(uv, scale)
    return arithmetic.add(uv, middle)


def tiled(given: Arguments, uv: Value) -> Value:
    """Coordinates of tiledimage."""
    arithmetic = given.context.math
    uv = arithmetic.multiply(fit(uv, 2), given.numbers("uvtiling", (1.0, 1.0)))
    uv = arithmetic.subtract(uv, given.numbers("uvoffset", (0.0, 0.0)))
    uv = arithmetic.divide(uv, given.numbers("realworldimagesize", (1.0, 1.0)))
    return arithmetic.multiply(uv, given.numbers("realworldtilesize", (1.0, 1.0)))


def _turned(given: Arguments, uv: Value, degrees: float) -> Value:
    """Coordinates turned clockwise."""
    arithmetic, angle = given.context.math, math.radians(degrees)
    cosine, sine = math.cos(angle), math.sin(angle)
    u, v = ((channel,) for channel in fit(uv, 2))
    across = arithmetic.add(arithmetic.multiply(u, (cosine,)), arithmetic.multiply(v, (sine,)))
    up = arithmetic.add(arithmetic.multiply(u, (-sine,)), arithmetic.multiply(v, (cosine,)))
    return (*across, *up)


def _primvar(given: Arguments, name: str, fallback: Value) -> Value:
    """A primvar that varies over the surface, or the fallback if the surface has none."""
    has = given.context.has
    if not name or (has is not None and name not in has):
        return fallback
    if len(fallback) == 2:
        return coordinates(name)
    if name in _COLORS and len(fallback) > 2:
        return fit(tuple(VertexColor(name, i) for i in range(3)), len(fallback))
    if name in _OPACITIES and len(fallback) == 1:
        return (VertexColor(name, 3),)
    given.context.notes.add(f"primvar {short(name)} in a material shows its fallback value")
    return fallback


_USD_SIZES = {
    **{"float": 1, "float2": 2, "float3": 3, "float4": 4, "int": 1, "point": 3, "normal": 3},
    **{"vector": 3, "texcoord": 2},
    **SIZES,
}
