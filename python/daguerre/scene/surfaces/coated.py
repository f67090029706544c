"""Surfaces under a clear coat."""

from __future__ import annotations

from dataclasses import dataclass, field

from daguerre.files.value import BriefRecord
from daguerre.scene.spectrum import Spectrum

from .conductor import Conductor
from .diffuse import Color, Diffuse
from .facets import Distribution
from .texture_slot import TextureSlot


@dataclass(frozen=True, repr=False)
class Coated(BriefRecord):
    """A clear dielectric coat over a diffuse surface (plastic, varnish) or a metal, both sides.

    Light that the base reflects and the coat reflects back is counted, which makes colours more
    saturated.

    Attributes:
        base: Surface below. The ``eta`` and ``k`` of a metal are relative to air.
        ior: Index of refraction of the coat, 1 to 10.
        alpha: Roughness of the coat, of slopes along u where ``alpha_v`` is given; < 1e-3:
            smooth.
        alpha_v: Roughness along v; None: ``alpha``.
        alpha_texture: Factors: R on ``alpha``, G on ``alpha_v``.
        specular_tint: Factor on light that the coat reflects.
        thickness: Thickness of the coat, m.
        absorption: Absorption coefficient of the coat, 1/m.
        nonlinear: Whether light that the coat reflects back takes on the base's colour once more.
            Otherwise the base is lit like a white base, and scaled by its colour, which is the
            default of Mitsuba's plastic.
        distribution: Distribution of the normals of the coat's facets: "ggx", or "beckmann",
            without the long tails.
        energy_compensation: Whether light that the facets of a rough coat block goes in, and comes
            back inside; without it, that light is lost, as in Mitsuba's rough plastic.
    """

    base: Diffuse | Conductor = field(default_factory=Diffuse)
    ior: float = 1.5
    alpha: float = 0.0
    alpha_v: float | None = None
    alpha_texture: TextureSlot | None = None
    specular_tint: Color | Spectrum = (1.0, 1.0, 1.0)
    thickness: float = 0.0
    absorption: Color | Spectrum = (0.0, 0.0, 0.0)
    nonlinear: bool = True
    distribution: Distribution = "ggx"
    energy_compensation: bool = True
