"""Materials in the core's form: dicts of plain values, with textures as tuples."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import daguerre._core as _core
from daguerre.scene.materials import Gltf, Kind, Material, Spectrum, TextureSlot

#: Fields of a material that the core takes aside from its kind; profile and media become indices.
_COMMON = tuple(
    field.name
    for field in dataclasses.fields(Material)
    if field.name not in ("kind", "name", "profile", "interior", "exterior", "nesting")
)


def kind_name(kind: Kind) -> str:
    """Name of a kind in the core."""
    return type(kind).__name__.lower()


def kind_values(kind: Any) -> dict[str, Any]:
    """Fields of a kind."""
    values = {f.name: _plain(getattr(kind, f.name)) for f in dataclasses.fields(kind)}
    if "alpha_v" in values and values["alpha_v"] is None:
        values["alpha_v"] = values["alpha"]
    if isinstance(kind, Gltf):
        values["anisotropy_rotation"] = math.radians(kind.anisotropy_rotation)
    return values


def common_values(material: Material, profile: int) -> dict[str, Any]:
    """Fields that materials of all kinds have, with the index of the profile in the builder."""
    return {name: _plain(getattr(material, name)) for name in _COMMON} | {"profile": profile}


def _plain(value: object) -> Any:
    if isinstance(value, TextureSlot):
        return value.texture, value.uv_set, tuple(value.transform)
    if isinstance(value, Spectrum):
        return _core.SampledSpectrum(value.wavelengths_nm, value.values)
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return kind_values(value)
    return value
