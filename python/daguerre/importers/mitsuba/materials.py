"""Materials: a look, its emission, and the media on its sides.

Adapters, materials around other materials, are here: ``twosided``, ``mask``, ``normalmap``,
``bumpmap`` and ``blendbsdf``. Unsupported materials are grey, with a note.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from daguerre.scene.materials import LITERAL, Color, Diffuse, Gltf, Material, Mix, TextureSlot
from daguerre.scene.media import Medium
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.channels import UnsupportedError, fit

from .bsdfs import Surfaces
from .context import Context
from .look import Appearance, Blend, Chart, Relief
from .node import Node, leave_out
from .relief import normal_map
from .textures import Textures


@dataclass(frozen=True)
class Glow:
    """Light from a surface: radiance, cd/m2, and a texture of factors on it."""

    radiance: Color = (0.0, 0.0, 0.0)
    texture: TextureSlot | None = None


@dataclass(frozen=True)
class Sides:
    """Media inside and outside of a closed surface."""

    interior: Medium | None = None
    exterior: Medium | None = None


#: Looks of shapes without a material: lamps reflect nothing.
_GREY, _BLACK = Appearance(), Appearance(Diffuse((0.0, 0.0, 0.0)), two_sided=True)


class Materials:
    """Materials of a scene file; each is added once.

    Args:
        context: Scene and notes.
        textures: Reads textures and colours.
    """

    def __init__(self, context: Context, textures: Textures) -> None:
        self._scene, self._textures, self._notes = context.scene, textures, context.notes
        self._surfaces = Surfaces(textures, context.notes)
        self._looks: dict[int, Appearance] = {}
        self._known: dict[Any, int] = {}

    def index(
        self, bsdf: Node | None, chart: Chart, glow: Glow, sides: Sides, *, emits: bool = False
    ) -> int:
        """Index of the material of a shape; without a BSDF it is grey, or black if it ``emits``."""
        usual = _BLACK if emits else _GREY
        look = usual if bsdf is None else self.look(bsdf)
        return self._index(look, chart, glow, sides)

    def _index(self, look: Appearance, chart: Chart, glow: Glow, sides: Sides) -> int:
        if all(relief.heights is None for relief in look.reliefs):
            chart = Chart(chart.right_handed and bool(look.reliefs))
        key = (id(look), chart, glow, id(sides.interior), id(sides.exterior))
        if key not in self._known:
            made = self._material(look, chart, glow, sides)
            self._known[key] = self._scene.add_material(made)
        return self._known[key]

    def _material(self, look: Appearance, chart: Chart, glow: Glow, sides: Sides) -> Material:
        made = Material(
            look.kind if look.blend is None else self._mix(look.blend, chart),
            look.name,
            emission=glow.radiance,
            emission_texture=glow.texture,
            opacity=look.opacity,
            opacity_texture=look.opacity_texture,
            two_sided=look.two_sided,
            interior=sides.interior,
            exterior=sides.exterior,
            nesting=LITERAL,
        )
        slot = self._normals(look, chart)
        if slot is None:
            return made
        if isinstance(look.kind, Gltf):
            return replace(made, kind=replace(look.kind, normal_texture=slot))
        return replace(made, normal_texture=slot)

    def _mix(self, blend: Blend, chart: Chart) -> Mix:
        first, second = (
            self._index(part, chart, Glow(), Sides()) for part in (blend.first, blend.second)
        )
        return Mix(first, second, min(blend.amount, 1.0), blend.amount_texture)

    def _normals(self, look: Appearance, chart: Chart) -> TextureSlot | None:
        if look.relief is None:
            return None
        made = normal_map(look.relief, chart, Arithmetic(self._textures.baker))
        return None if made is None else self._textures.packer.packed(made).slot

    def look(self, node: Node) -> Appearance:
        """Look of a material."""
        if id(node) not in self._looks:
            self._looks[id(node)] = self._read(node)
        return self._looks[id(node)]

    def _read(self, node: Node) -> Appearance:
        read = _ADAPTERS.get(node.plugin)
        try:
            look = self._surfaces.look(node) if read is None else read(self, node)
        except UnsupportedError as error:
            self._notes.add(f"a material {node.plugin!r}: {error} is not supported: it is grey")
            look = Appearance()
        if look is None:
            leave_out(node, self._notes, f"a material {node.plugin[:40]!r} is grey: not supported")
            return Appearance()
        node.use()
        return replace(look, name=node.id)

    # Adapters -------------------------------------------------------------------------------------

    def _inner(self, node: Node) -> Appearance:
        """The only material inside of another."""
        found = node.nested_one("bsdf")
        if found is None:
            node.fail("needs a material inside")
        return self.look(found)

    def _two_sided(self, node: Node) -> Appearance:
        found = node.nested("bsdf")
        if not 1 <= len(found) <= 2:
            node.fail(f"wanted one or two materials inside, got {len(found)}")
        if len(found) == 2:
            sentence = "a material with another on its back has its front on both sides"
            leave_out(found[1], self._notes, sentence)
        return replace(self.look(found[0]), two_sided=True)

    def _mask(self, node: Node) -> Appearance:
        look = self._inner(node)
        opacity, slot = self._textures.scalar(node, "opacity", 0.5)
        if look.opacity_texture is not None and slot is not None:
            self._notes.add("of a mask in a mask only the outer one is used")
        return replace(
            look, opacity=opacity * look.opacity, opacity_texture=slot or look.opacity_texture
        )

    def _normal_map(self, node: Node) -> Appearance:
        look, texture = self._inner(node), self._texture(node)
        value = None if texture is None else fit(texture, 3)
        if node.flag("use_shadowing_function", False):
            self._notes.add(
                "the shadowing function of a normal map is left out: its terminator is sharp"
            )
        return self._with(look, Relief(normals=value))

    def _bump_map(self, node: Node) -> Appearance:
        look, texture = self._inner(node), self._texture(node)
        scale = node.number("scale", 1.0)
        height = None if texture is None else self._textures.grey(texture)
        self._notes.add("a bump map is drawn as a normal map, for the mean size of its texels")
        return self._with(look, Relief(heights=height, scale=scale))

    def _texture(self, node: Node) -> Any:
        found = node.nested_one("texture")
        if found is None:
            node.fail("needs a texture inside")
        return self._textures.texture_of(found)

    def _with(self, look: Appearance, relief: Relief) -> Appearance:
        if look.reliefs:
            self._notes.add("of a bump or normal map on another only the outer one is used")
        return look.with_relief(relief)

    def _blend(self, node: Node) -> Appearance:
        found = node.nested("bsdf")
        if len(found) != 2:
            node.fail(f"wanted two materials inside, got {len(found)}")
        amount, slot = self._textures.scalar(node, "weight", 0.5)
        first, second = (self.look(bsdf) for bsdf in found)
        return Appearance(
            two_sided=first.two_sided and second.two_sided,
            blend=Blend(first, second, amount, slot),
        )


_ADAPTERS: dict[str, Callable[[Materials, Node], Appearance]] = {
    "twosided": Materials._two_sided,
    "mask": Materials._mask,
    "normalmap": Materials._normal_map,
    "bumpmap": Materials._bump_map,
    "bump": Materials._bump_map,  # Mitsuba 0.5
    "blendbsdf": Materials._blend,
}
