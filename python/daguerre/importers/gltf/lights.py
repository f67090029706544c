"""Reads KHR_lights_punctual: point and spot lights in cd, directional lights in lux."""

from __future__ import annotations

import math

from daguerre.files.json_item import Item
from daguerre.scene.lights import DirectionalLight, PointLight, SpotLight


def light_items(root: Item) -> list[Item]:
    """The lights of a file."""
    extension = root.extension("KHR_lights_punctual")
    return [] if extension is None else list(extension.need("lights"))


def read_light(item: Item, name: str) -> PointLight | SpotLight | DirectionalLight:
    """Reads a light; its node sets position and direction."""
    kind = item.need("type").choice(("point", "spot", "directional"))
    r, g, b = item.numbers_of("color", (1.0, 1.0, 1.0), 0)
    power = item.number_of("intensity", 1.0, 0)
    color = (r * power, g * power, b * power)
    if not max(color) <= 3e38:  # single precision
        item.fail(f"out of range: wanted color x intensity of at most 3e+38, got {max(color):g}")
    if kind == "directional":
        return DirectionalLight(color, name=name)
    reach = item.number_of("range", math.inf, above=0)
    if kind == "point":
        return PointLight(color, range=reach, name=name)
    cone = item.need("spot")
    outer_item = cone.get("outerConeAngle")
    # 1e-6, as pi / 2 rounded to float is above pi / 2.
    half_pi = 0.5 * math.pi + 1e-6
    outer = math.pi / 4 if outer_item is None else outer_item.number(0, half_pi, above=0)
    inner = cone.number_of("innerConeAngle", 0.0, 0)
    if inner >= outer:
        cone.fail(f"wanted innerConeAngle below outerConeAngle, got {inner:g} and {outer:g}")
    return SpotLight(
        color, math.degrees(inner), min(math.degrees(outer), 90.0), range=reach, name=name
    )
