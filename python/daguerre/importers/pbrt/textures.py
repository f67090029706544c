"""Textures of materials: colors and numbers, each with an optional slot of a picture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.errors import InputError
from daguerre.scene.materials import TextureSlot
from daguerre.shading.images import Images

from .bump import normal_map
from .ledger import Ledger
from .spectra import Color
from .state import Entity
from .texture_bake import Baked, baked, mean
from .texture_mapping import Mapping, SpaceMapping, UvMapping
from .texture_nodes import Constant, Image, Node, Product
from .texture_reader import TextureReader

Array = NDArray[np.float32]
Curve = Callable[[Array], Array]


@dataclass(frozen=True)
class Shade:
    """A color: a factor on an optional picture.

    Attributes:
        color: Factor, or the whole color.
        slot: Slot of the picture.
    """

    color: Color
    slot: TextureSlot | None = None

    @property
    def number(self) -> float:
        """The factor of a number: its three components are equal."""
        return self.color[0]


class Textures:
    """Makes slots of textures.

    Args:
        images: Pictures of the scene, which also keeps the textures that are made.
        reader: Reads trees of textures.
        ledger: Counts directives.
    """

    def __init__(self, images: Images, reader: TextureReader, ledger: Ledger) -> None:
        self._images, self._reader, self._ledger = images, reader, ledger
        self._baked: dict[tuple[Node, object], Baked] = {}
        self._left = 2 << 30
        #: mapping of set 1 of the material that is being read
        self.space: SpaceMapping | None = None

    def color(self, entity: Entity, name: str, default: Color, most: float = 1.0) -> Shade:
        """Reads a color of a surface; its numbers are cut at ``most``."""
        node = self._reader.node(entity, name, "spectrum", Constant(default))
        if isinstance(node, Constant):
            red, green, blue = (min(max(value, 0.0), most) for value in node.color)
            return Shade((red, green, blue))
        return self._slotted(entity, node, None)

    def number(
        self,
        entity: Entity,
        name: str,
        default: float,
        curve: Curve | None = None,
        key: object = None,
    ) -> Shade:
        """Reads a number.

        Args:
            entity: Directive.
            name: Name of the parameter.
            default: Value without the parameter.
            curve: Function of all values, before a picture is made.
            key: Content of that function.
        """
        node = self._reader.node(entity, name, "float", Constant((default, default, default)))
        if isinstance(node, Constant):
            value = np.array([node.color[0]], np.float32)
            number = node.color[0] if curve is None else float(curve(value)[0])
            return Shade((number, number, number))
        return self._slotted(entity, node, curve, key)

    def has(self, entity: Entity, name: str) -> bool:
        """Whether a parameter is given."""
        return entity.parameters.has(name)

    def picture(self, place: str, name: str, *, srgb: bool = True) -> int | None:
        """Adds a picture as it is; None, and a note: its file is missing.

        Args:
            place: Place of the directive that names it.
            name: Name of the file.
            srgb: Whether bytes are encoded by sRGB's curve.
        """
        found = self._images.picture(place, name, is_data=not srgb)
        if found is None:
            return None
        encoded = srgb and found.pixels.dtype == np.uint8
        return self._images.texture(
            found.pixels, srgb=encoded, wrap=("repeat", "repeat"), filter="linear", name=name
        )

    def bump(self, entity: Entity, name: str) -> TextureSlot | None:
        """Reads heights as a slot of a normal map in texture coordinates; None: there are none."""
        node = self._reader.node(entity, name, "float", Constant((0.0, 0.0, 0.0)))
        if isinstance(node, Constant):
            return None
        found = self._once(entity, node, None, None)
        if not isinstance(found.mapping, UvMapping) or 0 in found.mapping.scale:
            self._ledger.notes.add("a bump without texture coordinates is left out")
            return None
        across, down = (found.period / scale for scale in found.mapping.scale)
        repeats = found.wrap == "repeat"
        pixels = normal_map(found.pixels[..., 0], (across, down), repeats=repeats)
        index = self._images.texture(
            pixels, srgb=False, wrap=(found.wrap, found.wrap), filter="linear", name="bump"
        )
        return TextureSlot(index, 0, found.mapping.transform(found.period))

    def mean(self, entity: Entity, name: str, default: float) -> float:
        """Reads a number; a texture is replaced by its mean."""
        node = self._reader.node(entity, name, "float", Constant((default, default, default)))
        if not isinstance(node, Constant):
            self._ledger.notes.add(f"a texture of {name!r} is replaced by its mean")
        return mean(node)[0]

    def _slotted(
        self, entity: Entity, node: Node, curve: Curve | None, key: object = None
    ) -> Shade:
        factor, image = _plain(node)
        if image is not None and curve is None and self._slots_in(image.mapping):
            index = self._images.texture(
                image.pixels,
                srgb=image.curve == "srgb",
                wrap=(image.wrap, image.wrap),
                filter=image.filter,
                name=image.name,
            )
            return Shade(factor, self._slot(index, image.mapping, 1.0))
        found = self._once(entity, node, curve, key)
        if not self._slots_in(found.mapping):
            self._ledger.notes.add("a second 3D mapping in one material shows its mean value")
            red, green, blue = found.pixels.reshape(-1, 3).mean(axis=0).tolist()
            return Shade((red, green, blue))
        index = self._images.texture(
            found.pixels,
            srgb=False,
            wrap=(found.wrap, found.wrap),
            filter=found.filter,
            name="baked",
        )
        return Shade((1.0, 1.0, 1.0), self._slot(index, found.mapping, found.period))

    def _once(self, entity: Entity, node: Node, curve: Curve | None, key: object) -> Baked:
        found = self._baked.get((node, key))
        if found is None:
            found = self._baked[(node, key)] = baked(node, curve, self._ledger.notes)
            self._left -= found.pixels.nbytes
            if self._left < 0:
                raise InputError(f"{entity.place}: wanted at most 2 GiB of combined textures")
        return found

    def _slots_in(self, mapping: Mapping) -> bool:
        """Whether the mesh has texture coordinates for a mapping."""
        return isinstance(mapping, UvMapping) or self.space in (None, mapping)

    def _slot(self, index: int, mapping: Mapping, period: float) -> TextureSlot:
        """Texture with the texture coordinates and the transform of a mapping."""
        if isinstance(mapping, UvMapping):
            return TextureSlot(index, 0, mapping.transform(period))
        self.space = mapping
        return TextureSlot(index, 1, UvMapping().transform(period))


def _plain(node: Node) -> tuple[Color, Image | None]:
    """Factor and picture of a tree that is only a picture times numbers; else no picture."""
    factor = np.ones(3)
    while isinstance(node, Product):
        if isinstance(node.second, Constant):
            factor, node = factor * node.second.color, node.first
        elif isinstance(node.first, Constant):
            factor, node = factor * node.first.color, node.second
        else:
            break
    if not isinstance(node, Image) or not node.is_plain:
        return (1.0, 1.0, 1.0), None
    red, green, blue = (factor * node.scale).tolist()
    return (red, green, blue), node
