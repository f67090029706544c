"""Textures: bitmaps, checkerboards and attributes of meshes, as channels of ``shading``.

Texture coordinates (0, 0) are the top left of a bitmap in Mitsuba, as here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from daguerre.checks import freeze_in_place
from daguerre.scene.materials import Color, TextureSlot
from daguerre.scene.spectrum import Spectrum
from daguerre.shading.bake import Baker
from daguerre.shading.channels import (
    Channel,
    Mapping,
    Plane,
    Six,
    Texel,
    Value,
    broadcast,
    scaled,
    texels,
)
from daguerre.shading.images import Images
from daguerre.shading.textures import Packer, top_down

from .context import Context
from .node import Node, Property, leave_out
from .spectra import LUMINANCE, PLUGINS, Spectra, luminance, reflected_rgb
from .transforms import uv_part

UV = "uv"
_WRAPS = ("repeat", "mirror", "clamp")
#: Formats with linear values; other formats are encoded as sRGB.
_LINEAR = (".exr", ".hdr", ".rgbe", ".pfm")


@dataclass(frozen=True)
class Painted:
    """Colours of a mesh by the name of their attribute, and factors on them."""

    attribute: str
    factors: Color


class Textures:
    """Textures and colours of a scene file.

    Args:
        context: File, scene and notes.
    """

    def __init__(self, context: Context) -> None:
        self._document, self._notes = context.document, context.notes
        scene, notes = context.scene, context.notes
        self.images = Images(scene, lambda place, path: Path(path), notes)
        self.baker = Baker(notes)
        self.packer = Packer(self.images, self.baker, (UV,))
        self._known: dict[int, Value | None] = {}
        self._checkers: dict[tuple[float, ...], NDArray[np.float32]] = {}

    # Questions of materials -----------------------------------------------------------------------

    def tint(
        self,
        node: Node,
        name: str,
        default: Color | float,
        most: float = 1.0,
    ) -> tuple[Color | Spectrum, TextureSlot | None]:
        """Colour or spectrum of a property, and a texture of factors on it.

        Args:
            node: Element with the property.
            name: Name of the property.
            default: Colour where it has none.
            most: Most that a texture of factors holds.
        """
        found = node.find(name)
        if found is None or not self._is_texture(found):
            color = self._color(node, found, default)
            if most == 1.0:
                color = self._at_most_1(node, color)
            return color, None
        value = self._texture(found)
        if value is None:
            return _triple(default), None
        value = broadcast(value, 3)
        packed = self.packer.packed(value, most=most)
        r, g, b = packed.factors
        return (r, g, b), packed.slot

    def channels(self, node: Node, name: str, default: Color | float) -> Value:
        """Three channels of a property."""
        found = node.find(name)
        if found is None or not self._is_texture(found):
            return reflected_rgb(self._color(node, found, default))
        value = self._texture(found)
        return broadcast(value, 3) if value is not None else _triple(default)

    def channel(self, node: Node, name: str, default: float) -> Channel:
        """One channel of a property; of colours their luminance."""
        found = node.find(name)
        if found is None or not self._is_texture(found):
            return luminance(reflected_rgb(self._color(node, found, default)))
        value = self._texture(found)
        if value is not None and found.value.plugin == "checkerboard":
            value = _swapped(value)
        return default if value is None else self.grey(value)

    def scalar(
        self, node: Node, name: str, default: float, place: int = 0
    ) -> tuple[float, TextureSlot | None]:
        """Number of a property, and a texture of factors on it in one of its channels."""
        packed = self.packer.packed((self.channel(node, name, default),), places=(place,))
        return packed.factors[0], packed.slot

    def color(self, node: Node, name: str, default: Color | float) -> Color | Spectrum:
        """Colour or spectrum of a property; of a texture the mean, with a note."""
        found = node.find(name)
        if found is None or not self._is_texture(found):
            return self._color(node, found, default)
        value = self._texture(found)
        if value is None:
            return _triple(default)
        if texels(value):
            what = f"the mean of the texture in {name!r} is used"
            self._notes.add(f"{node.kind} {node.plugin!r}: {what}")
        return _means(broadcast(value, 3))

    def share(self, node: Node, name: str, default: Color | float) -> Color | Spectrum:
        """Share of light, as ``color``: of more than 1 it is 1, with a note."""
        return self._at_most_1(node, self.color(node, name, default))

    def _at_most_1(self, node: Node, color: Color | Spectrum) -> Color | Spectrum:
        values = np.asarray(color.values if isinstance(color, Spectrum) else color)
        if values.max() <= 1:
            return color
        self._notes.add(f"{node.kind} {node.plugin!r}: values above 1 are read as 1")
        return _capped(color)

    def painted(self, node: Node, name: str) -> Painted | None:
        """Colours of the mesh in a property; None: another value."""
        found = node.find(name)
        value = None if found is None else found.value
        if found is None or not isinstance(value, Node) or value.plugin != "mesh_attribute":
            return None
        found.take()
        value.use()
        scale = value.number("scale", 1.0, 0.0)
        return Painted(value.text("name"), (scale, scale, scale))

    def grey(self, value: Value) -> Channel:
        """Luminance of channels."""
        if len(value) == 1:
            return value[0]
        x, y, z = (np.float64(weight) for weight in LUMINANCE)
        return self.baker.combined(lambda r, g, b: x * r + y * g + z * b, *value[:3])

    def texture_of(self, node: Node) -> Value | None:
        """Channels of a texture; None, and a note: it is not supported."""
        if id(node) not in self._known:
            self._known[id(node)] = self._read(node)
        return self._known[id(node)]

    # ----------------------------------------------------------------------------------------------

    def _color(
        self, node: Node, found: Property | None, default: Color | float
    ) -> Color | Spectrum:
        if found is None:
            return _triple(default)
        value = self.spectra(found.value if found.tag == "object" else node).value(found)
        return _triple(default) if value is None else value

    def spectra(self, node: Node) -> Spectra:
        """Reader of spectra in files that an object names."""
        return Spectra(self._document.files_of(node).read, self._notes)

    def _is_texture(self, found: Property) -> bool:
        return isinstance(found.value, Node) and found.value.plugin not in PLUGINS

    def _texture(self, found: Property) -> Value | None:
        found.take()
        return self.texture_of(found.value)

    def _read(self, node: Node) -> Value | None:
        read = {
            "bitmap": self._bitmap,
            "checkerboard": self._checkerboard,
            "scale": self._scale,
        }.get(node.plugin)
        if read is None:
            leave_out(node, self._notes, f"a texture {node.plugin!r} is replaced by a default")
            return None
        node.use()
        return read(node)

    def _bitmap(self, node: Node) -> Value | None:
        name = node.text("filename")
        entry = node.entry
        raw = node.flag("raw", False)
        if node.has("gamma"):  # of Mitsuba 0.6: 1 is linear, -1 automatic
            raw = node.number("gamma", -1.0) == 1.0 or raw
        node.skip("format", "accel", "max_anisotropy", "cache")
        filter_ = node.choice("filter_type", "bilinear", (*_FILTERS,))
        wrap = node.choice("wrap_mode", "repeat", _WRAPS)
        files = self._document.files_of(node)
        file = files.find(name, entry) or files.first(name, entry)
        picture = self.images.picture(str(entry), str(file), is_data=raw)
        if picture is None:
            return None
        encoded = not raw and file.suffix.lower() not in _LINEAR
        red, green, blue, _ = picture.planes(srgb=encoded)
        planes = (red, green, blue) if picture.pixels.shape[2] > 2 else (red,)
        mapping = Mapping(UV, _mapped(node), (wrap, wrap), _FILTERS[filter_])
        return tuple(Texel(plane, mapping) for plane in planes)

    def _checkerboard(self, node: Node) -> Value:
        """Two by two texels, the first color on top left and bottom right."""
        first, second = (
            reflected_rgb(self.color(node, name, default))
            for name, default in (("color0", 0.4), ("color1", 0.2))
        )
        mapping = Mapping(UV, _mapped(node), ("repeat", "repeat"), "nearest")
        return tuple(
            Texel(Plane(self._checker(a, b), name="checkerboard"), mapping)
            for a, b in zip(first, second, strict=True)
        )

    def _checker(self, a: float, b: float) -> NDArray[np.float32]:
        if (a, b) not in self._checkers:
            self._checkers[a, b] = freeze_in_place(np.array([[a, b], [b, a]], np.float32))
        return self._checkers[a, b]

    def _scale(self, node: Node) -> Value | None:
        """Texture times a colour (Mitsuba 0.6)."""
        nested = node.nested_one("texture")
        if nested is None:
            node.fail("needs a texture inside")
        value = self.texture_of(nested)
        factors = reflected_rgb(self.color(node, "scale", 1.0))
        if value is None:
            return None
        if len(set(factors)) == 1:
            return tuple(scaled(channel, factors[0]) for channel in value)
        return tuple(scaled(c, f) for c, f in zip(broadcast(value, 3), factors, strict=True))


#: Filters of Mitsuba, 0.6 among them, and ours.
_FILTERS = {"bilinear": "linear", "nearest": "nearest", "trilinear": "linear", "ewa": "linear"}


def _mapped(node: Node) -> tuple[float, float, float, float, float, float]:
    """Transform of texture coordinates from the bottom left."""
    return top_down(uv_part(node.transform("to_uv")))


def _swapped(value: Value) -> Value:
    """A checkerboard with exchanged colours, as in Mitsuba 3.9's scalar parameters."""
    return tuple(
        replace(c, mapping=replace(c.mapping, transform=_shifted(c.mapping.transform)))
        if isinstance(c, Texel)
        else c
        for c in value
    )


def _shifted(six: Six) -> Six:
    """Transform that moves u by half a period."""
    a, b, c, d, e, f = six
    return a, b, c + 0.5, d, e, f


def _capped(color: Color | Spectrum) -> Color | Spectrum:
    """A share of light, at most 1."""
    if isinstance(color, Spectrum):
        return Spectrum(color.wavelengths_nm, tuple(np.minimum(color.values, 1.0).tolist()))
    r, g, b = np.minimum(color, 1.0).tolist()
    return r, g, b


def _triple(value: Color | float) -> Color:
    return value if isinstance(value, tuple) else (value, value, value)


def _means(value: Value) -> Color:
    r, g, b = (c.mean() if isinstance(c, Texel) else _number(c) for c in value)
    return r, g, b


def _number(channel: Channel) -> float:
    return channel if isinstance(channel, float) else 1.0
