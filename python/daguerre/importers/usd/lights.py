"""Reads lights of UsdLux. An intensity of 1 is a luminance of 1 cd/m2.

``luminance = intensity * 2^exposure * color * blackbody(temperature) / size``, where size is 1, or
the area of the light in m2 if it is normalized; for a distant light see :func:`cone_size`.

Source: OpenUSD, documentation of UsdLuxLightAPI; its pull requests 3182 (quantities) and 3587
(areas in m2).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from pxr import Usd, UsdLux

from daguerre.cached import cached_property
from daguerre.errors import InputError
from daguerre.files.notes import Notes
from daguerre.motion.values import at as value_at
from daguerre.scene.limits import MAX_SIZE
from daguerre.scene.over_time.blackbody import Color
from daguerre.scene.over_time.emission import MOST, Emission, Shown, bounded

from .values import Clock, authored, plain

_SHADOW = ("enable", "color", "distance", "falloff")


def times(emission: Color | Emission, factor: float) -> Color | Emission:
    """An emission, times a factor."""
    if isinstance(emission, Emission):
        return emission.scaled(factor)
    r, g, b = (bounded(factor * c) for c in emission)
    return (r, g, b)


def cone_size(degrees: float) -> tuple[float, float]:
    """Illuminance and divisor of a distant light of 1 cd/m2 with this angular diameter.

    Returns:
        Illuminance of a surface that faces the light, lux, and the divisor of normalization. A
        diameter of 0 stands for a parallel beam of 1 lux.

    Source: OpenUSD, documentation of UsdLuxLightAPI, normalize.
    """
    half = math.radians(min(max(degrees, 0.0), 360.0)) / 2
    if half == 0:
        return 1.0, 1.0
    part = math.pi * math.sin(half) ** 2
    return (part, part) if half <= math.pi / 2 else (math.pi, 2 * math.pi - part)


def is_light(prim: Usd.Prim) -> bool:
    """Whether a prim is a light."""
    return bool(prim.HasAPI(UsdLux.LightAPI))


class Lamp:
    """Attributes of a light, checked.

    Args:
        prim: The light.
        clock: Time codes of the stage.
        notes: Receives notes on unsupported content.
    """

    def __init__(self, prim: Usd.Prim, clock: Clock, notes: Notes) -> None:
        self.prim = prim
        self._clock = clock
        self._notes = notes
        _note_the_rest(UsdLux.LightAPI(prim), notes)

    def size(self, name: str) -> float:
        """A length of the light at the scene's time, at least 0, in the prim's units.

        Raises:
            InputError: The length is beyond the limits of a scene.
        """
        found = abs(self.still(f"inputs:{name}"))
        if found >= MAX_SIZE:
            raise self._wrong(f"inputs:{name}", f"a number below {MAX_SIZE:g}", found)
        return found

    def still(self, name: str) -> float:
        """A number, constant over time, or with a note as at the scene's time."""
        attribute = self.prim.GetAttribute(name)
        if self._clock.codes(attribute):
            self._notes.add(
                "a light whose size or shaping changes keeps both as at the scene's time"
            )
        return self._number(name, self._clock.now(attribute))

    def color(self, name: str, default: Color) -> Color:
        """A colour at the scene's time; the default if the prim lacks the attribute."""
        attribute = self.prim.GetAttribute(name)
        return self._color(name, plain(self._clock.now(attribute))) if attribute else default

    def flag(self, name: str) -> bool:
        """A flag at the scene's time."""
        return bool(self._clock.now(self.prim.GetAttribute(name)))

    @cached_property
    def normalized(self) -> bool:
        """Whether the luminance is divided by the size of the light."""
        return self.flag("inputs:normalize")

    def emission(self, size: float, shown: bool | Shown) -> Color | Emission:
        """Luminance of the light.

        Args:
            size: Divisor if it is normalized.
            shown: Whether the light is on.
        """
        factor = 1.0 / size if self.normalized and size > 0 else 1.0
        made = replace(self._bare, shown=shown, factor=factor)
        if max(replace(made, shown=True).at(self._clock.time)) >= MOST:
            self._notes.add(f"a light brighter than {MOST:g} cd/m2 is limited to that")
        return made.now()

    @cached_property
    def _bare(self) -> Emission:
        """Emission of the light, always on and not normalized."""
        tinted = self.flag("inputs:enableColorTemperature")
        made = Emission(
            self._over_time("inputs:intensity", self._number),
            self._over_time("inputs:exposure", self._number),
            self._over_time("inputs:color", self._color),
            self._over_time("inputs:colorTemperature", self._number) if tinted else None,
        )
        if value_at(made.intensity, self._clock.time) < 0:
            self._notes.add("a light of negative intensity is black")
        if min(value_at(made.color, self._clock.time)) < 0:
            self._notes.add("a negative part of the colour of a light is left out")
        return made

    def _over_time(self, name: str, check: Callable[[str, object], Any]) -> Any:
        found = self._clock.value(
            self.prim.GetAttribute(name), lambda value: check(name, plain(value))
        )
        return check(name, None) if found is None else found

    def _number(self, name: str, value: object) -> float:
        if isinstance(value, int | float) and math.isfinite(value):
            return float(value)
        raise self._wrong(name, "a finite number", value)

    def _color(self, name: str, value: object) -> Color:
        if isinstance(value, tuple) and len(value) == 3 and np.isfinite(value).all():
            return value
        raise self._wrong(name, "three finite numbers", value)

    def _wrong(self, name: str, wanted: str, got: object) -> InputError:
        place = f"{self._clock.file}: {self.prim.GetPath()}.{name}"
        return InputError(f"{place}: wanted {wanted}, got {str(got)[:60]}")


def _note_the_rest(api: UsdLux.LightAPI, notes: Notes) -> None:
    """Notes parts of a light that are left out."""
    prim = api.GetPrim()
    if any(map(_is_selective, (api.GetLightLinkCollectionAPI(), api.GetShadowLinkCollectionAPI()))):
        notes.add("light linking is ignored: a light that is linked to some prims lights all")
    if api.GetFiltersRel().HasAuthoredTargets():
        notes.add("a light filter is left out")
    for attribute in (api.GetDiffuseAttr(), api.GetSpecularAttr()):
        if authored(attribute) and attribute.Get() != 1:
            notes.add("the diffuse and specular factors of a light are ignored")
    if any(authored(prim.GetAttribute(f"inputs:shadow:{name}")) for name in _SHADOW):
        notes.add("the shadow settings of a light are ignored")


def _is_selective(collection: Usd.CollectionAPI) -> bool:
    """Whether a collection may lack some prims."""
    return (
        collection.GetIncludeRootAttr().Get() is False
        or collection.GetExcludesRel().HasAuthoredTargets()
        or authored(collection.GetMembershipExpressionAttr())
    )
