"""Reads the shaping of lights: focus, cone and photometric files (UsdLux ShapingAPI)."""

from __future__ import annotations

import math

from pxr import Usd, UsdLux

from daguerre.files.notes import Notes
from daguerre.scene.light_profile import LightProfile

from .assets import Assets
from .lights import Lamp
from .values import authored

_FILE = "inputs:shaping:ies:file"


def read_profile(lamp: Lamp, assets: Assets, notes: Notes) -> LightProfile | None:
    """Reads the profile of a light; None if its light does not depend on direction.

    Raises:
        InputError: A number is not finite, or the photometric file cannot be used.
    """
    prim = lamp.prim
    if not is_shaped(prim):
        return None
    parts = [_focus(lamp), _cone(lamp), _photometric(lamp, assets, notes)]
    return math.prod((part for part in parts if part is not None), start=LightProfile())


def is_shaped(prim: Usd.Prim) -> bool:
    """Whether a light has attributes of shaping; the API alone makes a cone of 90 degrees."""
    names = ("focus", "cone:angle", "ies:file")
    return bool(prim.HasAPI(UsdLux.ShapingAPI)) or any(
        authored(prim.GetAttribute(f"inputs:shaping:{name}")) for name in names
    )


def _focus(lamp: Lamp) -> LightProfile | None:
    exponent = _number(lamp, "focus", 0.0)
    r, g, b = (max(c, 0.0) for c in lamp.color("inputs:shaping:focusTint", (0.0, 0.0, 0.0)))
    return LightProfile.focus(exponent, (r, g, b)) if exponent > 0 else None


def _cone(lamp: Lamp) -> LightProfile | None:
    api = lamp.prim.HasAPI(UsdLux.ShapingAPI)
    angle = _number(lamp, "cone:angle", 90.0 if api else 180.0)
    softness = min(max(_number(lamp, "cone:softness", 0.0), 0.0), 1.0)
    return LightProfile.cone(max(angle, 1e-6), softness) if angle < 180 else None


def _photometric(lamp: Lamp, assets: Assets, notes: Notes) -> LightProfile | None:
    """The light's photometric file; None, with a note, if it is missing."""
    attribute = lamp.prim.GetAttribute(_FILE)
    asset = attribute.Get() if attribute else None
    if asset is None or not asset.path:
        return None
    path = assets.resolve(f"{lamp.prim.GetPath()}.{_FILE}", asset, attribute)
    if path is None:
        missing = "a photometric file of a light is missing: the light is even"
        notes.add(missing, name=asset.path)
        return None
    found = LightProfile.from_ies(path).stretched(_number(lamp, "ies:angleScale", 0.0))
    return found.normalized() if lamp.flag("inputs:shaping:ies:normalize") else found


def _number(lamp: Lamp, name: str, default: float) -> float:
    full = f"inputs:shaping:{name}"
    return lamp.still(full) if lamp.prim.HasAttribute(full) else default
