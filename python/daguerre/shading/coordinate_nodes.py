"""Nodes of texture coordinates and of primvars.

Source: OpenUSD, "UsdPreviewSurface Specification"; MaterialX specification 1.39, "Geometric
Nodes", and the graphs of ``place2d``, ``tiledimage`` and ``gltf_image`` in its libraries.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from daguerre.files.json_item import short
from daguerre.shading.materialx.graph import SIZES

from .channels import Value, VertexColor, broadcast, coordinates, fit
from .evaluate import Arguments

_COLORS = ("displayColor",)
_OPACITIES = ("displayOpacity",)


def texture_coordinates(given: Arguments) -> Value:
    """MaterialX texcoord: set 0 is ``st``, further sets are ``st1``, ``st2``, ..."""
    index = int(given.number("index", 0.0))
    return fit(coordinates(f"st{index}" if index else "st"), max(given.size, 2))


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


@dataclass(frozen=True)
class _Placement:
    """Inputs of place2d.

    Attributes:
        pivot: Point about which a picture is scaled and turned.
        scale: Size of the picture along both axes.
        degrees: Angle by which coordinates turn clockwise.
        offset: Shift of the picture.
        scale_first: Whether coordinates are scaled, turned, then shifted; else the reverse.
    """

    pivot: tuple[float, ...]
    scale: tuple[float, ...]
    degrees: float
    offset: tuple[float, ...]
    scale_first: bool


def place(given: Arguments) -> Value:
    """MaterialX place2d."""
    return _placed(given, given.value("texcoord", (0.0, 0.0)), _placement(given, (0.0, 0.0)))


def rotate(given: Arguments) -> Value:
    """MaterialX rotate2d: turns clockwise, by degrees."""
    return _turned(given, given.value("in", (0.0, 0.0)), given.number("amount", 0.0))


def placed_by_gltf(given: Arguments, *, ordered: bool = True) -> Value:
    """Coordinates of the glTF nodes.

    The nodes scale and turn coordinates instead of the picture, so their graphs pass the inverse
    of each input to place2d; offsets refer to coordinates with (0, 0) at the top left. The default
    order follows the definitions, and differs for colours with opacity.

    Args:
        given: Inputs of the node.
        ordered: Whether the node passes its ``operationorder`` on; else coordinates are scaled
            first.
    """
    found = _placement(given, (0.0, 1.0), 1.0 if given.node.type == "color4" else 0.0)
    across, up = found.offset
    inverse = replace(
        found,
        scale=tuple(1.0 / size if size else 0.0 for size in found.scale),
        degrees=-found.degrees,
        offset=(-across, up),
        scale_first=found.scale_first or not ordered,
    )
    return _placed(given, given.given("texcoord") or coordinates("st"), inverse)


def tiled(given: Arguments, uv: Value) -> Value:
    """Coordinates of tiledimage."""
    arithmetic = given.context.math
    uv = arithmetic.multiply(fit(uv, 2), given.numbers("uvtiling", (1.0, 1.0)))
    uv = arithmetic.subtract(uv, given.numbers("uvoffset", (0.0, 0.0)))
    uv = arithmetic.divide(uv, given.numbers("realworldimagesize", (1.0, 1.0)))
    return arithmetic.multiply(uv, given.numbers("realworldtilesize", (1.0, 1.0)))


def _placement(given: Arguments, pivot: tuple[float, float], order: float = 0.0) -> _Placement:
    return _Placement(
        given.numbers("pivot", pivot),
        given.numbers("scale", (1.0, 1.0)),
        given.number("rotate", 0.0),
        given.numbers("offset", (0.0, 0.0)),
        given.number("operationorder", order) < 1.0,
    )


def _placed(given: Arguments, uv: Value, how: _Placement) -> Value:
    """Coordinates after place2d."""
    arithmetic = given.context.math
    uv = arithmetic.subtract(fit(uv, 2), how.pivot)
    if how.scale_first:
        uv = _turned(given, arithmetic.divide(uv, how.scale), how.degrees)
        uv = arithmetic.subtract(uv, how.offset)
    else:
        uv = _turned(given, arithmetic.subtract(uv, how.offset), how.degrees)
        uv = arithmetic.divide(uv, how.scale)
    return arithmetic.add(uv, how.pivot)


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
