"""Materials of surfaces. Colours are linear Rec.709 triples; emission is in cd/m2."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from daguerre.checks import color, number, numbers, short, shown, whole
from daguerre.errors import InputError
from daguerre.files.value import changed

from .light_profile import LightProfile, check_profile

Color = tuple[float, float, float]


@dataclass(frozen=True)
class TextureSlot:
    """Reference of a material to a texture.

    Attributes:
        texture: Index returned by ``Scene.add_texture``.
        uv_set: Set of texture coordinates, 0 or 1.
        transform: uv' = (a u + b v + c, d u + e v + f), as (a, b, c, d, e, f).
    """

    texture: int
    uv_set: int = 0
    transform: tuple[float, float, float, float, float, float] = (1, 0, 0, 0, 1, 0)


@dataclass(frozen=True)
class Diffuse:
    """Lambertian diffuse material, on both sides."""

    reflectance: Color = (0.5, 0.5, 0.5)


@dataclass(frozen=True)
class Conductor:
    """Metal: GGX microfacets of constant reflectance, both sides; ``alpha`` < 1e-3: a mirror."""

    reflectance: Color = (1.0, 1.0, 1.0)
    alpha: float = 0.1


@dataclass(frozen=True)
class Dielectric:
    """Clear glass, smooth (``alpha`` < 1e-3) or GGX rough; the normal points outside.

    Attributes:
        ior: Index of refraction, at 587.6 nm.
        alpha: GGX roughness.
        tint: Factor on transmitted light.
        dispersion: 20 / Abbe number; 0: the same index at every wavelength.
    """

    ior: float = 1.5
    alpha: float = 0.0
    tint: Color = (1.0, 1.0, 1.0)
    dispersion: float = 0.0


@dataclass(frozen=True)
class Gltf:
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

    def __repr__(self) -> str:
        """Lists only fields that differ from their defaults, as there are 52 fields."""
        return f"Gltf({', '.join(f'{name}={text}' for name, text in changed(self).items())})"


Kind = Diffuse | Conductor | Dielectric | Gltf


@dataclass(frozen=True)
class Material:
    """A named material: a kind of surface, and emission added to it.

    Attributes:
        kind: Diffuse, Conductor, Dielectric or Gltf.
        emission: Luminance that the front side emits, cd/m2.
        two_sided_emission: Whether the back emits too.
        profile: Factor on all emission, also that of the kind, by its direction in the frame of the
            instance, which shines along -z.
    """

    kind: Kind = field(default_factory=Diffuse)
    name: str = ""
    emission: Color = (0.0, 0.0, 0.0)
    two_sided_emission: bool = False
    profile: LightProfile | None = None


def check_material(material: Material, where: str) -> None:
    """Checks a material and the shapes of its values; the core checks their ranges.

    Raises:
        InputError: The message names the field.
    """
    if not isinstance(material, Material):
        raise InputError(f"{where}: wanted a Material, got {short(material)}")
    kind = material.kind
    if not isinstance(kind, Kind):
        raise InputError(
            f"{where}: kind: wanted Diffuse, Conductor, Dielectric or Gltf, got {short(kind)}"
        )
    if not isinstance(material.name, str):
        raise InputError(f"material: name: wanted a text, got {shown(material.name)}")
    color(material.emission, f"{where}: emission")
    _check_flag(material.two_sided_emission, f"{where}: two_sided_emission")
    check_profile(material.profile, where)
    for name, like in kind.__dataclass_fields__.items():
        value = getattr(kind, name)
        if isinstance(like.default, tuple):
            color(value, f"{where}: {name}")
        elif isinstance(like.default, float):
            endless = math.isinf(like.default)
            number(value, f"{where}: {name}", infinite=endless, error=InputError)
        elif isinstance(like.default, bool):
            _check_flag(value, f"{where}: {name}")
        elif isinstance(like.default, str) and not isinstance(value, str):
            raise InputError(f"{where}: {name}: wanted a text, got {shown(value)}")
        elif isinstance(value, TextureSlot):
            _check_slot(value, f"{where}: {name}")
        elif name.endswith("_texture") and not isinstance(value, TextureSlot | None):
            raise InputError(f"{where}: {name}: wanted a TextureSlot or None, got {short(value)}")


def _check_flag(value: object, where: str) -> None:
    if not isinstance(value, bool | np.bool_) and not (isinstance(value, int) and value in (0, 1)):
        raise InputError(f"{where}: wanted True or False, got {shown(value)}")


def _check_slot(slot: TextureSlot, where: str) -> None:
    whole(slot.texture, f"{where}: texture", 0, 1 << 31)
    whole(slot.uv_set, f"{where}: uv_set", 0, 1)
    numbers(slot.transform, f"{where}: transform", 6, "six numbers")
