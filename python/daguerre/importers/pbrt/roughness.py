"""Roughness of pbrt as the alpha of GGX.

pbrt maps roughness 0 .. 1 to alpha unless ``remaproughness`` is false: by a root in pbrt-v4, by a
fit in pbrt-v3 (``TrowbridgeReitzDistribution::RoughnessToAlpha`` of both).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daguerre.scene.materials import TextureSlot

from .ledger import Ledger
from .state import Entity
from .textures import Textures

Array = NDArray[np.float32]
#: Coefficients of pbrt-v3's fit in the logarithm of roughness.
_FIT = (1.62142, 0.819955, 0.1734, 0.0171201, 0.000640711)


@dataclass(frozen=True)
class Roughness:
    """Roughness of a surface: alpha along u and v, and a slot of factors on both."""

    alpha: float
    alpha_v: float | None = None
    slot: TextureSlot | None = None


def roughness_of(
    entity: Entity,
    textures: Textures,
    version: int,
    ledger: Ledger,
    default: float,
    prefix: str = "",
) -> Roughness:
    """Reads the roughness of a surface.

    Args:
        entity: Directive of the material.
        textures: Textures of the scene.
        version: Version of pbrt, 3 or 4.
        ledger: Receives a note on parameters that are left out.
        default: Roughness without a parameter.
        prefix: Beginning of the names, such as ``interface.``.

    Raises:
        InputError: A parameter is wrong.
    """
    remaps = entity.parameters.flag("remaproughness", True)
    curve = _curve(version, remaps)
    key = ("roughness", version, remaps)

    def read(axis: str) -> tuple[float, TextureSlot | None]:
        name = f"{prefix}{axis}roughness"
        name = name if textures.has(entity, name) else f"{prefix}roughness"
        shade = textures.number(entity, name, default, curve, key)
        return shade.number, shade.slot

    (u, slot), (v, other) = read("u"), read("v")
    entity.parameters.find(f"{prefix}roughness")
    if other != slot:
        ledger.notes.add("a texture of roughness along one direction is used for both")
        slot = slot or other
        u = v = 1.0
    return Roughness(u, None if u == v else v, slot)


def _curve(version: int, remaps: bool) -> Callable[[Array], Array]:
    if not remaps:
        return lambda values: np.clip(values, 0, 1)
    if version == 4:
        return lambda values: np.sqrt(np.clip(values, 0, 1))
    return _fitted


def _fitted(values: Array) -> Array:
    x = np.log(np.maximum(values, 1e-3))
    found = np.clip(np.polynomial.polynomial.polyval(x, _FIT), 0, 1)
    return np.asarray(np.where(values > 0, found, 0), np.float32)
