"""Lambertian surfaces."""

from __future__ import annotations

from dataclasses import dataclass

from daguerre.files.value import BriefRecord
from daguerre.scene.spectrum import Spectrum

from .texture_slot import TextureSlot

#: Linear Rec.709.
Color = tuple[float, float, float]


@dataclass(frozen=True, repr=False)
class Diffuse(BriefRecord):
    """Lambertian diffuse material, on both sides.

    Where reflectance and transmittance are more than 1 together, both are scaled down.

    Attributes:
        reflectance: Share of light that is reflected, 0 to 1; vertex colours are factors on it.
        reflectance_texture: RGB, a factor on ``reflectance``.
        transmittance: Share of light that leaves on the other side, by the cosine as well, 0 to 1.
        transmittance_texture: RGB, a factor on ``transmittance``.
    """

    reflectance: Color | Spectrum = (0.5, 0.5, 0.5)
    reflectance_texture: TextureSlot | None = None
    transmittance: Color | Spectrum = (0.0, 0.0, 0.0)
    transmittance_texture: TextureSlot | None = None
