"""Mitsuba's ``principled`` and ``principledthin`` as the layers of glTF, which are alike.

Equal: colour, metal, roughness (the square of it is GGX's alpha), index of refraction, stretch of
highlights. Only alike: the falloff of sheen and coat, Fresnel's law of metals, tint of transmitted
light where some light is transmitted and some not.

Source: Burley 2012 and 2015, Physically Based Shading at Disney; Mitsuba 3, ``principled``.
"""

from __future__ import annotations

import math

import numpy as np

from daguerre.files.notes import Notes
from daguerre.shading.arithmetic import Arithmetic
from daguerre.shading.assemble import Assembler
from daguerre.shading.channels import Channel, Value, broadcast
from daguerre.shading.surface import GltfInputs

from .look import Appearance
from .node import Node
from .textures import Textures

_SAMPLING = (
    "diffuse_reflectance_sampling_rate",
    "main_specular_sampling_rate",
    "clearcoat_sampling_rate",
    *("spec_reflect_sampling_rate", "spec_trans_sampling_rate"),
    *("diffuse_trans_sampling_rate", "diffuse_reflect_sampling_rate"),
    "specular_reflectance_sampling_rate",
)
#: Range of the coat's GGX width, dull to glossy.
_DULL, _GLOSSY = 0.1, 0.001
_ALIKE = "a principled material is drawn with glTF's layers: sheen, coat and metals look "
"slightly different"


def principled(node: Node, textures: Textures, notes: Notes) -> Appearance:
    """Solid material."""
    surface = _shared(node, textures, notes)
    surface.volume = True
    _specular(node, surface)
    channel = textures.channel
    surface.metallic = (channel(node, "metallic", 0.0),)
    coat = channel(node, "clearcoat", 0.0)
    gloss = channel(node, "clearcoat_gloss", 0.0)
    each = Arithmetic(textures.baker).each
    surface.clearcoat = each(lambda v: 0.25 * v, (coat,))
    surface.clearcoat_roughness = each(
        lambda v: np.sqrt(_DULL + (_GLOSSY - _DULL) * np.clip(v, 0, 1)), (gloss,)
    )
    return _made(surface, textures, notes, two_sided=_is_set(surface.transmission))


def principled_thin(node: Node, textures: Textures, notes: Notes) -> Appearance:
    """Thin sheet, seen from both sides."""
    surface = _shared(node, textures, notes)
    surface.ior = node.number("eta", 1.5, above=0)
    diffuse = textures.channel(node, "diff_trans", 0.0)
    each = Arithmetic(textures.baker).each
    surface.diffuse_transmission = each(lambda v: 0.5 * v, (diffuse,))  # 2: all of it
    surface.diffuse_transmission_color = surface.base_color
    surface.double_sided = True
    return _made(surface, textures, notes, two_sided=True)


def _shared(node: Node, textures: Textures, notes: Notes) -> GltfInputs:
    each = Arithmetic(textures.baker).each
    channel = textures.channel
    surface = GltfInputs(base_color=textures.channels(node, "base_color", 0.5))
    roughness = channel(node, "roughness", 0.5)
    along, across = _widths(textures, roughness, channel(node, "anisotropic", 0.0))
    surface.roughness = each(lambda v: np.sqrt(np.maximum(v, 0)), across)
    surface.anisotropy = each(_stretch, along, across)
    surface.transmission = (channel(node, "spec_trans", 0.0),)
    tint = _tint(textures, surface.base_color)
    surface.specular_color = _mixed(textures, tint, channel(node, "spec_tint", 0.0))
    sheen = channel(node, "sheen", 0.0)
    if _is_set((sheen,)):
        mixed = _mixed(textures, tint, channel(node, "sheen_tint", 0.0))
        surface.sheen_color = each(lambda v, s: np.clip(v * s, 0, 1), mixed, (sheen,) * 3)
        surface.sheen_roughness = (0.5,)
    if _is_set((channel(node, "flatness", 0.0),)):
        notes.add("the flatness of a principled material is not supported")
    node.skip("sheen_tint", *_SAMPLING)
    return surface


def _made(surface: GltfInputs, textures: Textures, notes: Notes, *, two_sided: bool) -> Appearance:
    notes.add(_ALIKE)
    surface.double_sided = surface.double_sided or two_sided
    kind = Assembler(textures.packer, textures.baker).material(surface, "").kind
    return Appearance(kind, two_sided=two_sided)


def _specular(node: Node, surface: GltfInputs) -> None:
    """Index of refraction, as authored or from the reflectance 0.08 x ``specular``."""
    if node.has("eta") and node.has("specular"):
        node.fail("set either eta or specular, not both")
    if node.has("eta"):
        surface.ior = max(node.number("eta", 1.5, above=0), 1.0)
        return
    specular = min(node.number("specular", 0.5, 0.0), 12.0)
    surface.ior = 2 / (1 - math.sqrt(0.08 * specular)) - 1


def _widths(textures: Textures, roughness: Channel, anisotropic: Channel) -> tuple[Value, Value]:
    """GGX widths r^2 / q and r^2 q, q = sqrt(1 - 0.9 a)."""
    each = Arithmetic(textures.baker).each

    def aspect(a: object) -> object:
        return np.sqrt(1 - 0.9 * np.clip(np.asarray(a), 0, 1))

    along = each(lambda r, a: np.clip(r * r / aspect(a), 1e-3, 1), (roughness,), (anisotropic,))
    across = each(lambda r, a: np.clip(r * r * aspect(a), 1e-3, 1), (roughness,), (anisotropic,))
    return along, across


def _stretch(along: object, across: object) -> object:
    """Anisotropy s of glTF, with alpha r^2 + (1 - r^2) s^2 along and r^2 across."""
    wide, narrow = np.asarray(along), np.asarray(across)
    return np.sqrt(np.clip((wide - narrow) / np.maximum(1 - narrow, 1e-6), 0, 1))


def _tint(textures: Textures, color: Value) -> Value:
    """Hue of a colour: of luminance 1."""
    each = Arithmetic(textures.baker).each
    grey = textures.grey(color)
    return each(
        lambda c, y: np.where(y > 0, c / np.maximum(y, 1e-6), 1.0), broadcast(color, 3), (grey,) * 3
    )


def _mixed(textures: Textures, tint: Value, share: Channel) -> Value:
    """White and a tint by a share."""
    if not _is_set((share,)):
        return 1.0, 1.0, 1.0
    each = Arithmetic(textures.baker).each
    return each(lambda t, s: 1 + s * (t - 1), tint, (share,) * 3)


def _is_set(value: Value) -> bool:
    return not isinstance(value[0], float) or value[0] > 0
