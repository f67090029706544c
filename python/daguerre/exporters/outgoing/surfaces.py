"""Surfaces in terms that pbrt and Mitsuba share, from which both are written.

A value may be a constant or a picture, and a constant colour a spectrum. Roughness is alpha.
Writers note features that their renderer lacks.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from daguerre.scene.media import Medium
from daguerre.scene.spectrum import Spectrum
from daguerre.scene.surfaces.facets import Distribution

from .pictures import BLACK, WHITE, BakedPicture, Colored, Number

#: Roughness (alpha) below which a surface is smooth, as in the core.
SMOOTH = 1e-3


@dataclass(frozen=True)
class Rough:
    """Roughness along u, and along v (None: the same), and the distribution of normals."""

    u: Number = 0.0
    v: Number | None = None
    distribution: Distribution = "ggx"

    @property
    def smooth(self) -> bool:
        """Whether the surface is polished."""
        return _is_smooth(self.u) and (self.v is None or _is_smooth(self.v))


POLISHED = Rough()


@dataclass(frozen=True)
class Lambert:
    """Diffuse reflection, and diffuse transmission."""

    color: Colored = (0.5, 0.5, 0.5)
    through: Colored = BLACK


@dataclass(frozen=True)
class Metal:
    """Microfacets of a metal.

    Attributes:
        color: Reflectance of the facets, or a factor on the reflectance from ``eta`` and ``k``.
        rough: Roughness.
        schlick: Whether ``color`` holds at normal incidence, and rises to 1 at grazing incidence.
        eta: Real part of the index of refraction; None: ``color`` alone.
        k: Imaginary part.
    """

    color: Colored = WHITE
    rough: Rough = POLISHED
    schlick: bool = False
    eta: Spectrum | None = None
    k: Spectrum | None = None


@dataclass(frozen=True)
class Glass:
    """Clear dielectric, its normal pointing outside.

    Attributes:
        ior: Index of refraction.
        rough: Roughness.
        tint: Factor on transmitted light.
        reflection: Factor on reflected light.
        pane: ``""``: the surface bounds glass; ``"double"``: a sheet with all reflections inside of
            it; ``"single"``: a sheet that reflects like a single interface.
    """

    ior: float | Spectrum = 1.5
    rough: Rough = POLISHED
    tint: Colored = WHITE
    reflection: Colored = WHITE
    pane: str = ""


@dataclass(frozen=True)
class Plastic:
    """Diffuse base below a dielectric coat.

    Attributes:
        color: Colour of the base.
        ior: Index of the coat.
        rough: Roughness of the coat.
        tint: Factor on light that the coat reflects.
        saturates: Whether light between base and coat takes on the colour each time; otherwise
            ``color`` is the visible colour, without the coat's reflection.
        compensated: Whether light that facets of the coat block goes in; otherwise it is lost.
    """

    color: Colored = (0.5, 0.5, 0.5)
    ior: float = 1.5
    rough: Rough = POLISHED
    tint: Colored = WHITE
    saturates: bool = False
    compensated: bool = True


@dataclass(frozen=True)
class Varnish:
    """Metal below a dielectric coat."""

    metal: Metal
    ior: float = 1.5
    rough: Rough = POLISHED
    tint: Colored = WHITE


@dataclass(frozen=True)
class Blend:
    """Two surfaces; ``amount`` is the share of the second."""

    first: Surface
    second: Surface
    amount: Number = 0.5


@dataclass(frozen=True)
class Nothing:
    """Boundary of a medium, which light passes unseen."""


Surface = Lambert | Metal | Glass | Plastic | Varnish | Blend | Nothing


@dataclass(frozen=True)
class Emission:
    """Light that a surface emits, cd/m2, from its front or from both sides."""

    color: Colored = BLACK
    both_sides: bool = False

    @property
    def present(self) -> bool:
        """Whether there is any."""
        if isinstance(self.color, BakedPicture):
            return bool(self.color.pixels.max() > 0)
        return not isinstance(self.color, Spectrum) and max(self.color) > 0


@dataclass(frozen=True)
class ExportedMaterial:
    """All parts of a material.

    Attributes:
        surface: Reflection and transmission.
        opacity: Covered share; 1: opaque.
        normals: Normal map.
        emission: Emitted light.
        inside: Medium inside a closed mesh.
        outside: Medium outside of it; None: the world's.
        two_sided: Whether the surface is seen from behind.
        uv_set: Set of texture coordinates that its pictures use.
        vertex_colors: Whether vertex colours multiply the colour of the surface.
    """

    surface: Surface
    opacity: Number = 1.0
    normals: BakedPicture | None = None
    emission: Emission = field(default_factory=Emission)
    inside: Medium | None = None
    outside: Medium | None = None
    two_sided: bool = True
    uv_set: int = 0
    vertex_colors: bool = False

    @property
    def clear(self) -> bool:
        """Whether light may pass the surface."""
        return _clear(self.surface)


def _clear(surface: Surface) -> bool:
    if isinstance(surface, Blend):
        return _clear(surface.first) or _clear(surface.second)
    return isinstance(surface, Glass | Nothing)


def _is_smooth(alpha: Number) -> bool:
    return not isinstance(alpha, BakedPicture) and alpha < SMOOTH
