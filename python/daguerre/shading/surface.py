"""Appearance of a surface in the renderer's terms, before pictures become textures."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .channels import Value

_BLACK: Value = (0.0, 0.0, 0.0)
_WHITE: Value = (1.0, 1.0, 1.0)


@dataclass
class GltfInputs:
    """Inputs of ``daguerre.scene.materials.Gltf`` as values; the names are the same.

    Attributes:
        normal: Normal in the frame of the texture coordinates, or None: the mesh's.
        alpha_mode: Opaque, mask or blend.
        volume: Whether light that is transmitted is refracted into a volume.
    """

    base_color: Value = _WHITE
    alpha: Value = (1.0,)
    metallic: Value = (0.0,)
    roughness: Value = (0.5,)
    normal: Value | None = None
    emissive: Value = _BLACK
    alpha_mode: str = "opaque"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    ior: float = 1.5
    specular: Value = (1.0,)
    specular_color: Value = _WHITE
    transmission: Value = (0.0,)
    volume: bool = False
    attenuation_distance: float = math.inf
    attenuation_color: Value = _WHITE
    dispersion: float = 0.0
    clearcoat: Value = (0.0,)
    clearcoat_roughness: Value = (0.0,)
    clearcoat_normal: Value | None = None
    sheen_color: Value = _BLACK
    sheen_roughness: Value = (0.0,)
    anisotropy: Value = (0.0,)
    anisotropy_rotation: float = 0.0
    iridescence: Value = (0.0,)
    iridescence_ior: float = 1.3
    iridescence_thickness_nm: Value = (400.0,)
    diffuse_transmission: Value = (0.0,)
    diffuse_transmission_color: Value = _WHITE
    unlit: bool = False
