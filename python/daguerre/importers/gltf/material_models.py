"""Reads material models other than metallic-roughness: unlit, specular-glossiness, diffuse.

Source: KHR_materials_{unlit, diffuse_transmission, pbrSpecularGlossiness}.
"""

from __future__ import annotations

from typing import Any

from daguerre.files.json_item import Item
from daguerre.files.notes import Notes

from .factors import SLACK, fraction, unit_color
from .textures import Textures

_SPECULAR_GLOSSINESS = "KHR_materials_pbrSpecularGlossiness"
#: Extensions of metallic-roughness that have no meaning beside specular-glossiness.
_EXCLUDED = (
    *("anisotropy", "clearcoat", "diffuse_transmission", "dispersion", "ior", "iridescence"),
    *("sheen", "specular", "transmission", "volume"),
)


def is_unlit(item: Item) -> bool:
    """Whether a material emits its base colour, independent of lights."""
    extension = item.extension("KHR_materials_unlit")
    if extension is not None:
        extension.members()  # checks that it is an object
    return extension is not None


def read_base_color(
    owner: Item | None, factor: str, texture: str, textures: Textures, values: dict[str, Any]
) -> None:
    """Reads colour and opacity: a factor of four numbers and a texture in sRGB."""
    if owner is not None:
        numbers = owner.numbers_of(factor, (1.0,) * 4, 0, 1 + SLACK)
        r, g, b, values["base_alpha"] = (min(f, 1.0) for f in numbers)
        values["base_color"] = (r, g, b)
    values["base_color_texture"] = textures.slot(owner, texture, srgb=True)


def read_specular_glossiness(
    item: Item, textures: Textures, notes: Notes, values: dict[str, Any]
) -> bool:
    """Reads the archived extension; returns False if the material has another model."""
    model = item.extension(_SPECULAR_GLOSSINESS)
    if model is None:
        return False
    read_base_color(model, "diffuseFactor", "diffuseTexture", textures, values)
    values["specular_glossiness"] = True
    values["specular_color"] = unit_color(model, "specularFactor", 1.0)
    values["glossiness"] = fraction(model, "glossinessFactor", 1.0)
    values["specular_glossiness_texture"] = textures.slot(
        model, "specularGlossinessTexture", srgb=True
    )
    for name in _EXCLUDED:
        if item.extension(f"KHR_materials_{name}") is not None:
            notes.add(f"'KHR_materials_{name}' is ignored beside specular-glossiness")
    return True


def read_diffuse_transmission(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    """Reads the share of diffuse light that is transmitted, and its colour."""
    through = item.extension("KHR_materials_diffuse_transmission")
    name = "diffuse_transmission"
    values[name] = fraction(through, "diffuseTransmissionFactor", 0.0)
    values[name + "_texture"] = textures.slot(through, "diffuseTransmissionTexture", srgb=False)
    values[name + "_color"] = unit_color(through, "diffuseTransmissionColorFactor", 1.0)
    values[name + "_color_texture"] = textures.slot(
        through, "diffuseTransmissionColorTexture", srgb=True
    )
