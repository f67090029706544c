"""glTF materials as the surfaces that other renderers have.

The dielectric of glTF is a diffuse base below an interface, without saturation by light between
them; its metal has Schlick's Fresnel term. Source: glTF 2.0, Appendix B, and the extensions' texts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from daguerre.scene.materials import Gltf, TextureSlot
from daguerre.scene.media import Medium
from daguerre.scene.spectrum import Spectrum

from .pictures import BLACK, WHITE, BakedPicture, Baker, Color, Colored, Number, each, scaled
from .surfaces import (
    Blend,
    Emission,
    ExportedMaterial,
    Glass,
    Lambert,
    Metal,
    Plastic,
    Rough,
    Surface,
)
from .texture_sets import uv_set_of

#: Highest reflectance at normal incidence that is written as an index of refraction.
MOST_F0 = 0.9
#: Least share of light that passes over the distance of an absorption.
_LEAST_SHARE = 1e-6
_LEFT_OUT = {
    "clearcoat": "clear coat of a glTF material is left out",
    "sheen_color": "sheen of a glTF material is left out",
    "iridescence": "iridescence of a glTF material is left out",
    "anisotropy": "anisotropy of a glTF material is left out: its roughness is isotropic",
    "diffuse_transmission": "diffuse transmission of a glTF material is left out",
    "dispersion": "dispersion of a glTF material is left out: it has one index of refraction",
}


@dataclass(frozen=True)
class _Interface:
    """Index of refraction, and the factor on the reflected light."""

    ior: float
    tint: Colored


def gltf_look(kind: Gltf, baker: Baker) -> ExportedMaterial:
    """Translates a glTF material, without the emission of the material that holds it."""
    base = baker.color(kind.base_color_texture, kind.base_color)
    if kind.unlit:
        return ExportedMaterial(
            Lambert(BLACK),
            _opacity(kind, baker),
            emission=Emission(base, True),
            uv_set=_uv_set(kind, baker),
            vertex_colors=True,
        )
    _note_extensions(kind, baker)
    surface = _glossy(kind, base, baker) if kind.specular_glossiness else _rough(kind, base, baker)
    return ExportedMaterial(
        surface,
        _opacity(kind, baker),
        baker.normals(kind.normal_texture, kind.normal_scale),
        Emission(_emissive(kind, baker), kind.double_sided),
        inside=_inside(kind),
        uv_set=_uv_set(kind, baker),
        vertex_colors=True,
    )


def _rough(kind: Gltf, base: Colored, baker: Baker) -> Surface:
    texture = kind.metallic_roughness_texture
    rough = Rough(each(baker.number(texture, kind.roughness, 1), np.square))
    metallic = baker.number(texture, kind.metallic, 2)
    dielectric = _dielectric(kind, base, rough, baker)
    return _mixed(dielectric, Metal(base, rough, schlick=True), metallic)


def _dielectric(kind: Gltf, base: Colored, rough: Rough, baker: Baker) -> Surface:
    interface = _interface(kind, baker)
    opaque: Surface = Plastic(base, interface.ior, rough, interface.tint)
    if interface.ior == 1 or interface.tint == BLACK:
        opaque = Lambert(base)
    transmission = baker.number(kind.transmission_texture, kind.transmission, 0)
    glass = Glass(interface.ior, rough, base, pane="single" if kind.thickness == 0 else "")
    return _mixed(opaque, glass, transmission)


def _glossy(kind: Gltf, base: Colored, baker: Baker) -> Surface:
    """Specular-glossiness: a base and F0 of any colour."""
    texture = kind.specular_glossiness_texture
    alpha = each(baker.number(texture, kind.glossiness, 3), lambda gloss: (1 - gloss) ** 2)
    f0 = baker.color(texture, kind.specular_color)
    assert not isinstance(f0, Spectrum)  # glTF has none
    if isinstance(f0, BakedPicture):
        baker.notes.add("texture of a glTF specular colour is written as its mean")
        f0 = f0.mean
    interface = _of_f0(f0, baker)
    return Plastic(scaled(base, 1 - max(f0)), interface.ior, Rough(alpha), interface.tint)


def _interface(kind: Gltf, baker: Baker) -> _Interface:
    """Index and tint that have the reflectance of KHR_materials_ior and _specular."""
    for slot in (kind.specular_texture, kind.specular_color_texture):
        if slot is not None:
            baker.notes.add("texture of glTF specular is left out: its factor is written")
    if kind.ior == 0:
        return _of_f0(_times(kind.specular_color, kind.specular), baker)
    if kind.specular == 1 and kind.specular_color == WHITE:
        return _Interface(kind.ior, WHITE)
    f0 = _times(kind.specular_color, kind.specular * ((kind.ior - 1) / (kind.ior + 1)) ** 2)
    return _of_f0(_clipped(f0), baker)


def _of_f0(f0: Color, baker: Baker) -> _Interface:
    top = max(f0)
    if top <= 0:
        return _Interface(1.0, BLACK)
    if top > MOST_F0:
        baker.notes.add(f"reflectance above {MOST_F0} of a glTF dielectric is limited to that")
    if min(f0) < top:
        baker.notes.add("coloured specular of a glTF material is coloured at grazing angles, too")
    root = math.sqrt(min(top, MOST_F0))
    return _Interface((1 + root) / (1 - root), _times(f0, 1 / top))


def _mixed(first: Surface, second: Surface, amount: Number) -> Surface:
    if not isinstance(amount, BakedPicture):
        if amount <= 0:
            return first
        if amount >= 1:
            return second
    return Blend(first, second, amount)


def _opacity(kind: Gltf, baker: Baker) -> Number:
    if kind.alpha_mode == "opaque":
        return 1.0
    alpha = baker.number(kind.base_color_texture, kind.base_alpha, 3)
    if kind.alpha_mode != "mask":
        return alpha
    cut = kind.alpha_cutoff
    if isinstance(alpha, BakedPicture):
        baker.notes.add("alpha mask of a glTF material is cut at its texels, not between them")
    return each(alpha, lambda a: (np.asarray(a) >= cut).astype(np.float32))


def _emissive(kind: Gltf, baker: Baker) -> Colored:
    if kind.emissive == BLACK:
        return BLACK
    return baker.color(kind.emissive_texture, kind.emissive)


def _inside(kind: Gltf) -> Medium | None:
    """Absorption of KHR_materials_volume: color^(x / distance)."""
    absorbs = kind.transmission > 0 and kind.thickness > 0
    if not absorbs or math.isinf(kind.attenuation_distance):
        return None
    red, green, blue = (
        -math.log(max(share, _LEAST_SHARE)) / kind.attenuation_distance
        for share in kind.attenuation_color
    )
    return Medium(absorption=(red, green, blue))


def _note_extensions(kind: Gltf, baker: Baker) -> None:
    for name, sentence in _LEFT_OUT.items():
        value = getattr(kind, name)
        if (max(value) if isinstance(value, tuple) else value) > 0:
            baker.notes.add(sentence)


def _uv_set(kind: Gltf, baker: Baker) -> int:
    """Set of texture coordinates of the material; occlusion is not used."""
    slots = [slot for name, slot in vars(kind).items() if isinstance(slot, TextureSlot)
             and name != "occlusion_texture"]  # fmt: skip
    return uv_set_of(slots, baker.notes)


def _times(color: Color, factor: float) -> Color:
    return color[0] * factor, color[1] * factor, color[2] * factor


def _clipped(color: Color) -> Color:
    return min(color[0], 1.0), min(color[1], 1.0), min(color[2], 1.0)
