"""Surfaces in terms that pbrt and Mitsuba share: the small set from which both are written.

A value may be a constant or a picture. Roughness is GGX alpha. Writers say in a note what their
renderer lacks.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from .pictures import Colored, Number, Picture

BLACK = (0.0, 0.0, 0.0)
WHITE = (1.0, 1.0, 1.0)
#: Roughness (alpha) below which a surface is smooth, as in the core.
SMOOTH = 1e-3


@dataclass(frozen=True)
class Lambert:
    """Diffuse reflection."""

    color: Colored = (0.5, 0.5, 0.5)


@dataclass(frozen=True)
class Metal:
    """Microfacets that reflect ``color``; ``schlick``: at normal incidence, white at grazing."""

    color: Colored = WHITE
    alpha: Number = 0.1
    schlick: bool = False


@dataclass(frozen=True)
class Glass:
    """Clear dielectric, its normal pointing outside; ``thin``: a sheet that bends nothing.

    A thin sheet reflects as one interface does, without what goes to and fro inside of it.
    """

    ior: float = 1.5
    alpha: Number = 0.0
    tint: Colored = WHITE
    thin: bool = False


@dataclass(frozen=True)
class Plastic:
    """Diffuse base below a dielectric, whose light does not saturate between the two.

    Attributes:
        color: Diffuse colour as seen through the coat, without the light that this reflects.
        ior: Index of the dielectric.
        alpha: Its roughness.
        tint: Factor on what it reflects.
    """

    color: Colored = (0.5, 0.5, 0.5)
    ior: float = 1.5
    alpha: Number = 0.0
    tint: Colored = WHITE


@dataclass(frozen=True)
class Blend:
    """Two surfaces; ``amount`` is the share of the second."""

    first: Surface
    second: Surface
    amount: Number = 0.5


Surface = Lambert | Metal | Glass | Plastic | Blend


@dataclass(frozen=True)
class Emission:
    """Light that a surface emits, cd/m2, from its front or from both sides."""

    color: Colored = BLACK
    both_sides: bool = False

    @property
    def present(self) -> bool:
        """Whether there is any."""
        return isinstance(self.color, Picture) or max(self.color) > 0


@dataclass(frozen=True)
class Absorption:
    """Absorbing inside of a closed mesh: what is left of white after a distance, m."""

    color: tuple[float, float, float]
    distance_m: float


@dataclass(frozen=True)
class Look:
    """All of a material.

    Attributes:
        surface: Reflection and transmission.
        opacity: Share that is there; 1: opaque.
        normals: Normal map.
        emission: Emitted light.
        inside: Absorption inside.
        uv_set: Set of texture coordinates that its pictures use.
        vertex_colors: Whether vertex colours multiply the colour of the surface.
    """

    surface: Surface
    opacity: Number = 1.0
    normals: Picture | None = None
    emission: Emission = field(default_factory=Emission)
    inside: Absorption | None = None
    uv_set: int = 0
    vertex_colors: bool = False


def clear(surface: Surface) -> bool:
    """Whether light may pass the surface."""
    if isinstance(surface, Blend):
        return clear(surface.first) or clear(surface.second)
    return isinstance(surface, Glass)


def is_smooth(alpha: Number) -> bool:
    """Whether a roughness is that of a polished surface."""
    return not isinstance(alpha, Picture) and alpha < SMOOTH
