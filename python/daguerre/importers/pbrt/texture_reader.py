"""Reads directives ``Texture`` as trees of textures.

Source: pbrt-v4's user's guide ("Textures"); pbrt-v3's guide where names differ.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from daguerre.shading.images import Images
from daguerre.shading.picture import DecodedPicture

from .description import named
from .ledger import Ledger
from .parameters import SPECTRA, Parameter
from .spectra import Spectra
from .state import Entity
from .texture_mapping import mapping_of
from .texture_nodes import Bilinear, Blend, Checkerboard, Constant, Image, Node, Product

#: Largest depth of textures within textures.
_DEEPEST = 32
#: Largest number of nodes of all trees, as textures may name a texture many times.
_MOST_NODES = 100_000
_WRAPS = ("repeat", "clamp", "black", "octahedralsphere")
_FILTERS = {"point": "nearest", "bilinear": "linear", "trilinear": "linear", "ewa": "linear"}
#: Encodings of pictures: exponents of their values, or sRGB's curve.
_LINEAR, _SRGB = 1.0, "srgb"
#: Mean values of textures that are noise in space, with negative values as black. One octave of
#: pbrt has the mean magnitude 0.2, as its ``Turbulence`` says; ``roughness`` 0.5 adds octaves.
_NOISE = {"fbm": 0.12, "wrinkled": 0.4, "windy": 0.03, "marble": 0.8, "ptex": 0.5}
#: Share of a plane that the dots of ``dots`` cover: half of all cells have a dot of radius 0.35.
_DOTS = 0.5 * np.pi * 0.35**2


class TextureReader:
    """Reads textures of a scene; each directive once.

    Args:
        images: Pictures of the scene.
        spectra: Spectra of the scene.
        version: Version of pbrt, 3 or 4.
        ledger: Counts directives.
    """

    def __init__(self, images: Images, spectra: Spectra, version: int, ledger: Ledger) -> None:
        self._images, self._spectra = images, spectra
        self._version, self._ledger = version, ledger
        self._nodes: dict[Entity, Node] = {}
        self._left = _MOST_NODES

    def node(self, owner: Entity, name: str, kind: str, default: Node, depth: int = 0) -> Node:
        """Reads a parameter that may be a texture, a color or a number.

        Args:
            owner: Directive of the parameter.
            name: Name of the parameter.
            kind: ``spectrum`` or ``float``.
            default: Value without the parameter.
            depth: Depth within other textures.

        Raises:
            InputError: The parameter or its texture is wrong.
        """
        found = owner.parameters.find(name, "texture", "float", "integer", *SPECTRA)
        if found is None:
            return default
        if found.type != "texture" and not (found.type == "float" and _is_name(found)):
            constant = self._constant(found)
            return constant if kind == "spectrum" else _grey(sum(constant.color) / 3)
        return self._named(owner, found, kind, depth)

    def _constant(self, found: Parameter) -> Constant:
        if found.type in ("float", "integer"):
            if len(found.numbers) != 1:
                found.fail(f"wanted one number, got {len(found.numbers)}")
            value = float(found.numbers[0])
            return Constant((value, value, value))
        return Constant(self._spectra.coefficient(found))

    def _named(self, owner: Entity, found: Parameter, kind: str, depth: int) -> Node:
        if len(found.values) != 1:
            found.fail(f"wanted one name of a texture, got {len(found.values)}")
        name = str(found.values[0])
        other = "float" if kind == "spectrum" else "spectrum"
        key = (kind, name) if (kind, name) in owner.textures else (other, name)
        known = {title: entity for (of, title), entity in owner.textures.items() if of == kind}
        entity = owner.textures.get(key) or named(known, name, found.place, f"{kind} texture")
        if depth >= _DEEPEST:
            found.fail(f"too many nested textures: the limit is {_DEEPEST}")
        if entity not in self._nodes:
            self._left -= 1
            self._nodes[entity] = self._read(entity, key[0], depth + 1)
            self._ledger.use(entity.place)
            self._ledger.tell_unread(entity.parameters, entity.place, entity.kind)
        return self._nodes[entity]

    def _read(self, entity: Entity, kind: str, depth: int) -> Node:
        reader = _CLASSES.get(entity.kind)
        if reader is not None:
            return reader(self, entity, kind, depth)
        if entity.kind not in _NOISE:
            known = ", ".join((*_CLASSES, *_NOISE))
            entity.place.fail(f"class: wanted {known}, got {entity.kind[:40]!r}")
        self._ledger.notes.add(f"a texture of class {entity.kind!r} shows its mean value")
        for parameter in entity.parameters.unread():
            entity.parameters.find(parameter.name)
        value = _NOISE[entity.kind]
        return Constant((value, value, value))

    def _value(self, entity: Entity, kind: str, depth: int) -> Node:
        return self.node(entity, "value", kind, _grey(1.0), depth)

    def _scale(self, entity: Entity, kind: str, depth: int) -> Node:
        first, second = ("tex", "scale") if entity.parameters.has("tex") else ("tex1", "tex2")
        factor = self.node(
            entity, second, "float" if second == "scale" else kind, _grey(1.0), depth
        )
        return _product(self.node(entity, first, kind, _grey(1.0), depth), factor)

    def _mix(self, entity: Entity, kind: str, depth: int) -> Node:
        first = self.node(entity, "tex1", kind, _grey(0.0), depth)
        second = self.node(entity, "tex2", kind, _grey(1.0), depth)
        return _blend(first, second, self.node(entity, "amount", "float", _grey(0.5), depth))

    def _direction_mix(self, entity: Entity, kind: str, depth: int) -> Node:
        self._ledger.notes.add(
            "a texture of class 'directionmix' mixes its two textures equally everywhere"
        )
        entity.parameters.find("dir")
        return self._mix(entity, kind, depth)

    def _checkerboard(self, entity: Entity, kind: str, depth: int) -> Node:
        first = self.node(entity, "tex1", kind, _grey(1.0), depth)
        second = self.node(entity, "tex2", kind, _grey(0.0), depth)
        entity.parameters.find("aamode")
        if entity.parameters.integer("dimension", 2, 2, 3) == 3:
            self._ledger.notes.add("a 3D checkerboard shows its mean value")
            return _blend(first, second, _grey(0.5))
        return Checkerboard(mapping_of(entity, self._version), first, second)

    def _dots(self, entity: Entity, kind: str, depth: int) -> Node:
        self._ledger.notes.add("a texture of class 'dots' shows its mean value")
        mapping_of(entity, self._version)
        inside = self.node(entity, "inside", kind, _grey(1.0), depth)
        outside = self.node(entity, "outside", kind, _grey(0.0), depth)
        return _blend(outside, inside, _grey(_DOTS))

    def _bilerp(self, entity: Entity, kind: str, depth: int) -> Node:
        colors = []
        for name, default in (("v00", 0.0), ("v10", 0.0), ("v01", 1.0), ("v11", 1.0)):
            corner = self.node(entity, name, kind, _grey(default), depth)
            if not isinstance(corner, Constant):
                entity.place.fail(f"{name}: wanted a color, got a texture")
            colors.append(corner.color)
        return Bilinear(mapping_of(entity, self._version), tuple(colors))

    def _uv(self, entity: Entity, kind: str, depth: int) -> Node:
        del kind, depth
        corners = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0))
        return Bilinear(mapping_of(entity, self._version), corners)

    def _image(self, entity: Entity, kind: str, depth: int) -> Node:
        del depth
        name = entity.parameters.text("filename")
        if not name:
            entity.place.fail("filename: missing")
        picture = self._images.picture(str(entity.place), name, is_data=kind == "float")
        image = self._pictured(entity, kind, name, picture)
        return _grey(0.5) if picture is None else image

    def _pictured(
        self, entity: Entity, kind: str, name: str, picture: DecodedPicture | None
    ) -> Image:
        parameters = entity.parameters
        wrap = parameters.text("wrap", "repeat")
        if wrap not in _WRAPS:
            entity.place.fail(f"wrap: wanted {', '.join(_WRAPS)}, got {wrap[:40]!r}")
        for unused in ("maxanisotropy", "trilinear"):
            parameters.find(unused)
        chosen = parameters.text("filter", "bilinear").lower()
        if chosen not in _FILTERS:
            entity.place.fail(f"filter: wanted {', '.join(_FILTERS)}, got {chosen[:40]!r}")
        pixels = np.zeros((1, 1, 1), np.uint8) if picture is None else picture.pixels
        return Image(
            pixels,
            self._curve(entity, name, pixels.dtype == np.uint8),
            mapping_of(entity, self._version),
            "clamp" if wrap == "octahedralsphere" else wrap,
            _FILTERS[chosen],
            parameters.number("scale", 1.0, 0.0),
            parameters.flag("invert", False),
            kind == "float",
            name,
        )

    def _curve(self, entity: Entity, name: str, is_bytes: bool) -> str | float:
        """Curve of a picture's values. pbrt chooses it for PNG alone; light is linear."""
        parameters, suffix = entity.parameters, name.lower().rsplit(".", 1)[-1]
        is_light = suffix in ("exr", "hdr", "pfm")
        if self._version == 3 or parameters.has("gamma"):
            encoded = parameters.flag("gamma", suffix in ("png", "tga"))
            return _SRGB if encoded and not is_light else _LINEAR
        chosen = parameters.text("encoding", _SRGB).strip().lower()
        if suffix != "png":
            return _SRGB if is_bytes and not is_light else _LINEAR
        if chosen in (_SRGB, "linear"):
            return _SRGB if chosen == _SRGB else _LINEAR
        words = chosen.split()
        try:
            exponent = float(words[1]) if words[0] == "gamma" and len(words) == 2 else 0.0
        except ValueError:
            exponent = 0.0
        if not 0.1 <= exponent <= 10:
            entity.place.fail(f"encoding: wanted srgb, linear or 'gamma 2.2', got {chosen[:40]!r}")
        return exponent


