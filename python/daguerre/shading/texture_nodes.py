"""Nodes that read pictures: USD's and MaterialX's, with their wrapping and colour spaces.

Source: OpenUSD, "UsdPreviewSurface Specification"
(https://openusd.org/release/spec_usdpreviewsurface.html); MaterialX specification 1.39, "Texture
Nodes"; glTF nodes of MaterialX's library ``gltf_pbr``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.color.encodings import Encoding, is_data
from daguerre.shading.materialx.graph import Constant, Node

from .channels import (
    Channel,
    Coordinate,
    Plane,
    Six,
    Texel,
    UnsupportedError,
    Value,
    VertexColor,
    broadcast,
    coordinates,
    fit,
)
from .channels import (
    Mapping as Lie,
)
from .coordinate_nodes import placed_by_gltf, tiled
from .evaluate import Arguments, in_rec709, known_encoding

#: Wrapping by the names of USD and MaterialX. Pictures have no data on their wrapping that
#: "useMetadata" could use; they are repeated, as by MaterialX.
_WRAPS = {
    **{"repeat": "repeat", "periodic": "repeat", "usemetadata": "repeat"},
    **{"clamp": "clamp", "mirror": "mirror", "black": "black", "constant": "black"},
}
_FILTERS = {"closest": "nearest", "linear": "linear", "cubic": "linear"}
_SRGB = Encoding(srgb=True)
#: Names under which USD's assets spell raw and sRGB.
_USD_SPACES = {"raw": Encoding(), "srgb": _SRGB}


def file_of(node: Node) -> str | None:
    """Path of the picture of a node; None: no name."""
    file = node.inputs.get("file")
    if not isinstance(file, Constant) or not isinstance(file.value, str) or not file.value:
        return None
    return _joined(file.base, file.value) if file.base else file.value


def usd_texture(given: Arguments) -> Mapping[str, Value]:
    """UsdUVTexture: scale x picture + bias, or the fallback."""
    fallback = fit(given.value("fallback", (0.0, 0.0, 0.0, 1.0)), 4)
    st = given.given("st")
    if st is None and "st" not in given.node.inputs:
        given.context.notes.add("a texture without texture coordinates uses the primvar 'st'")
    wraps = (given.text("wrapS", "useMetadata"), given.text("wrapT", "useMetadata"))
    encoding = _usd_encoding(given)
    arithmetic = given.context.math
    scale = fit(given.value("scale", (1.0,) * 4), 4)
    bias = fit(given.value("bias", (0.0,) * 4), 4)

    def values(raw: bool) -> Value:
        uv = st or coordinates("st")
        found = sampled(given, uv, wraps, "linear", encoding, (0.0,) * 4, raw=raw)
        if found is None:
            return fallback
        return arithmetic.add(arithmetic.multiply(found, scale), bias)

    found = values(is_data(_usd_space(given)))
    r, g, b, a = values(True) if found is not fallback else fallback  # single channels are numbers
    return {"rgb": found[:3], "r": (r,), "g": (g,), "b": (b,), "a": (a,), "rgba": found}


def image(given: Arguments) -> Value:
    """MaterialX image."""
    return _image(given, given.given("texcoord") or coordinates("st"))


def tiled_image(given: Arguments) -> Value:
    """MaterialX tiledimage, which repeats its picture."""
    return _image(given, tiled(given, given.given("texcoord") or coordinates("st")))


def gltf_image(given: Arguments) -> Value:
    """MaterialX gltf_image: a picture with its placement, times a factor."""
    found = _image(given, placed_by_gltf(given))
    factor = given.given("factor")
    return found if factor is None else given.context.math.multiply(found, factor)


def gltf_color_image(given: Arguments) -> Mapping[str, Value]:
    """MaterialX gltf_colorimage: colour and opacity times ``color`` and ``geomcolor``."""
    arithmetic, white = given.context.math, (1.0,) * 4
    typed = replace(given, node=replace(given.node, type="color4"))
    found = _image(typed, placed_by_gltf(given, ordered=False))
    found = arithmetic.multiply(found, given.value("color", white))
    tint = given.value("geomcolor", white)
    if any(isinstance(channel, VertexColor) for channel in tint):
        given.context.notes.add("colours of vertices that tint a picture are left out")
    else:
        found = arithmetic.multiply(found, tint)
    return {"outcolor": found[:3], "outa": found[3:]}


def gltf_normal_map(given: Arguments) -> Value:
    """MaterialX gltf_normalmap: a picture of normals."""
    typed = replace(given, node=replace(given.node, type="vector3"))
    found = _image(typed, placed_by_gltf(given), (0.5, 0.5, 1.0))
    return decoded_normal(given, found, 1.0)


def normal_map(given: Arguments) -> Value:
    """MaterialX normalmap: 0 .. 1 to a normal in the frame of the texture coordinates."""
    scale = given.numbers("scale", (1.0, 1.0))
    if len(set(scale)) > 1:
        raise UnsupportedError("normalmap: different scales along both axes")
    return decoded_normal(given, given.value("in", (0.5, 0.5, 1.0)), scale[0])


def decoded_normal(given: Arguments, encoded: Value, scale: float) -> Value:
    """Normal from 0 .. 1, its slopes times a scale."""
    arithmetic = given.context.math
    factor, offset = (2 * scale, 2 * scale, 2.0), (-scale, -scale, -1.0)
    return arithmetic.add(arithmetic.multiply(fit(encoded, 3), factor), offset)


def _image(given: Arguments, uv: Value, plain: Value = (0.0,)) -> Value:
    size = given.size or 3
    wraps = (given.text("uaddressmode", "periodic"), given.text("vaddressmode", "periodic"))
    filter = _FILTERS.get(given.text("filtertype", "linear"), "linear")
    default = broadcast(given.value("default", plain), size)
    file = given.node.inputs.get("file")
    space = file.space if isinstance(file, Constant) else ""
    colored = given.node.type in ("color3", "color4")
    encoding = known_encoding(space, given.context.notes) if colored else Encoding()
    raw = not colored or is_data(space)
    found = sampled(given, uv, wraps, filter, encoding, fit(default, 4), raw=raw)
    return default if found is None else found[:size]


def _usd_space(given: Arguments) -> str:
    """Colour space of a USD texture by its name; empty: unnamed."""
    space = given.text("sourceColorSpace", "")
    if not space or space == "auto":
        file = given.node.inputs.get("file")
        space = file.space if isinstance(file, Constant) else ""
    return "" if space == "auto" else space


def _usd_encoding(given: Arguments) -> Encoding | None:
    """Encoding of a USD texture; None: by the kind of picture."""
    space = _usd_space(given)
    if not space:
        return None
    return _USD_SPACES.get(space.lower()) or known_encoding(space, given.context.notes)


def sampled(
    given: Arguments,
    uv: Value,
    wraps: tuple[str, str],
    filter: str,
    encoding: Encoding | None,
    outside: Value,
    *,
    raw: bool = False,
) -> Value | None:
    """Red, green, blue and opacity of the picture in ``file``; None: missing.

    Args:
        given: The node.
        uv: Texture coordinates.
        wraps: Wrapping along both.
        filter: Filter of magnification.
        encoding: Encoding that the scene names; None: by the kind of picture. Primaries that the
            file states count unless the scene names a space.
        outside: Values beyond the picture.
        raw: Whether its numbers are no colours.
    """
    context, path = given.context, file_of(given.node)
    if path is None:
        context.notes.add("a texture without a file shows its fallback value")
        return None
    named = encoding is not None and encoding != Encoding()
    picture = context.images.picture(given.node.place, path, is_data=raw or named)
    if picture is None:
        return None
    if encoding is None:  # "auto": pictures of 8 bits with colour are in sRGB
        auto = picture.pixels.dtype == np.uint8 and picture.pixels.shape[2] > 2
        encoding = _SRGB if auto else Encoding()
    r, g, b, a = picture.planes(srgb=encoding.srgb)
    how = tuple("clamp" if picture.tiled else _wrap(given, name) for name in wraps)
    primvar, transform = _affine(uv, picture.transform)
    lie = Lie(primvar, transform, (how[0], how[1]), filter)
    planes = [r, g, b] if a is None else [r, g, b, a]
    channels = [_on_surface(given, plane, lie, outside[i]) for i, plane in enumerate(planes)]
    color = in_rec709(tuple(channels[:3]), encoding, context.math)
    return (*color, 1.0 if a is None else channels[3])


def _wrap(given: Arguments, name: str) -> str:
    found = _WRAPS.get(name.lower())
    if found is None:
        given.context.notes.add(f"wrapping {name[:40]!r} of a texture is read as 'repeat'")
    return found or "repeat"


def _joined(base: str, path: str) -> str:
    """Path of a file that is named in another file; packages keep their brackets."""
    if path.startswith("/") or path[1:2] == ":":
        return path
    package, bracket, inner = base.partition("[")
    if not bracket:
        return f"{base.replace(chr(92), '/').rpartition('/')[0] or '.'}/{path}"
    folder = inner.rstrip("]").rpartition("/")[0]
    return f"{package}[{folder}/{path}]" if folder else f"{package}[{path}]"


def _affine(uv: Value, then: Six) -> tuple[str, Six]:
    """Primvar and transform of coordinates, followed by another transform.

    Raises:
        UnsupportedError: The coordinates are not affine in one primvar.
    """
    rows, primvars = [], set()
    for channel in fit(uv, 2):
        if isinstance(channel, float):
            rows.append((0.0, 0.0, channel))
        elif isinstance(channel, Coordinate):
            primvars.add(channel.primvar)
            rows.append((channel.a, channel.b, channel.c))
        else:
            raise UnsupportedError("a texture whose coordinates come from a picture")
    if len(primvars) > 1:
        raise UnsupportedError("a texture whose coordinates come from two primvars")
    (a, b, c), (d, e, f) = rows
    p, q, r, s, t, u = then
    across = (p * a + q * d, p * b + q * e, p * c + q * f + r)
    up = (s * a + t * d, s * b + t * e, s * c + t * f + u)
    return (primvars.pop() if primvars else ""), (*across, *up)


def _on_surface(given: Arguments, plane: Plane, lie: Lie, outside: Channel) -> Channel:
    """A plane with its mapping; with a border of one texel where it is not repeated."""
    if not lie.primvar:
        return _texel(plane, lie)
    axes = tuple(name == "black" for name in lie.wrap)
    if not any(axes):
        return Texel(plane, lie)
    height, width = plane.pixels.shape
    (a, b, c, d, e, f), wrap = (
        lie.transform,
        tuple("clamp" if name == "black" else name for name in lie.wrap),
    )
    if axes[0]:
        a, b, c = (n * width / (width + 2) for n in (a, b, c))
        c += 1 / (width + 2)
    if axes[1]:
        d, e, f = (n * height / (height + 2) for n in (d, e, f))
        f += 1 / (height + 2)
    border = outside if isinstance(outside, float) else 0.0
    lies = Lie(lie.primvar, (a, b, c, d, e, f), (wrap[0], wrap[1]), lie.filter)
    return Texel(_bordered(given, plane, (axes[1], axes[0]), border), lies)


def _bordered(given: Arguments, plane: Plane, axes: tuple[bool, bool], border: float) -> Plane:
    """Plane with a border of one texel on the chosen axes (rows, columns), made once."""
    cache, key = given.context.cache, ("border", plane.key, axes, border)
    if key not in cache:
        given.context.images.keep(plane.pixels if plane.source is None else plane.source)
        widths = [(int(axis), int(axis)) for axis in axes]
        exact = border == 0.0
        pixels: NDArray[np.uint8] | NDArray[np.float32]
        pixels = plane.pixels if exact else plane.linear()
        padded = np.pad(pixels, widths, constant_values=0 if exact else border)
        cache[key] = Plane(freeze_in_place(padded), plane.srgb and exact, name=plane.name)
    found = cache[key]
    assert isinstance(found, Plane)
    return found


def _texel(plane: Plane, lie: Lie) -> float:
    """Value of a picture at constant coordinates: the nearest texel."""
    height, width = plane.pixels.shape
    s, t = lie.transform[2], lie.transform[5]
    index = []
    for at, count, how in ((1.0 - t, height, lie.wrap[1]), (s, width, lie.wrap[0])):
        i = int(np.clip(np.floor(at * count), -1e9, 1e9))
        if how == "black" and not 0 <= i < count:
            return 0.0
        i = i % (2 * count) if how == "mirror" else i
        i = 2 * count - 1 - i if how == "mirror" and i >= count else i
        index.append(i % count if how == "repeat" else min(max(i, 0), count - 1))
    texel = replace(plane, pixels=plane.pixels[index[0] : index[0] + 1, index[1] : index[1] + 1])
    return float(texel.linear()[0, 0])
