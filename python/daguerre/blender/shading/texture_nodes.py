"""Nodes of pictures and of coordinates.

Source: Blender 5.0 Manual, "Texture Nodes", "Input Nodes" and "Vector Nodes".
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from daguerre.color import srgb
from daguerre.color.encodings import Encoding
from daguerre.shading.bake import Canvas
from daguerre.shading.channels import (
    Channel,
    Coordinate,
    Texel,
    Value,
    VertexColor,
    coordinates,
    fit,
)
from daguerre.shading.evaluate import Arguments, known_encoding
from daguerre.shading.lookup import looked_up
from daguerre.shading.materialx.graph import Constant
from daguerre.shading.texture_nodes import file_of, sampled

from .outputs import Outputs
from .sockets import Sockets

Matrix = NDArray[np.float64]
#: Name of the texture coordinates, or colours, that are active for rendering; no layer has it.
ACTIVE = "\n"
_WRAPS = {"REPEAT": "repeat", "EXTEND": "clamp", "CLIP": "black", "MIRROR": "mirror"}
_SRGB = Encoding(srgb=True)
#: Colour of a texture that is missing.
_MISSING: Value = (1.0, 0.0, 1.0)


def image(given: Arguments) -> Mapping[str, Value]:
    """Image Texture: colour and opacity."""
    sockets = Sockets(given)
    if sockets.text("projection", "FLAT") != "FLAT":
        sockets.note(f"projection {sockets.text('projection')} is read as FLAT")
    path = file_of(given.node)
    if path is None:
        return {"Color": (0.0, 0.0, 0.0), "Alpha": (0.0,)}
    picture = given.context.images.picture(given.node.place, path)
    if picture is None:
        return {"Color": _MISSING, "Alpha": (1.0,)}
    uv = sockets.linked("Vector") or coordinates(ACTIVE)
    wrap = _WRAPS.get(sockets.text("extension"), "repeat")
    filter = "nearest" if sockets.text("interpolation") == "Closest" else "linear"
    encoding = _encoding(given, picture)
    moved = _is_computed(sockets, uv)
    at = coordinates(ACTIVE) if moved else uv
    found = sampled(given, at, (wrap, wrap), filter, encoding, (0.0,) * 4)
    assert found is not None  # the picture is there
    if moved:
        found = tuple(_looked_up(sockets, channel, fit(uv, 2)) for channel in found)
    color, alpha = found[:3], found[3:]
    mode = sockets.text("alpha")
    if mode == "NONE":
        alpha = (1.0,)
    elif mode != "CHANNEL_PACKED" and not sockets.flag("uses_alpha") and alpha != (1.0,):
        color = _over_black(sockets, color, alpha, encoded=encoding == _SRGB)
    return {"Color": color, "Alpha": alpha}


def _is_computed(sockets: Sockets, uv: Value) -> bool:
    """Whether coordinates are known for each texel only."""
    pair = fit(uv, 2)
    if any(isinstance(channel, Texel) for channel in pair):
        return True
    maps = {channel.primvar for channel in pair if isinstance(channel, Coordinate)}
    return len(maps) > 1 and sockets.math.baker.canvas is not None


def _looked_up(sockets: Sockets, channel: Channel, uv: Value) -> Channel:
    """Channel of a picture at coordinates that differ from texel to texel."""
    if not isinstance(channel, Texel):
        return channel
    baker = sockets.math.baker
    if baker.canvas is not None:
        height, width = channel.plane.pixels.shape
        size = (float(width), float(height))
        baker.canvas.measure(sockets.math.multiply(uv, size), 1.0)
    return baker.combined(partial(looked_up, channel), *uv)


def _over_black(sockets: Sockets, color: Value, alpha: Value, *, encoded: bool) -> Value:
    """Colour times opacity, where nothing reads the opacity; in sRGB the product of the bytes."""
    if not encoded:
        return sockets.math.multiply(color, alpha)
    return sockets.math.each(
        lambda c, a: srgb.to_linear(srgb.from_linear(np.asarray(c)) * a), color, alpha
    )


def _encoding(given: Arguments, picture: Any) -> Encoding:
    """Encoding of a picture; Blender gives light in place of the numbers of a float file."""
    if picture.pixels.dtype != np.uint8 and not picture.tiled:
        return Encoding()
    file = given.node.inputs["file"]
    space = file.space if isinstance(file, Constant) else ""
    return known_encoding(space, given.context.notes)


def texture_coordinates(given: Arguments) -> Mapping[str, Value]:
    """Texture Coordinate: UV; Generated and Object where a canvas knows them; else stand-ins."""
    sockets = Sockets(given)
    uv = (*coordinates(ACTIVE), 0.0)

    def stand_in(name: str) -> Value:
        sockets.note(f"{name!r} coordinates are read as 'UV'")
        return uv

    def known(name: str) -> Value:
        canvas = sockets.math.baker.canvas
        found = None if canvas is None else _on_canvas(sockets, canvas, name)
        return stand_in(name) if found is None else found

    others = ("Normal", "Camera", "Window", "Reflection")
    makers = {name: partial(stand_in, name) for name in others}
    makers |= {name: partial(known, name) for name in ("Generated", "Object")}
    return Outputs({**makers, "UV": lambda: uv})


def _on_canvas(sockets: Sockets, canvas: Canvas, name: str) -> Value | None:
    """Coordinates at the texels of a canvas; another object's are computed from the world."""
    place = sockets.given.node.inputs.get(".object_matrix")
    if name != "Object" or not isinstance(place, Constant) or not isinstance(place.value, tuple):
        return canvas.vector(name)
    found = canvas.vector("Position")
    world = np.array(place.value, np.float64).reshape(4, 4)
    if found is None or not abs(np.linalg.det(world)) > 0:
        return None
    local: Matrix = np.asarray(np.linalg.inv(world), np.float64)
    turned = _turned(sockets, found, local[:3, :3])
    return sockets.math.add(turned, tuple(float(one) for one in local[:3, 3]))


