"""The material model of glTF."""

from __future__ import annotations

import math
from dataclasses import dataclass

from daguerre.files.value import BriefRecord

from .diffuse import Color
from .texture_slot import TextureSlot


@dataclass(frozen=True, repr=False)
class Gltf(BriefRecord):
    """glTF metallic-roughness material with extensions; fields have the names of glTF properties.

    The extensions are KHR anisotropy, clearcoat, diffuse_transmission, dispersion (20 / Abbe
    number), emissive_strength, ior, iridescence, sheen, specular, transmission and volume.
    ``anisotropy_rotation`` is in degrees counter-clockwise from the tangent. The thickness of the
    iridescent film is in nm; without a texture the maximum is used.

    With ``specular_glossiness`` the base colour is the diffuse colour, the specular colour the
    reflectance at normal incidence. With ``unlit`` the base colour is a luminance in cd/m2, to
    both sides, and nothing is reflected.
    """

    base_color: Color = (1.0, 1.0, 1.0)
    base_alpha: float = 1.0
    base_color_texture: TextureSlot | None = None
    metallic: float = 1.0
    roughness: float = 1.0
    metallic_roughness_texture: TextureSlot | None = None
    normal_scale: float = 1.0
    normal_texture: TextureSlot | None = None
    occlusion_texture: TextureSlot | None = None
    emissive: Color = (0.0, 0.0, 0.0)
    emissive_texture: TextureSlot | None = None
    alpha_mode: str = "opaque"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    ior: float = 1.5
    specular: float = 1.0
    specular_texture: TextureSlot | None = None
    specular_color: Color = (1.0, 1.0, 1.0)
    specular_color_texture: TextureSlot | None = None
    transmission: float = 0.0
    transmission_texture: TextureSlot | None = None
    thickness: float = 0.0
    attenuation_distance: float = math.inf
    attenuation_color: Color = (1.0, 1.0, 1.0)
    dispersion: float = 0.0
    clearcoat: float = 0.0
    clearcoat_texture: TextureSlot | None = None
    clearcoat_roughness: float = 0.0
    clearcoat_roughness_texture: TextureSlot | None = None
    clearcoat_normal_scale: float = 1.0
    clearcoat_normal_texture: TextureSlot | None = None
    sheen_color: Color = (0.0, 0.0, 0.0)
    sheen_color_texture: TextureSlot | None = None
    sheen_roughness: float = 0.0
    sheen_roughness_texture: TextureSlot | None = None
    anisotropy: float = 0.0
    anisotropy_rotation: float = 0.0
    anisotropy_texture: TextureSlot | None = None
    iridescence: float = 0.0
    iridescence_texture: TextureSlot | None = None
    iridescence_ior: float = 1.3
    iridescence_thickness_min_nm: float = 100.0
    iridescence_thickness_max_nm: float = 400.0
    iridescence_thickness_texture: TextureSlot | None = None
    diffuse_transmission: float = 0.0
    diffuse_transmission_texture: TextureSlot | None = None
    diffuse_transmission_color: Color = (1.0, 1.0, 1.0)
    diffuse_transmission_color_texture: TextureSlot | None = None
    specular_glossiness: bool = False
    glossiness: float = 1.0
    specular_glossiness_texture: TextureSlot | None = None
    unlit: bool = False
