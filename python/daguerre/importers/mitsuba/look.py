"""Appearance of a surface of Mitsuba, before a shape makes a material of it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from daguerre.cached import cached_property
from daguerre.scene.materials import Diffuse, Kind, TextureSlot
from daguerre.shading.channels import Channel, Value


@dataclass(frozen=True)
class Relief:
    """Normals or heights in a texture.

    Attributes:
        normals: Normals, 2 x value - 1, along u, normal x u and the normal; or None.
        heights: Height in units of the scene, or None.
        scale: Factor on the slopes of heights.
    """

    normals: Value | None = None
    heights: Channel | None = None
    scale: float = 1.0


@dataclass(frozen=True)
class Blend:
    """Two looks, and the share of the second: a factor on a texture."""

    first: Appearance
    second: Appearance
    amount: float = 0.5
    amount_texture: TextureSlot | None = None


@dataclass(frozen=True)
class Appearance:
    """Appearance of a surface.

    Attributes:
        kind: Kind of the material, unless it is a blend.
        two_sided: Whether the surface is seen from behind, too; otherwise its back is black.
        opacity: Covered share of the surface, a factor on a texture.
        opacity_texture: Texture of opacity.
        relief: Normal map or bump map.
        attribute: Attribute of the mesh with colours that multiply the kind's, or empty.
        blend: Blended looks, which have their relief, or None.
        name: Name of the material.
    """

    kind: Kind = field(default_factory=Diffuse)
    two_sided: bool = False
    opacity: float = 1.0
    opacity_texture: TextureSlot | None = None
    relief: Relief | None = None
    attribute: str = ""
    blend: Blend | None = None
    name: str = ""

    @cached_property
    def reliefs(self) -> frozenset[Relief]:
        """Reliefs of the look, and of the looks that it blends."""
        parts = () if self.blend is None else (self.blend.first, self.blend.second)
        direct = frozenset(() if self.relief is None else (self.relief,))
        return direct.union(*(part.reliefs for part in parts))

    def with_relief(self, relief: Relief, made: dict[int, Appearance] | None = None) -> Appearance:
        """Returns the look with another relief; a blend hands it to its parts.

        Args:
            relief: The relief.
            made: Results by ``id`` of the original look: parts may be shared.
        """
        if self.blend is None:
            return replace(self, relief=relief)
        made = {} if made is None else made
        for part in (self.blend.first, self.blend.second):
            if id(part) not in made:
                made[id(part)] = part.with_relief(relief, made)
        first, second = made[id(self.blend.first)], made[id(self.blend.second)]
        return replace(self, blend=replace(self.blend, first=first, second=second))


@dataclass(frozen=True)
class Chart:
    """Mapping of texture coordinates on a mesh in the world.

    Attributes:
        right_handed: Whether v runs along normal x u, as on a rectangle; else against it, as in
            most files.
        lengths: Lengths of a unit of u and v, m: means over the mesh.
    """

    right_handed: bool = False
    lengths: tuple[float, float] = (1.0, 1.0)
