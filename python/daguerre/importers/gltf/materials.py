"""Reads materials of glTF: metallic-roughness and supported KHR extensions.

Source: glTF 2.0 specification, chapters 3.9 and 5.19; KHR_materials_{emissive_strength, ior,
transmission, volume, specular, dispersion}; extensions in importers/gltf/layers.py and
importers/gltf/material_models.py.
"""

from __future__ import annotations

import math
from typing import Any

from daguerre.files.json_item import Item
from daguerre.files.notes import Notes
from daguerre.scene.materials import Gltf, Material

from .factors import color_of, fraction, unit_color
from .layers import read_layers
from .material_models import (
    is_unlit,
    read_base_color,
    read_diffuse_transmission,
    read_specular_glossiness,
)
from .textures import Textures

# KHR_materials_ior: 0 means a Fresnel term of 1 at every angle, the limit of a large index.
_IOR_OF_ZERO = 1e4


def read_materials(root: Item, textures: Textures, notes: Notes) -> list[Material]:
    """Reads all materials of a file, in its order."""
    return [read_material(item, textures, notes) for item in root.list_of("materials")]


def read_material(item: Item, textures: Textures, notes: Notes) -> Material:
    """Reads a material."""
    values: dict[str, Any] = {}
    _coverage(item, values)
    if is_unlit(item):  # other members are fallbacks for readers without unlit
        values["unlit"] = True
        _base_color(item, textures, values)
    else:
        glossy = read_specular_glossiness(item, textures, notes, values)
        if not glossy:
            _metallic_roughness(item, textures, values)
        _surface(item, textures, values)
        if not glossy:
            _extensions(item, textures, notes, values)
    return Material(Gltf(**values), name=item.name() or f"material{item.key}")


def _metallic_roughness(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    _base_color(item, textures, values)
    pbr = item.get("pbrMetallicRoughness")
    values["metallic"] = fraction(pbr, "metallicFactor", 1.0)
    values["roughness"] = fraction(pbr, "roughnessFactor", 1.0)
    values["metallic_roughness_texture"] = textures.slot(
        pbr, "metallicRoughnessTexture", srgb=False
    )


def _extensions(item: Item, textures: Textures, notes: Notes, values: dict[str, Any]) -> None:
    """Reads extensions that apply only to metallic-roughness."""
    _specular(item, textures, values)
    _transmission(item, textures, notes, values)
    read_diffuse_transmission(item, textures, values)
    _dispersion(item, values)
    read_layers(item, textures, values)


def _base_color(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    pbr = item.get("pbrMetallicRoughness")
    read_base_color(pbr, "baseColorFactor", "baseColorTexture", textures, values)


def _surface(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    values["normal_texture"] = textures.slot(item, "normalTexture", srgb=False)
    normal = item.get("normalTexture")
    values["normal_scale"] = 1.0 if normal is None else normal.number_of("scale", 1.0)
    values["occlusion_texture"] = textures.slot(item, "occlusionTexture", srgb=False)
    strength_of = item.extension("KHR_materials_emissive_strength")
    strength = 1.0
    if strength_of is not None:
        strength = strength_of.number_of("emissiveStrength", 1.0, 0)
    r, g, b = color_of(item, "emissiveFactor", 0.0, math.inf)
    values["emissive"] = (r * strength, g * strength, b * strength)
    values["emissive_texture"] = textures.slot(item, "emissiveTexture", srgb=True)


def _coverage(item: Item, values: dict[str, Any]) -> None:
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
    values["specular"] = fraction(specular, "specularFactor", 1.0)
    values["specular_texture"] = textures.slot(specular, "specularTexture", srgb=False)
    values["specular_color"] = color_of(specular, "specularColorFactor", 1.0, math.inf)
    values["specular_color_texture"] = textures.slot(specular, "specularColorTexture", srgb=True)


def _transmission(item: Item, textures: Textures, notes: Notes, values: dict[str, Any]) -> None:
    transmission = item.extension("KHR_materials_transmission")
    values["transmission"] = fraction(transmission, "transmissionFactor", 0.0)
    values["transmission_texture"] = textures.slot(transmission, "transmissionTexture", srgb=False)
    volume = item.extension("KHR_materials_volume")
    if volume is None:
        return
    # A path tracer only needs to know if the thickness is above 0; rays find the path through the
    # volume, in units of the world.
    values["thickness"] = volume.number_of("thicknessFactor", 0.0, 0)
    if volume.get("thicknessTexture") is not None:
        notes.add("'thicknessTexture' is not needed: the path through the volume is traced")
    distance = volume.get("attenuationDistance")
    if distance is not None:
        values["attenuation_distance"] = distance.number(above=0)
    values["attenuation_color"] = unit_color(volume, "attenuationColor", 1.0)


def _dispersion(item: Item, values: dict[str, Any]) -> None:
    dispersion = item.extension("KHR_materials_dispersion")
    if dispersion is not None:
        values["dispersion"] = dispersion.number_of("dispersion", 0.0, 0)