def geometry(given: Arguments) -> Mapping[str, Value]:
    """Geometry: the position, where a canvas knows it."""
    sockets = Sockets(given)

    def position() -> Value:
        canvas = sockets.math.baker.canvas
        found = None if canvas is None else canvas.vector("Position")
        return unknown("Position") if found is None else found

    def unknown(name: str) -> Value:
        sockets.note(f"{name!r} is not supported")
        raise KeyError(name)

    shape = ("Normal", "Tangent", "True Normal", "Incoming")
    rest = ("Parametric", "Backfacing", "Pointiness", "Random Per Island")
    makers = {name: partial(unknown, name) for name in (*shape, *rest)}
    return Outputs({**makers, "Position": position})


def uv_map(given: Arguments) -> Value:
    """UV Map: a layer of texture coordinates."""
    return (*coordinates(given.text(".uv_map") or ACTIVE), 0.0)


def color_attribute(given: Arguments) -> Mapping[str, Value]:
    """Color Attribute, and Attribute of a geometry: colours of the vertices."""
    sockets = Sockets(given)
    name = sockets.text("layer_name") or sockets.text("attribute_name")
    where = sockets.text("attribute_type", "GEOMETRY")
    if where != "GEOMETRY":
        sockets.note(f"attributes of {where.lower()} are black")
        black: Value = (0.0, 0.0, 0.0)
        return {"Color": black, "Vector": black, "Fac": (0.0,), "Alpha": (0.0,)}
    color: Value = tuple(VertexColor(name or ACTIVE, i) for i in range(3))
    alpha: Value = (VertexColor(name or ACTIVE, 3),)
    return {"Color": color, "Vector": color, "Fac": color[:1], "Alpha": alpha}


def mapping(given: Arguments) -> Value:
    """Mapping: scales, turns about x, y, then z, and shifts; textures the reverse."""
    sockets = Sockets(given)
    kind = sockets.text("vector_type", "POINT")
    scale = sockets.numbers("Scale")
    turn = _rotation(sockets.numbers("Rotation"))
    shift = sockets.numbers("Location") if kind in ("POINT", "TEXTURE") else (0.0,) * 3
    vector = sockets.linked("Vector") or sockets.value("Vector")
    arithmetic = sockets.math
    if kind == "TEXTURE":
        vector = _turned(sockets, arithmetic.subtract(fit(vector, 3), shift), turn.T)
        return arithmetic.divide(vector, scale)
    if kind == "NORMAL":
        scale = tuple(1 / n if n else 0.0 for n in scale)
    vector = _turned(sockets, arithmetic.multiply(fit(vector, 3), scale), turn)
    if kind == "NORMAL":
        length = arithmetic.each(np.sqrt, arithmetic.dot(vector, vector))
        return arithmetic.divide(vector, length)
    return arithmetic.add(vector, shift)


def _rotation(angles: tuple[float, ...]) -> Matrix:
    """Rotation about x, then y, then z."""
    (cx, sx), (cy, sy), (cz, sz) = ((math.cos(a), math.sin(a)) for a in angles)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def _turned(sockets: Sockets, vector: Value, matrix: Matrix) -> Value:
    arithmetic = sockets.math
    rows: list[Channel] = []
    for row in matrix:
        total: Value = (0.0,)
        for channel, factor in zip(vector, row, strict=True):
            if abs(factor) > 1e-12:
                total = arithmetic.add(total, arithmetic.multiply((channel,), (float(factor),)))
        rows += total
    return tuple(rows)


def fresnel(given: Arguments) -> Value:
    """Fresnel: reflectance at normal incidence, as nothing else depends on direction."""
    sockets = Sockets(given)
    sockets.note("the value at normal incidence is used")
    return sockets.math.each(lambda n: ((n - 1) / (n + 1)) ** 2, sockets.one("IOR"))


def layer_weight(given: Arguments) -> Mapping[str, Value]:
    """Layer Weight: values at normal incidence; the index of refraction is 1 / (1 - blend)."""
    sockets = Sockets(given)
    sockets.note("the value at normal incidence is used")
    blend = sockets.math.clamp(sockets.one("Blend"), (0.0,), (1 - 1e-5,))
    found = sockets.math.each(lambda b: (b / (2 - b)) ** 2, blend)
    return {"Fresnel": found, "Facing": (0.0,)}
