"""Glass."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.files.value import BriefRecord
from daguerre.scene.spectrum import Spectrum

from .diffuse import Color
from .facets import Distribution
from .texture_slot import TextureSlot


@dataclass(frozen=True, repr=False)
class Dielectric(BriefRecord):
    """Clear glass, smooth (``alpha`` < 1e-3) or rough; the normal points outside.

    Attributes:
        ior: Index of refraction, at 587.6 nm, or at each wavelength.
        alpha: Roughness, of slopes along u where ``alpha_v`` is given.
        tint: Factor on transmitted light.
        dispersion: 20 / Abbe number; 0: the same index at every wavelength.
        alpha_v: Roughness along v; None: ``alpha``.
        alpha_texture: Factors: R on ``alpha``, G on ``alpha_v``.
        reflection_tint: Factor on reflected light.
        thin: Whether it is a pane with two parallel faces, and the mesh in the middle. Light passes
            undeviated; interreflection between the faces is counted.
        energy_compensation: Whether rough glass returns the light that facets block, as light that
            bounces between them would; without it, rough glass is too dark.
        distribution: Distribution of the facets' normals: "ggx", or "beckmann", without the long
            tails.
    """

    ior: float | Spectrum = 1.5
    alpha: float = 0.0
    tint: Color | Spectrum = (1.0, 1.0, 1.0)
    dispersion: float = 0.0
    alpha_v: float | None = None
    alpha_texture: TextureSlot | None = None
    reflection_tint: Color | Spectrum = (1.0, 1.0, 1.0)
    thin: bool = False
    energy_compensation: bool = False
    distribution: Distribution = "ggx"