_TextureFunction = Callable[[TextureReader, Entity, str, int], Node]
_CLASSES: dict[str, _TextureFunction] = {
    "constant": TextureReader._value,
    "scale": TextureReader._scale,
    "mix": TextureReader._mix,
    "directionmix": TextureReader._direction_mix,
    "checkerboard": TextureReader._checkerboard,
    "dots": TextureReader._dots,
    "bilerp": TextureReader._bilerp,
    "uv": TextureReader._uv,
    "imagemap": TextureReader._image,
}


def _is_name(parameter: Parameter) -> bool:
    """Whether a number is given by the name of a texture, as pbrt-v2 wrote it."""
    return not isinstance(parameter.values, np.ndarray)


def _grey(value: float) -> Constant:
    return Constant((float(value), float(value), float(value)))


def _product(first: Node, second: Node) -> Node:
    """Product of two textures; a picture times a number stays a picture."""
    if isinstance(first, Constant) and isinstance(second, Constant):
        red, green, blue = (a * b for a, b in zip(first.color, second.color, strict=True))
        return Constant((red, green, blue))
    return Product(first, second)


def _blend(first: Node, second: Node, amount: Node) -> Node:
    if all(isinstance(node, Constant) for node in (first, second, amount)):
        a, b, share = (
            np.array(node.color) for node in (first, second, amount) if isinstance(node, Constant)
        )
        red, green, blue = (float(value) for value in a + (b - a) * share)
        return Constant((red, green, blue))
    return Blend(first, second, amount)
