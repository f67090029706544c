"""Appearance of a surface of Mitsuba, before a shape makes a material of it."""

from __future__ import annotations

from dataclasses import dataclass, field

from daguerre.io.shading.channels import Channel, Value
from daguerre.scene.materials import Diffuse, Kind, TextureSlot


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
class Look:
    """Appearance of a surface.

    Attributes:
        kind: Kind of the material.
        two_sided: Whether it is seen from behind, too; others are black there.
        opacity: Share of the surface that is there, a factor on a texture.
        opacity_texture: Texture of opacity.
        relief: Normal map or bump map.
        attribute: Attribute of the mesh whose colours are factors on the kind's, or empty.
    """

    kind: Kind = field(default_factory=Diffuse)
    two_sided: bool = False
    opacity: float = 1.0
    opacity_texture: TextureSlot | None = None
    relief: Relief | None = None
    attribute: str = ""


@dataclass(frozen=True)
class Chart:
    """How texture coordinates lie on a mesh in the world.

    Attributes:
        right_handed: Whether v runs along normal x u, as on a rectangle; else against it, as in
            most files.
        lengths: Lengths of a unit of u and v, m: means over the mesh.
    """

    right_handed: bool = False
    lengths: tuple[float, float] = (1.0, 1.0)
