"""Materials of glTF: metallic-roughness and the KHR extensions that Daguerre knows.

Source: glTF 2.0 specification, chapters 3.9 and 5.19; KHR_materials_{emissive_strength, ior,
transmission, volume, specular, dispersion}.
"""

from __future__ import annotations

import math
from typing import Any

from daguerre.materials import Color, Gltf, Material

from .gltf_textures import Textures
from .json_item import Item
from .notes import Notes

# Exporters round: a factor may stand this far beyond 1.
_SLACK = 1e-3
# KHR_materials_ior: 0 asks for a Fresnel term of 1 at every angle, the limit of a large index.
_IOR_OF_ZERO = 1e4


def read_materials(root: Item, textures: Textures, notes: Notes) -> list[Material]:
    """All materials of a file, in its order."""
    return [_material(item, textures, notes) for item in root.list_of("materials")]


def _material(item: Item, textures: Textures, notes: Notes) -> Material:
    values: dict[str, Any] = {}
    _metallic_roughness(item.get("pbrMetallicRoughness"), textures, values)
    _surface(item, textures, values)
    _specular(item, textures, values)
    _transmission(item, textures, notes, values)
    _dispersion(item, values)
    return Material(Gltf(**values), name=item.name() or f"material{item.key}")


def _fraction(item: Item | None, key: str, default: float) -> float:
    """A factor in 0 .. 1."""
    return default if item is None else min(item.number_of(key, default, 0, 1 + _SLACK), 1.0)


def _color(item: Item | None, key: str, default: float, high: float) -> Color:
    if item is None:
        return (default, default, default)
    r, g, b = item.numbers_of(key, (default,) * 3, 0, high)
    return (r, g, b)


def _metallic_roughness(pbr: Item | None, textures: Textures, values: dict[str, Any]) -> None:
    if pbr is not None:
        factor = pbr.numbers_of("baseColorFactor", (1.0,) * 4, 0, 1 + _SLACK)
        r, g, b, values["base_alpha"] = (min(f, 1.0) for f in factor)
        values["base_color"] = (r, g, b)
    values["base_color_texture"] = textures.slot(pbr, "baseColorTexture", srgb=True)
    values["metallic"] = _fraction(pbr, "metallicFactor", 1.0)
    values["roughness"] = _fraction(pbr, "roughnessFactor", 1.0)
    values["metallic_roughness_texture"] = textures.slot(
        pbr, "metallicRoughnessTexture", srgb=False
    )


def _surface(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    values["normal_texture"] = textures.slot(item, "normalTexture", srgb=False)
    normal = item.get("normalTexture")
    values["normal_scale"] = 1.0 if normal is None else normal.number_of("scale", 1.0)
    values["occlusion_texture"] = textures.slot(item, "occlusionTexture", srgb=False)
    strength_of = item.extension("KHR_materials_emissive_strength")
    strength = 1.0
    if strength_of is not None:
        strength = strength_of.number_of("emissiveStrength", 1.0, 0)
    r, g, b = _color(item, "emissiveFactor", 0.0, math.inf)
    values["emissive"] = (r * strength, g * strength, b * strength)
    values["emissive_texture"] = textures.slot(item, "emissiveTexture", srgb=True)
    mode, double = item.get("alphaMode"), item.get("doubleSided")
    if mode is not None:
        values["alpha_mode"] = mode.choice(("OPAQUE", "MASK", "BLEND")).lower()
    values["alpha_cutoff"] = item.number_of("alphaCutoff", 0.5, 0)
    values["double_sided"] = double is not None and double.flag()


def _specular(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    ior_of = item.extension("KHR_materials_ior")
    if ior_of is not None:
        ior = ior_of.number_of("ior", 1.5, 0)
        if 0 < ior < 1:
            ior_of.need("ior").fail(f"out of range: wanted 0 or at least 1, got {ior:g}")
        values["ior"] = ior or _IOR_OF_ZERO
    specular = item.extension("KHR_materials_specular")
    values["specular"] = _fraction(specular, "specularFactor", 1.0)
    values["specular_texture"] = textures.slot(specular, "specularTexture", srgb=False)
    values["specular_color"] = _color(specular, "specularColorFactor", 1.0, math.inf)
    values["specular_color_texture"] = textures.slot(specular, "specularColorTexture", srgb=True)


def _transmission(item: Item, textures: Textures, notes: Notes, values: dict[str, Any]) -> None:
    transmission = item.extension("KHR_materials_transmission")
    values["transmission"] = _fraction(transmission, "transmissionFactor", 0.0)
    values["transmission_texture"] = textures.slot(transmission, "transmissionTexture", srgb=False)
    volume = item.extension("KHR_materials_volume")
    if volume is None:
        return
    # A path tracer needs of the thickness only whether there is an inside; light's way through it
    # is found by rays, in the units of the world.
    values["thickness"] = volume.number_of("thicknessFactor", 0.0, 0)
    if volume.get("thicknessTexture") is not None:
        notes.add("'thicknessTexture' is not needed: the path through the volume is traced")
    distance = volume.get("attenuationDistance")
    if distance is not None:
        values["attenuation_distance"] = distance.number(above=0)
    r, g, b = _color(volume, "attenuationColor", 1.0, 1 + _SLACK)
    values["attenuation_color"] = (min(r, 1.0), min(g, 1.0), min(b, 1.0))


def _dispersion(item: Item, values: dict[str, Any]) -> None:
    dispersion = item.extension("KHR_materials_dispersion")
    if dispersion is not None:
        values["dispersion"] = dispersion.number_of("dispersion", 0.0, 0)
