"""Reads layers of a glTF material: KHR_materials_{clearcoat, sheen, anisotropy, iridescence}.

Source: the specifications of these extensions.
"""

from __future__ import annotations

import math
from typing import Any

from daguerre.files.json_item import Item

from .factors import fraction, unit_color
from .textures import Textures


def read_layers(item: Item, textures: Textures, values: dict[str, Any]) -> None:
    """Adds the fields of ``Gltf`` that these extensions set to ``values``."""
    _clearcoat(item.extension("KHR_materials_clearcoat"), textures, values)
    _sheen(item.extension("KHR_materials_sheen"), textures, values)
    _anisotropy(item.extension("KHR_materials_anisotropy"), textures, values)
    _iridescence(item.extension("KHR_materials_iridescence"), textures, values)


def _number(item: Item | None, key: str, default: float, low: float = -math.inf) -> float:
    return default if item is None else item.number_of(key, default, low)


def _clearcoat(coat: Item | None, textures: Textures, values: dict[str, Any]) -> None:
    values["clearcoat"] = fraction(coat, "clearcoatFactor", 0.0)
    values["clearcoat_texture"] = textures.slot(coat, "clearcoatTexture", srgb=False)
    values["clearcoat_roughness"] = fraction(coat, "clearcoatRoughnessFactor", 0.0)
    values["clearcoat_roughness_texture"] = textures.slot(
        coat, "clearcoatRoughnessTexture", srgb=False
    )
    values["clearcoat_normal_texture"] = textures.slot(coat, "clearcoatNormalTexture", srgb=False)
    normal = None if coat is None else coat.get("clearcoatNormalTexture")
    values["clearcoat_normal_scale"] = _number(normal, "scale", 1.0)


def _sheen(sheen: Item | None, textures: Textures, values: dict[str, Any]) -> None:
    values["sheen_color"] = unit_color(sheen, "sheenColorFactor", 0.0)
    values["sheen_color_texture"] = textures.slot(sheen, "sheenColorTexture", srgb=True)
    values["sheen_roughness"] = fraction(sheen, "sheenRoughnessFactor", 0.0)
    # Only alpha is read, which is linear in sRGB textures, too; files often share a picture.
    values["sheen_roughness_texture"] = textures.slot(sheen, "sheenRoughnessTexture", srgb=True)


def _anisotropy(brushed: Item | None, textures: Textures, values: dict[str, Any]) -> None:
    values["anisotropy"] = fraction(brushed, "anisotropyStrength", 0.0)
    values["anisotropy_rotation"] = math.degrees(_number(brushed, "anisotropyRotation", 0.0))
    values["anisotropy_texture"] = textures.slot(brushed, "anisotropyTexture", srgb=False)


def _iridescence(film: Item | None, textures: Textures, values: dict[str, Any]) -> None:
    values["iridescence"] = fraction(film, "iridescenceFactor", 0.0)
    values["iridescence_texture"] = textures.slot(film, "iridescenceTexture", srgb=False)
    values["iridescence_ior"] = _number(film, "iridescenceIor", 1.3, 1)
    thinnest = _number(film, "iridescenceThicknessMinimum", 100.0, 0)
    thickest = _number(film, "iridescenceThicknessMaximum", 400.0, 0)
    values["iridescence_thickness_min_nm"] = thinnest
    values["iridescence_thickness_max_nm"] = thickest
    values["iridescence_thickness_texture"] = textures.slot(
        film, "iridescenceThicknessTexture", srgb=False
    )
